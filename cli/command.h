// What a subcommand reads from the command line. Thin over CLI11, whose headers take the compiler
// ten seconds in every file: they stay in three.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tyndall::cli {

// An option of a subcommand, and what must hold of it. Whatever does not is wrong usage.
class CommandOption {
  public:
    explicit CommandOption(CLI::Option* option) : option_(option) {}

    CommandOption& required();
    CommandOption& between(double low, double high);
    CommandOption& between(std::size_t low, std::size_t high);
    CommandOption& positive();
    CommandOption& not_negative();
    CommandOption& excludes(const CommandOption& other);

  private:
    CLI::Option* option_;
};

class Command {
  public:
    explicit Command(CLI::App& app) : app_(app) {}

    // `to` gets the value when the command line is parsed, and keeps what it holds if the option is
    // not given. Names: "-o,--output"; "SCENE" for what has no flag. A list: the option may be
    // repeated.
    CommandOption option(const std::string& names, std::string& to, const std::string& help);
    CommandOption option(const std::string& names, std::vector<std::string>& to,
                         const std::string& help);
    CommandOption option(const std::string& names, std::size_t& to, const std::string& help);
    CommandOption option(const std::string& names, double& to, const std::string& help);
    CommandOption option(const std::string& names, std::optional<std::size_t>& to,
                         const std::string& help);
    CommandOption option(const std::string& names, std::optional<double>& to,
                         const std::string& help);
    CommandOption flag(const std::string& names, bool& to, const std::string& help);

    CLI::App& app() { return app_; }

  private:
    CLI::App& app_;
};

}  // namespace tyndall::cli
