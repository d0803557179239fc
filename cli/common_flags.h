// Flags that every subcommand has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"

namespace tyndall::cli {

// One --set: overrides a key of the scene file.
struct Setting {
    std::string key;    // "solve.error", "material.plaster.reflectance"
    std::string value;  // as TOML writes it: 0.003, [1, 2, 3], "text"; a bare word is text
};

struct CommonFlags {
    std::size_t threads = 0;            // 0: all
    std::optional<std::uint64_t> seed;  // none: the scene's, or the default
    bool quiet = false;                 // no progress, no summary
    bool json = false;                  // machine-readable to stdout
    std::vector<Setting> settings;      // of --set, in the order given
};

// Adds --threads, --quiet and --json to a subcommand.
void add_common_flags(Command command, CommonFlags& flags);

// Adds --seed, for subcommands that draw random numbers.
void add_seed_flag(Command command, CommonFlags& flags);

// Adds --set key=value (repeatable), for subcommands that read a scene or a study.
void add_set_flag(Command command, CommonFlags& flags);

}  // namespace tyndall::cli
