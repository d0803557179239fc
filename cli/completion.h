// Scripts by which shells complete `tyndall` command lines, made from the command line's
// description.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/program_description.h"

namespace tyndall::cli {

// For `source <(tyndall completion bash)`, or a file in bash-completion's folder.
std::string bash_completion(const ProgramDescription& program);
// For a file _tyndall in a folder of $fpath.
std::string zsh_completion(const ProgramDescription& program);
// For a file tyndall.fish in fish's completions folder.
std::string fish_completion(const ProgramDescription& program);

// Keys that --set takes: those of [solve], [render] and such; with a scene file also those of what
// it names ("material.plaster.reflectance"). A file that cannot be read adds none: it is being
// written.
std::vector<std::string> settable_keys(const std::filesystem::path& scene = {});

// Whether a scene file has such a key at its top level.
bool scene_has_key(const std::string& key);

// Options of a command with a flag that want a value, and those that do not; places without a flag.
struct SortedOptions {
    std::vector<const OptionDescription*> values, switches, places;
};
SortedOptions sorted_options(const CommandDescription& command);

// In single quotes, for a POSIX shell or zsh; fish reads them likewise.
std::string in_quotes(const std::string& text);

}  // namespace tyndall::cli
