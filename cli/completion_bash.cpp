#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace tyndall::cli {
namespace {

// Bash alone: nothing of the bash-completion package is needed.
constexpr const char* helpers =
    R"~(_tyndall_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }

# Files of these kinds, and folders on the way to them.
_tyndall_files() {
    local name kind
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
    while IFS= read -r name; do
        [[ -d $name ]] && continue
        for kind in "$@"; do [[ $name == *."$kind" ]] && COMPREPLY+=("$name"); done
    done < <(compgen -f -- "$current")
}

# Keys that --set takes, those of the scene file on the line among them.
_tyndall_keys() {
    local word scene=
    for word in "${COMP_WORDS[@]:2}"; do [[ $word == *.toml ]] && scene=$word && break; done
    compopt -o nospace 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -S = -W "$("${COMP_WORDS[0]}" completion keys ${scene:+"$scene"} 2>/dev/null)" -- "$current")
}

# How many words without a flag there are before the one to complete; $1: flags that want a value.
_tyndall_place() {
    local k word
    place=0
    for ((k = 2; k < COMP_CWORD; ++k)); do
        word=${COMP_WORDS[k]}
        if [[ $1 == *" $word "* ]]; then
            ((++k))
            [[ ${COMP_WORDS[k]} == = ]] && ((++k))
        elif [[ $word != -* && $word != = && ${COMP_WORDS[k - 1]} != = ]]; then
            ((++place))
        fi
    done
}
)~";

std::string bash_action(const Completion& completion) {
    if (completion.settings) return "_tyndall_keys";
    if (!completion.words.empty())
        return fmt::format("_tyndall_words {}",
                           in_quotes(fmt::format("{}", fmt::join(completion.words, " "))));
    if (completion.folders || !completion.extensions.empty())
        return fmt::format("_tyndall_files {}", fmt::join(completion.extensions, " "));
    return ":";
}

std::string bash_case(const CommandDescription& command) {
    const auto options = sorted_options(command);
    std::string text = fmt::format("    {})\n        case $before in\n", command.name);
    std::string flags, with_value = " ";
    for (const auto* option : options.values) {
        text += fmt::format("        {}) {} && return ;;\n", fmt::join(option->names, " | "),
                            bash_action(option->completion));
        for (const auto& name : option->names) with_value += name + " ";
    }
    for (const auto& option : command.options)
        if (!option.positional) flags += fmt::format("{} ", fmt::join(option.names, " "));
    text += fmt::format(
        "        esac\n        if [[ $current == -* ]]; then _tyndall_words {}; return; fi\n",
        in_quotes(flags));
    text +=
        fmt::format("        _tyndall_place {}\n        case $place in\n", in_quotes(with_value));
    for (std::size_t k = 0; k < options.places.size(); ++k)
        text += fmt::format("        {}) {} ;;\n", k, bash_action(options.places[k]->completion));
    return text + "        esac\n        ;;\n";
}

}  // namespace

std::string bash_completion(const ProgramDescription& program) {
    std::string names;
    for (const auto& command : program.commands) names += command.name + " ";
    std::string text =
        "# Completion of tyndall in bash, made by: tyndall completion bash\n"
        "# Now: source <(tyndall completion bash). For good: this file, as tyndall, in\n"
        "# ~/.local/share/bash-completion/completions.\n\n";
    text += helpers;
    text += fmt::format(
        R"~(
_tyndall() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} place
    COMPREPLY=()
    if [[ $current == = ]]; then
        current=
    elif [[ $before == = ]]; then
        before=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    if ((COMP_CWORD == 1)) || [[ $COMP_CWORD == 2 && $before == help ]]; then
        _tyndall_words '{0}help --help --version'
        return
    fi
    case ${{COMP_WORDS[1]}} in
)~",
        names);
    for (const auto& command : program.commands) text += bash_case(command);
    return text + "    esac\n}\ncomplete -F _tyndall tyndall\n";
}

}  // namespace tyndall::cli
