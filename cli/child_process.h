// A program run as a child, with what it cost and what it said.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tyndall::cli {

struct ChildOutcome {
    int exit_code = -1;                            // −1 where a signal ended it
    int signal = 0;                                // that ended it; 0: none
    double cpu_seconds = 0.0, wall_seconds = 0.0;  // with its own children [s]
    std::size_t peak_memory_bytes = 0;             // of the largest process among them
    bool stop_was_asked = false;                   // it was told to stop (SIGTERM)
};

// Purpose: runs `program` with `arguments` (without its own name) and waits for it. Standard input
//   is empty, standard output goes nowhere, standard error into the file `messages`.
// `keep_on` is called some ten times a second; once it returns false the child is asked to stop
//   (SIGTERM), and waited for. The child is in a process group of its own, so that Ctrl-C on a
//   terminal reaches it by this way only; it is told to stop, too, if this process dies.
// Errors: mesh::InputError: the program cannot be started, `messages` cannot be written.
ChildOutcome run_child(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& messages, const std::function<bool()>& keep_on);

}  // namespace tyndall::cli
