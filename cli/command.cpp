#include "cli/command.h"

#include <CLI/CLI.hpp>

namespace tyndall::cli {

CommandOption& CommandOption::required() {
    option_->required();
    return *this;
}

CommandOption& CommandOption::between(double low, double high) {
    option_->check(CLI::Range(low, high).description(""));
    return *this;
}

CommandOption& CommandOption::between(std::size_t low, std::size_t high) {
    option_->check(CLI::Range(low, high).description(""));
    return *this;
}

CommandOption& CommandOption::positive() {
    option_->check(CLI::Validator(CLI::PositiveNumber).description(""));
    return *this;
}

CommandOption& CommandOption::not_negative() {
    option_->check(CLI::Validator(CLI::NonNegativeNumber).description(""));
    return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
    option_->excludes(other.option_);
    return *this;
}

CommandOption& CommandOption::called(const std::string& value) {
    option_->type_name(value);
    return *this;
}

CommandOption& CommandOption::file(std::vector<std::string> extensions) {
    if (!option_->get_positional()) option_->type_name("FILE");
    (*completions_)[option_].extensions = std::move(extensions);
    return *this;
}

CommandOption& CommandOption::folder() {
    auto& completion = (*completions_)[option_];
    completion.folders = true;
    if (!option_->get_positional() && completion.extensions.empty()) option_->type_name("DIR");
    return *this;
}

CommandOption& CommandOption::word_of(std::vector<std::string> words) {
    if (!option_->get_positional()) option_->type_name("NAME");
    (*completions_)[option_].words = std::move(words);
    return *this;
}

// What has no flag is called by its name alone.
CommandOption Command::take(CLI::Option* option, const char* value, const std::string& names) {
    option->type_name(names.starts_with('-') ? value : "");
    return CommandOption(option, completions_);
}

CommandOption Command::option(const std::string& names, std::string& to, const std::string& help) {
    return take(app_.add_option(names, to, help), "TEXT", names);
}

CommandOption Command::option(const std::string& names, std::vector<std::string>& to,
                              const std::string& help) {
    return take(app_.add_option(names, to, help), "TEXT", names);
}

CommandOption Command::option(const std::string& names, std::size_t& to, const std::string& help) {
    return take(app_.add_option(names, to, help), "N", names);
}

CommandOption Command::option(const std::string& names, double& to, const std::string& help) {
    return take(app_.add_option(names, to, help), "X", names);
}

CommandOption Command::option(const std::string& names, std::optional<std::size_t>& to,
                              const std::string& help) {
    return take(app_.add_option(names, to, help), "N", names);
}

CommandOption Command::option(const std::string& names, std::optional<double>& to,
                              const std::string& help) {
    return take(app_.add_option(names, to, help), "X", names);
}

CommandOption Command::flag(const std::string& names, bool& to, const std::string& help) {
    return CommandOption(app_.add_flag(names, to, help), completions_);
}

}  // namespace tyndall::cli
