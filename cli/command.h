// What a subcommand reads from the command line. Thin over CLI11, whose headers take the compiler
// ten seconds in every file: they stay in three.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tyndall::cli {

// What may stand in an option's place, for whoever completes a command line.
struct Completion {
    std::vector<std::string> words;       // one of these: names of methods
    std::vector<std::string> extensions;  // a file of one of these kinds: "toml"
    bool folders = false;                 // or a folder
    bool settings = false;                // KEY=VALUE of --set
};

// Of every option that says so.
using Completions = std::map<const CLI::Option*, Completion>;

// An option of a subcommand, and what must hold of it. Whatever does not is wrong usage.
class CommandOption {
  public:
    CommandOption(CLI::Option* option, Completions& completions)
        : option_(option), completions_(&completions) {}

    CommandOption& required();
    CommandOption& between(double low, double high);
    CommandOption& between(std::size_t low, std::size_t high);
    CommandOption& positive();
    CommandOption& not_negative();
    CommandOption& excludes(const CommandOption& other);
    // How help calls the value: "DIR"; nothing for what has no flag, whose name says it.
    CommandOption& called(const std::string& value);
    // What the value is, for completion; it is checked where it is read.
    CommandOption& file(std::vector<std::string> extensions);
    CommandOption& folder();
    CommandOption& word_of(std::vector<std::string> words);
    template <class Names>
    CommandOption& name_of(const Names& names) {
        return word_of(std::vector<std::string>(names.begin(), names.end()));
    }

  private:
    CLI::Option* option_;
    Completions* completions_;
};

class Command {
  public:
    Command(CLI::App& app, Completions& completions) : app_(app), completions_(completions) {}

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
    Completions& completions() { return completions_; }

  private:
    CommandOption take(CLI::Option* option, const char* value, const std::string& names);

    CLI::App& app_;
    Completions& completions_;
};

}  // namespace tyndall::cli
