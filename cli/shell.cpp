#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

#include "cli/commands.h"
#include "cli/suggestion.h"
#include "mesh/input_error.h"

namespace tyndall::cli {

namespace {

constexpr int done = 0, failed = 1, wrong_usage = 2;

constexpr const char* top_examples =
    R"(  tyndall new room -o room.toml                a scene to begin with, its units in comments
  tyndall check room.toml                      is it sound, what will be solved, how long
  tyndall run room.toml -o out/                solve, render, report
  tyndall view out/ -o walk.html               a page to walk through it
  tyndall compare out/ reference.pfm           how far is the picture off)";

constexpr const char* top_hint = "'tyndall COMMAND --help' tells more about a command.";

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

// A file where a command should be is most likely meant for one of them.
std::string unknown_command_message(const CLI::App& app, const std::string& name) {
    const std::filesystem::path path(name);
    std::error_code ignored;
    const auto line = [&](const std::string& command) {
        return fmt::format("'{}' is no command. Did you mean: tyndall {}", name, command);
    };
    if (path.extension() == ".toml")
        return line(fmt::format("run {} -o {}/", name, path.stem().string()));
    if (path.extension() == ".vtkhdf" || std::filesystem::is_directory(path, ignored))
        return line(fmt::format("view {}", name));
    return fmt::format("unknown command '{}'. {}", name, suggest(name, command_names(app)));
}

std::vector<std::string> flag_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* option : app.get_options())
        for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// Commands that have a flag.
std::vector<std::string> commands_with(const CLI::App& app, const std::string& flag) {
    std::vector<std::string> commands;
    for (const auto* command : app.get_subcommands({})) {
        const auto flags = flag_names(*command);
        if (std::find(flags.begin(), flags.end(), flag) != flags.end())
            commands.push_back(command->get_name());
    }
    return commands;
}

std::string unknown_flag(const CLI::App& app, const CLI::App& command, const std::string& name) {
    const auto flags = flag_names(command);
    const std::vector<std::string_view> views(flags.begin(), flags.end());
    const auto others = commands_with(app, name);
    if (nearest(name, views) || others.empty())
        return fmt::format("unknown flag '{}'. {}", name, suggest(name, flags));
    const std::vector<std::string_view> names(others.begin(), others.end());
    return fmt::format("unknown flag '{}'. It is one of {}.", name, list_of(names));
}

// What of the command line must be given and is not.
const CLI::Option* missing_option(const CLI::App& command) {
    for (const auto* option : command.get_options())
        if (option->get_required() && option->count() == 0) return option;
    return nullptr;
}

// The flag that a message of CLI11's begins with: "--output: 1 required DIR missing".
const CLI::Option* named_in(const CLI::App& command, const std::string& message) {
    for (const auto* option : command.get_options())
        for (const auto& name : option->get_lnames())
            if (message.starts_with("--" + name + ":")) return option;
    return nullptr;
}

// What is missing, what it is, and a line that has it.
std::string missing_message(const CLI::App& command, const CLI::Option& option,
                            const std::vector<std::string>& rest) {
    const bool positional = option.get_positional();
    const auto name = positional ? option.get_name(true) : "--" + option.get_lnames().front();
    auto text = fmt::format("{} is required: {}.", name, option.get_description());
    const bool path = !rest.empty() && !rest.front().starts_with('-');
    if (!positional && path && name == "--output")
        return text + fmt::format(" Did you mean -o {}?", rest.front());
    const std::string examples = command.get_footer();
    const auto begin = examples.find("  tyndall ");
    if (begin == examples.npos) return text;
    const auto line = examples.substr(begin + 2, examples.find('\n', begin) - begin - 2);
    return text + fmt::format(" For example: {}", example_of(line).line);
}

// The message of a parse error as this program words it.
std::string wording(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const auto& command = chosen.empty() ? app : *chosen.front();
    const auto rest = app.remaining(true);
    const auto* missing = missing_option(command);
    if (missing && dynamic_cast<const CLI::RequiredError*>(&error))
        return missing_message(command, *missing, rest);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
        if (const auto* bare = named_in(command, error.what()))
            return fmt::format("--{} needs a value ({}): {}.", bare->get_lnames().front(),
                               bare->get_type_name(), bare->get_description());
    if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || rest.empty())
        return error.what();
    const auto& first = rest.front();
    const auto name = first.substr(0, first.find('='));
    const auto flags = flag_names(command);
    if (std::find(flags.begin(), flags.end(), name) != flags.end())
        return fmt::format("'{}' belongs behind the command: tyndall {} … {}", name,
                           command.get_name(), first);
    if (first.size() > 1 && first[0] == '-') return unknown_flag(app, command, name);
    return fmt::format("'{}' is one argument too many", first);
}

OptionDescription describe(const CLI::Option& option, const Completions& completions) {
    OptionDescription d;
    d.positional = option.get_positional();
    if (d.positional) d.names.push_back(option.get_name(true));
    for (const auto& name : option.get_snames()) d.names.push_back("-" + name);
    for (const auto& name : option.get_lnames()) d.names.push_back("--" + name);
    if (option.get_items_expected_max() > 0) d.value = option.get_type_name();
    d.help = option.get_description();
    d.required = option.get_required();
    d.repeatable = option.get_items_expected_max() > 1;
    d.common = option.get_group() == "Common flags";
    if (const auto found = completions.find(&option); found != completions.end())
        d.completion = found->second;
    return d;
}

std::vector<std::string> example_lines(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; (at = text.find("  tyndall ", at)) != text.npos;) {
        const auto end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at + 2, end - at - 2));
        at = end;
    }
    return lines;
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
    app_->footer(fmt::format("Examples:\n{}\n\n{}", top_examples, top_hint));
    app_->require_subcommand(1);
}

Shell::~Shell() = default;

Command Shell::add_command(const std::string& name, const std::string& purpose,
                           const std::string& examples, Action action) {
    auto* command = app_->add_subcommand(name, purpose);
    command->footer("Examples:\n" + examples);
    command->callback([this, action = std::move(action)] { chosen_ = action; });
    Command described(*command, completions_);
    add_common_flags(described, flags_);
    return described;
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
        return usage_error(unknown_command_message(*app_, name));
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

ProgramDescription Shell::description() const {
    ProgramDescription program{
        app_->get_description(), TYNDALL_VERSION, example_lines(app_->get_footer()), {}};
    for (const auto* command : app_->get_subcommands({})) {
        CommandDescription d{command->get_name(),
                             command->get_description(),
                             example_lines(command->get_footer()),
                             {}};
        for (const auto* option : command->get_options())
            d.options.push_back(describe(*option, completions_));
        program.commands.push_back(std::move(d));
    }
    return program;
}

std::string Shell::trouble(const std::vector<std::string>& words) {
    std::vector<const char*> argv{"tyndall"};
    for (const auto& word : words) argv.push_back(word.c_str());
    const auto argc = static_cast<int>(argv.size());
    if (const auto name = unknown_command(*app_, argc, argv.data()); !name.empty())
        return unknown_command_message(*app_, name);
    try {
        app_->parse(argc, argv.data());
    } catch (const CLI::Success&) {
    } catch (const CLI::ParseError& error) {
        return wording(*app_, error);
    }
    return "";
}

void write_output(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace tyndall::cli
