// The built program, run as a user runs it, in a folder of its own.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mesh/file_bytes.h"
#include "support/catch.h"

namespace tyndall::test {

inline constexpr const char* program = TYNDALL_BINARY_DIR "/bin/tyndall";

struct Outcome {
    int code = -1;  // of exit; 1000 + status as of waitpid if a signal ended it
    std::string out, err;
};

inline int exit_code(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
}

// A program that runs meanwhile; it does not outlive its object.
class Running {
  public:
    Running(const std::filesystem::path& folder, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "tyndall");
        std::vector<char*> argv;
        for (auto& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        id_ = ::fork();
        REQUIRE(id_ >= 0);
        if (id_ > 0) return;
        ::setpgid(0, 0);
        if (::chdir(folder.c_str()) == 0) ::execv(program, argv.data());
        ::_exit(127);
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
        if (id_ <= 0) return;
        signal(SIGKILL);
        wait();
    }

    void signal(int number) const { ::kill(id_, number); }
    // To the program and what it runs, as Ctrl-C on a terminal does.
    void signal_group(int number) const { ::kill(-id_, number); }
    // As of waitpid.
    int wait() {
        int status = 0;
        ::waitpid(std::exchange(id_, 0), &status, 0);
        return status;
    }

  private:
    pid_t id_ = 0;
};

struct Workplace {
    std::filesystem::path path;

    explicit Workplace(const std::string& name)
        : path(std::filesystem::temp_directory_path() /
               ("tyndall_" + name + "_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path);
        std::filesystem::create_directories(path);
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;
    ~Workplace() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }

    void write(const std::string& name, const std::string& text) const {
        mesh::write_file(path / name, text);
    }
    std::string read(const std::string& name) const { return mesh::read_file(path / name); }
    bool has(const std::string& name) const { return std::filesystem::exists(path / name); }

    // `arguments` as a shell reads them; `before`: what the shell runs the program with.
    Outcome run(const std::string& arguments, const std::string& before = "") const {
        const bool piped = arguments.find('>') != std::string::npos;
        const std::string line = "cd '" + path.string() + "' && " + before + " '" + program + "' " +
                                 arguments + " 2>err.txt" + (piped ? "" : " >out.txt");
        const int status = std::system(line.c_str());
        return {exit_code(status), piped ? "" : read("out.txt"), read("err.txt")};
    }
    // Runs what must succeed without a word on stderr.
    std::string good(const std::string& arguments) const {
        CAPTURE(arguments);
        const auto outcome = run(arguments);
        CHECK(outcome.err == "");
        REQUIRE(outcome.code == 0);
        return outcome.out;
    }
};

// One message: a single line that names the program.
inline void check_one_message(const Outcome& outcome) {
    CHECK(outcome.err.rfind("tyndall: ", 0) == 0);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

}  // namespace tyndall::test
