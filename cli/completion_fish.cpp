#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace tyndall::cli {
namespace {

// Where words are completed to files, fish is told of the kinds by a suffix each.
std::string words_for(const Completion& completion) {
    if (completion.settings) return "(__tyndall_keys)";
    std::string text = fmt::format("{}", fmt::join(completion.words, " "));
    for (const auto& extension : completion.extensions)
        text += fmt::format("(__fish_complete_suffix .{}) ", extension);
    if (completion.folders && completion.extensions.empty())
        text += "(__fish_complete_directories)";
    return text;
}

std::string line_of(const CommandDescription& command, const OptionDescription& option) {
    auto text =
        fmt::format("complete -c tyndall -n '__fish_seen_subcommand_from {}'", command.name);
    for (const auto& name : option.names) {
        const bool is_long = name.starts_with("--");
        text += fmt::format(" {} {}", is_long ? "-l" : "-s", name.substr(is_long ? 2 : 1));
    }
    if (!option.value.empty()) text += " -x";
    const auto words = words_for(option.completion);
    if (!words.empty()) text += fmt::format(" -a {}", in_quotes(words));
    return text + fmt::format(" -d {}\n", in_quotes(option.help));
}

std::string lines_of(const CommandDescription& command) {
    std::string text = fmt::format("complete -c tyndall -n __fish_use_subcommand -a {} -d {}\n",
                                   command.name, in_quotes(command.purpose));
    const auto options = sorted_options(command);
    for (const auto* option : options.values) text += line_of(command, *option);
    for (const auto* option : options.switches) text += line_of(command, *option);
    std::string words;
    for (const auto* option : options.places) {
        const auto more = words_for(option->completion);
        if (words.find(more) == words.npos) words += (words.empty() ? "" : " ") + more;
    }
    if (!words.empty())
        text += fmt::format("complete -c tyndall -n '__fish_seen_subcommand_from {}' -a {}\n",
                            command.name, in_quotes(words));
    return text;
}

}  // namespace

std::string fish_completion(const ProgramDescription& program) {
    std::string names, lines;
    for (const auto& command : program.commands) {
        names += command.name + " ";
        lines += lines_of(command);
    }
    return fmt::format(R"~(# Completion of tyndall in fish, made by: tyndall completion fish
# Put it as tyndall.fish into ~/.config/fish/completions.

# Keys that --set takes, those of the scene file on the line among them.
function __tyndall_keys
    set -l scene (string match '*.toml' -- (commandline -opc))
    for key in (tyndall completion keys $scene[1] 2>/dev/null)
        echo $key=
    end
end

complete -c tyndall -f
complete -c tyndall -n __fish_use_subcommand -l version -d 'The version'
complete -c tyndall -n __fish_use_subcommand -l help -d 'How it is used'
complete -c tyndall -n __fish_use_subcommand -a help -d 'How a command is used'
complete -c tyndall -n '__fish_seen_subcommand_from help' -a '{}'
{})~",
                       names, lines);
}

}  // namespace tyndall::cli
