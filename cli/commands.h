// The subcommands of `tyndall`, one file each, and the shell that they are added to.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "cli/common_flags.h"
#include "cli/program_description.h"

namespace tyndall::cli {

// Does a subcommand's work when its name was given. Returns the exit code: 0 done, 1 failed. Bad
// input is thrown as mesh::InputError, which the shell prints.
using Action = std::function<int(const CommonFlags&)>;

// The program `tyndall`: parses the command line, runs the action of the subcommand that was given.
class Shell {
  public:
    Shell();
    ~Shell();
    Shell(const Shell&) = delete;
    Shell& operator=(const Shell&) = delete;

    // Adds a subcommand with --threads, --quiet and --json. The caller adds its other options to
    // what is returned, with variables that the action keeps alive (a shared_ptr). `examples`:
    // whole lines for the end of its help, "  tyndall run room.toml -o out/    comment": each is
    // run or parsed by tests/cli/test_help.cpp.
    Command add_command(const std::string& name, const std::string& purpose,
                        const std::string& examples, Action action);

    CommonFlags& flags() { return flags_; }

    // Purpose: parse, run, and turn every outcome into an exit code: 0 done; 1 bad input or a
    //   failed run, with one message on stderr; 2 wrong usage, with a message on stderr.
    // A reader of stdout that goes away (`| head`) is no failure; a full disk under stdout is one.
    int run(int argc, const char* const* argv);

    // All that the command line can be, for help, manual and completion.
    ProgramDescription description() const;
    // Why these words behind `tyndall` are wrong usage; "" if they are not. Nothing is run.
    std::string trouble(const std::vector<std::string>& words);

  private:
    int parse_and_run(int argc, const char* const* argv);
    int help(const std::string& name) const;  // `tyndall help [COMMAND]`
    int usage_error(const std::string& message) const;

    std::unique_ptr<CLI::App> app_;
    Completions completions_;
    CommonFlags flags_;
    Action chosen_;
};

// Writes results to stdout. A failure shows in the exit code when the command has ended.
void write_output(std::string_view text);

// Adds all subcommands.
void add_all_commands(Shell& shell);

// compare_command.cpp
void add_compare_command(Shell& shell);

// run_command.cpp
void add_run_command(Shell& shell);

// run_command.cpp too
void add_solve_command(Shell& shell);

// render_command.cpp
void add_render_command(Shell& shell);

// view_command.cpp
void add_view_command(Shell& shell);

// export_command.cpp
void add_export_command(Shell& shell);

// probe_command.cpp
void add_probe_command(Shell& shell);

// exchange_command.cpp
void add_exchange_command(Shell& shell);

// check_command.cpp
void add_check_command(Shell& shell);

// animate_command.cpp
void add_animate_command(Shell& shell);

// study_command.cpp
void add_study_command(Shell& shell);

// new_command.cpp
void add_new_command(Shell& shell);

// completion_command.cpp
void add_completion_command(Shell& shell);

// manual_command.cpp
void add_manual_command(Shell& shell);

}  // namespace tyndall::cli
