// The program's command line as plain data, taken from what parses it: help pages, manual and
// completion scripts are made from this and cannot tell of a flag that is not there.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace tyndall::cli {

struct OptionDescription {
    std::vector<std::string> names;  // "-o", "--output"; "SCENE" of what has no flag
    std::string value;               // how help calls it, "DIR"; "" of a switch
    std::string help;
    Completion completion;
    bool positional = false, required = false, repeatable = false;
    bool common = false;  // one of the flags that most commands share
};

struct CommandDescription {
    std::string name, purpose;
    std::vector<std::string> examples;  // "tyndall run room.toml -o out/     comment"
    std::vector<OptionDescription> options;
};

struct ProgramDescription {
    std::string purpose, version;
    std::vector<std::string> examples;
    std::vector<CommandDescription> commands;

    // Null if there is none of that name.
    const CommandDescription* find(const std::string& name) const;
};

// The command of an example line and what it says of it, which stands behind two or more spaces.
struct Example {
    std::string line, comment;
};
Example example_of(const std::string& text);

}  // namespace tyndall::cli
