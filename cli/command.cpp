#include "cli/command.h"

#include <CLI/CLI.hpp>

namespace tyndall::cli {

CommandOption& CommandOption::required() {
    option_->required();
    return *this;
}

CommandOption& CommandOption::between(double low, double high) {
    option_->check(CLI::Range(low, high));
    return *this;
}

CommandOption& CommandOption::between(std::size_t low, std::size_t high) {
    option_->check(CLI::Range(low, high));
    return *this;
}

CommandOption& CommandOption::positive() {
    option_->check(CLI::PositiveNumber);
    return *this;
}

CommandOption& CommandOption::not_negative() {
    option_->check(CLI::NonNegativeNumber);
    return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
    option_->excludes(other.option_);
    return *this;
}

CommandOption Command::option(const std::string& names, std::string& to, const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::option(const std::string& names, std::vector<std::string>& to,
                              const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::option(const std::string& names, std::size_t& to, const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::option(const std::string& names, double& to, const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::option(const std::string& names, std::optional<std::size_t>& to,
                              const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::option(const std::string& names, std::optional<double>& to,
                              const std::string& help) {
    return CommandOption(app_.add_option(names, to, help));
}

CommandOption Command::flag(const std::string& names, bool& to, const std::string& help) {
    return CommandOption(app_.add_flag(names, to, help));
}

}  // namespace tyndall::cli
