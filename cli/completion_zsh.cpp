#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace tyndall::cli {
namespace {

// Brackets and colons part what _arguments reads.
std::string zsh_escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

std::string zsh_action(const Completion& completion) {
    if (completion.settings) return "_tyndall_keys";
    if (!completion.words.empty())
        return fmt::format("({})",
                           zsh_escaped(fmt::format("{}", fmt::join(completion.words, " "))));
    if (!completion.extensions.empty())  // _files goes through folders by itself
        return fmt::format("_files -g \"*.({})\"", fmt::join(completion.extensions, "|"));
    return completion.folders ? "_files -/" : "";
}

std::string spec_of(const OptionDescription& option) {
    const bool valued = !option.value.empty();
    const auto value =
        valued ? fmt::format(":{}:{}", zsh_escaped(option.value), zsh_action(option.completion))
               : std::string();
    const auto help = "[" + zsh_escaped(option.help) + "]";
    std::string text;
    for (const auto& name : option.names) {
        const auto others = option.repeatable ? std::string("*")
                                              : fmt::format("({})", fmt::join(option.names, " "));
        const char* joined = !valued ? "" : name.starts_with("--") ? "=" : "+";
        text +=
            fmt::format("            {} \\\n", in_quotes(others + name + joined + help + value));
    }
    return text;
}

std::string zsh_case(const CommandDescription& command) {
    std::string text = fmt::format("        {})\n            _arguments \\\n", command.name);
    const auto options = sorted_options(command);
    for (const auto* option : options.values) text += spec_of(*option);
    for (const auto* option : options.switches) text += spec_of(*option);
    std::size_t place = 0;
    for (const auto* option : options.places)
        text += fmt::format(
            "            {} \\\n",
            in_quotes(fmt::format("{}:{}:{}", ++place, zsh_escaped(option->names.front()),
                                  zsh_action(option->completion))));
    text.erase(text.size() - 3);  // the last " \"
    return text + "\n            ;;\n";
}

}  // namespace

std::string zsh_completion(const ProgramDescription& program) {
    std::string names, cases;
    for (const auto& command : program.commands) {
        names += fmt::format("        {}\n", in_quotes(command.name + ":" + command.purpose));
        cases += zsh_case(command);
    }
    return fmt::format(
        R"~(#compdef tyndall
# Completion of tyndall in zsh, made by: tyndall completion zsh
# Put it as _tyndall into a folder of $fpath, and start zsh again.

# Keys that --set takes, those of the scene file on the line among them.
_tyndall_keys() {{
    local -a keys scene
    scene=(${{(M)words:#*.toml}})
    keys=(${{(f)"$(tyndall completion keys ${{scene[1]}} 2>/dev/null)"}})
    compadd -S = -- $keys
}}

_tyndall() {{
    local curcontext=$curcontext state line
    typeset -A opt_args
    local -a commands
    commands=(
{0}        'help:How a command is used'
    )
    _arguments -C '--version[The version]' '--help[How it is used]' '1:command:->command' '*::argument:->argument'
    case $state in
    command) _describe command commands ;;
    argument)
        case $words[1] in
{1}        help) _describe command commands ;;
        esac
        ;;
    esac
}}

if [[ $funcstack[1] == _tyndall ]]; then _tyndall "$@"; else compdef _tyndall tyndall; fi
)~",
        names, cases);
}

}  // namespace tyndall::cli
