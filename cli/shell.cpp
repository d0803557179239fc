#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include "cli/commands.h"
#include "cli/suggestion.h"
#include "mesh/input_error.h"

namespace tyndall::cli {

namespace {

constexpr int done = 0, failed = 1, wrong_usage = 2;

constexpr const char* top_examples =
    R"(Examples:
  tyndall run scenes/window_shafts.toml -o out/     solve, render, report
  tyndall check room.toml                           is the scene sound, what will it need
  tyndall compare out/ reference.pfm                how far is the picture off

'tyndall COMMAND --help' tells more about a command.)";

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

// The first argument if it should be a subcommand and is none, as in `tyndall rnu room.toml`; else
// "".
std::string unknown_command(const CLI::App& app, int argc, const char* const* argv) {
    if (argc < 2 || argv[1][0] == '-') return "";
    const auto names = command_names(app);
    return std::find(names.begin(), names.end(), argv[1]) == names.end() ? argv[1] : "";
}

std::vector<std::string> flag_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* option : app.get_options())
        for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// The message of a parse error as this program words it.
std::string wording(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const auto& command = chosen.empty() ? app : *chosen.front();
    const auto rest = app.remaining(true);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || rest.empty())
        return error.what();
    const auto& first = rest.front();
    const auto name = first.substr(0, first.find('='));
    const auto flags = flag_names(command);
    if (std::find(flags.begin(), flags.end(), name) != flags.end())
        return fmt::format("'{}' belongs behind the command: tyndall {} … {}", name,
                           command.get_name(), first);
    if (first.size() > 1 && first[0] == '-')
        return fmt::format("unknown flag '{}'. {}", name, suggest(name, flags));
    return fmt::format("'{}' is one argument too many", first);
}

// Whether everything written to stdout arrived; a closed pipe counts as arrived: its reader had
// enough.
bool output_arrived() {
    errno = 0;
    const bool fine = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    return fine || errno == EPIPE || errno == 0;
}

int fail(const std::string& message) {
    fmt::print(stderr, "tyndall: {}\n", message);
    return failed;
}

}  // namespace

Shell::Shell()
    : app_(std::make_unique<CLI::App>(
          "Adaptive-mesh radiosity for surfaces and participating media", "tyndall")) {
    app_->set_version_flag("--version", "tyndall " TYNDALL_VERSION, "The version");
    app_->set_help_flag("-h,--help", "This help");
    app_->footer(top_examples);
    app_->require_subcommand(1);
}

Shell::~Shell() = default;

Command Shell::add_command(const std::string& name, const std::string& purpose,
                           const std::string& examples, Action action) {
    auto* command = app_->add_subcommand(name, purpose);
    command->footer("Examples:\n" + examples);
    command->callback([this, action = std::move(action)] { chosen_ = action; });
    add_common_flags(Command(*command), flags_);
    return Command(*command);
}

int Shell::usage_error(const std::string& message) const {
    const auto chosen = app_->get_subcommands();
    const std::string name = chosen.empty() ? "" : chosen.front()->get_name() + " ";
    fmt::print(stderr, "tyndall: {}\nRun 'tyndall {}--help' for how it is used.\n", message, name);
    return wrong_usage;
}

int Shell::help(const std::string& name) const {
    const auto names = command_names(*app_);
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
        return usage_error(fmt::format("unknown command '{}'. {}", name, suggest(name, names)));
    write_output(name.empty() ? app_->help() : app_->get_subcommand(name)->help());
    return done;
}

int Shell::parse_and_run(int argc, const char* const* argv) {
    if (argc < 2) {
        fmt::print(stderr, "{}", app_->help());
        return wrong_usage;
    }
    if (std::strcmp(argv[1], "help") == 0) return help(argc > 2 ? argv[2] : "");
    if (const auto name = unknown_command(*app_, argc, argv); !name.empty())
        return usage_error(
            fmt::format("unknown command '{}'. {}", name, suggest(name, command_names(*app_))));
    try {
        app_->parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help, --version
        return app_->exit(request);
    } catch (const CLI::ParseError& error) {
        return usage_error(wording(*app_, error));
    }
    std::unique_ptr<tbb::global_control> limit;
    if (flags_.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      flags_.threads);
    return chosen_(flags_);
}

int Shell::run(int argc, const char* const* argv) {
    // A reader of stdout that goes away must not end a run that also writes files.
    std::signal(SIGPIPE, SIG_IGN);
    int code = failed;
    try {
        code = parse_and_run(argc, argv);
    } catch (const std::bad_alloc&) {
        code = fail(
            "out of memory. Ask for less: fewer elements (--set solve.max_elements=…), or a "
            "smaller picture.");
    } catch (const std::exception& error) {  // mesh::InputError among them
        code = fail(error.what());
    } catch (...) {
        code = fail("an unknown failure.");
    }
    if (!output_arrived() && code == done)
        return fail(fmt::format("cannot write to standard output: {}.", std::strerror(errno)));
    return code;
}

void write_output(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace tyndall::cli
