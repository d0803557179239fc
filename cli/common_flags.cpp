#include "cli/common_flags.h"

#include <CLI/CLI.hpp>

namespace tyndall::cli {

namespace {

Setting parse_setting(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
        throw CLI::ValidationError(
            "--set", "'" + text + "' is not of the form key=value, as in solve.error=0.003");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

// CLI11 reads −1 as the largest unsigned number.
CLI::Validator whole_number() {
    return CLI::Validator(
        [](const std::string& text) {
            const bool digits =
                !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            return digits ? "" : "'" + text + "' is not a whole number of at least 0";
        },
        "", "whole number");
}

}  // namespace

void add_common_flags(Command command, CommonFlags& flags) {
    command.app()
        .add_option("--threads", flags.threads, "Threads to use; 0: all")
        ->type_name("N")
        ->check(whole_number())
        ->group("Common flags");
    command.app()
        .add_flag("-q,--quiet", flags.quiet, "No progress, no summary")
        ->group("Common flags");
    command.app()
        .add_flag("--json", flags.json, "Machine-readable results to standard output")
        ->group("Common flags");
}

void add_seed_flag(Command command, CommonFlags& flags) {
    command.app()
        .add_option("--seed", flags.seed, "Seed of the sampling; the same seed, the same result")
        ->type_name("S")
        ->check(whole_number())
        ->group("Common flags");
}

void add_set_flag(Command command, CommonFlags& flags) {
    const auto keep = [&flags](const std::vector<std::string>& texts) {
        for (const auto& text : texts) flags.settings.push_back(parse_setting(text));
        return true;
    };
    const auto* option = command.app()
                             .add_option_function<std::vector<std::string>>(
                                 "--set", keep,
                                 "Override a key of the file, repeatable: --set solve.error=0.003 "
                                 "--set material.plaster.reflectance=0.3")
                             ->type_name("KEY=VALUE")
                             ->allow_extra_args(false)  // else it would swallow what follows
                             ->group("Common flags");
    command.completions()[option].settings = true;
}

}  // namespace tyndall::cli
