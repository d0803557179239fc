#include "mesh/tetgen_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "mesh/input_error.h"
#include "mesh/tetgen_pipe.h"

extern char** environ;

namespace tyndall::mesh::tetgen {

namespace {

using Clock = std::chrono::steady_clock;

// A temporary file without a name: gone with its last descriptor.
class TemporaryFile {
  public:
    TemporaryFile() : file_(std::tmpfile()) {
        if (!file_) {
            throw std::runtime_error(fmt::format(
                "cannot make a temporary file for TetGen ({}). Free some space in /tmp.",
                std::strerror(errno)));
        }
        fcntl(descriptor(), F_SETFD, FD_CLOEXEC);
    }

    int descriptor() const { return fileno(file_.get()); }
    std::FILE* get() const { return file_.get(); }

    template <class T>
    void write(const T* values, std::size_t count) {
        if (count > 0 && std::fwrite(values, sizeof(T), count, get()) != count) {
            throw std::runtime_error("cannot write TetGen's input: the temporary folder is full");
        }
    }

    template <class T>
    bool read(std::vector<T>& values, std::size_t count) {
        values.resize(count);
        return count == 0 || std::fread(values.data(), sizeof(T), count, get()) == count;
    }

    // Both sides of a descriptor share one position.
    void rewind() {
        std::fflush(get());
        std::rewind(get());
        lseek(descriptor(), 0, SEEK_SET);
    }

    std::size_t size() {
        std::fseek(get(), 0, SEEK_END);
        const auto end = std::ftell(get());
        rewind();
        return static_cast<std::size_t>(std::max(end, 0L));
    }

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file_;
};

void write_input(TemporaryFile& file, const Input& input) {
    const tetgen_pipe::Header header{tetgen_pipe::magic, input.points.size(),
                                     input.triangles.size(), input.quads.size()};
    file.write(&header, 1);
    file.write(input.points.data(), input.points.size());
    file.write(input.triangles.data(), input.triangles.size());
    file.write(input.triangle_markers.data(), input.triangle_markers.size());
    file.write(input.quads.data(), input.quads.size());
    file.write(input.quad_markers.data(), input.quad_markers.size());
    file.rewind();
}

bool read_output(TemporaryFile& file, Output& output) {
    const auto size = file.size();
    std::vector<tetgen_pipe::Result> results;
    if (size < sizeof(tetgen_pipe::Result) || !file.read(results, 1)) {
        return false;
    }
    const auto& result = results.front();
    const auto expected =
        sizeof result + result.points * sizeof(Point) + result.tets * 16 + result.faces * (12 + 4);
    return result.magic == tetgen_pipe::magic && size == expected &&
           file.read(output.points, result.points) && file.read(output.tets, result.tets) &&
           file.read(output.faces, result.faces) && file.read(output.face_markers, result.faces);
}

// The last lines of what the child wrote, on one line.
std::string last_words(TemporaryFile& file) {
    const auto size = file.size();
    constexpr std::size_t most = 400;
    std::vector<char> bytes;
    const auto count = std::min(size, most);
    std::fseek(file.get(), -static_cast<long>(count), SEEK_END);
    if (!file.read(bytes, count)) {
        return {};
    }
    std::string words(bytes.begin(), bytes.end());
    std::replace(words.begin(), words.end(), '\n', ' ');
    words.erase(0, words.find_first_not_of(' '));
    words.erase(words.find_last_not_of(' ') + 1);
    return words;
}

// A child that does not outlive its object.
class Child {
  public:
    Child(const std::filesystem::path& program, std::vector<std::string> arguments, int in, int out,
          int err) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
        // In a group of its own: Ctrl-C on a terminal asks the program to stop, and must not break
        // the meshing that it still has to wait for.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        std::vector<char*> argv;
        for (auto& argument : arguments) {
            argv.push_back(argument.data());
        }
        argv.push_back(nullptr);
        const int error =
            posix_spawn(&id_, program.c_str(), &actions, &attributes, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
        if (error != 0) {
            throw InputError(
                fmt::format("Cannot run {} ({}). Install tyndall-tetgen beside tyndall.",
                            program.string(), std::strerror(error)));
        }
    }

    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    ~Child() {
        if (running_) {
            kill(id_, SIGKILL);
            waitpid(id_, nullptr, 0);
        }
    }

    // Whether it ended before the time; `status` as of waitpid.
    bool wait(double seconds, int& status) {
        const auto start = Clock::now();
        auto pause = std::chrono::microseconds(200);
        while (waitpid(id_, &status, WNOHANG) == 0) {
            if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) {
                return false;
            }
            std::this_thread::sleep_for(pause);
            pause = std::min(pause * 3 / 2, std::chrono::microseconds(20000));
        }
        running_ = false;
        return true;
    }

  private:
    pid_t id_ = 0;
    bool running_ = true;
};

// TetGen says so, or dies of the failed allocation, when it runs into the limit.
bool speaks_of_memory(const std::string& words) {
    return words.find("memory") != std::string::npos ||
           words.find("bad_alloc") != std::string::npos ||
           words.find("shared librar") != std::string::npos;
}

Run judge(int status, const std::string& words) {
    Run run;
    const bool exited = WIFEXITED(status);
    const int code = exited ? WEXITSTATUS(status) : 0;
    if (exited && code == 0) {
        return run;
    }
    if (!exited && WTERMSIG(status) == SIGXCPU) {
        run.outcome = Outcome::out_of_time;
    } else if (code == tetgen_pipe::no_memory || speaks_of_memory(words) ||
               (!exited && WTERMSIG(status) == SIGKILL)) {
        run.outcome = Outcome::out_of_memory;
    } else {
        run.outcome = exited ? Outcome::refused : Outcome::died;
    }
    run.message = exited ? fmt::format("TetGen gave up with code {}", code)
                         : fmt::format("TetGen died of signal {}", WTERMSIG(status));
    if (!words.empty()) {
        run.message += fmt::format(" (\"{}\")", words);
    }
    return run;
}

}  // namespace

std::filesystem::path find_worker(const std::filesystem::path& wanted) {
    std::vector<std::filesystem::path> places;
    if (!wanted.empty()) {
        places.push_back(wanted);
    } else {
        std::error_code error;
        const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
        if (!error) {
            places.push_back(self.parent_path() / "tyndall-tetgen");
        }
        places.emplace_back(std::filesystem::path(TYNDALL_BUILD_BIN) / "tyndall-tetgen");
        places.emplace_back(std::filesystem::path(TYNDALL_INSTALL_BIN) / "tyndall-tetgen");
    }
    std::string tried;
    for (const auto& place : places) {
        if (access(place.c_str(), X_OK) == 0 && !std::filesystem::is_directory(place)) {
            return place;
        }
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    throw InputError(
        fmt::format("Cannot find the program that runs TetGen (looked for {}). Install "
                    "tyndall-tetgen beside tyndall, or name it in the options.",
                    tried));
}

Run run(const std::filesystem::path& worker, const std::string& switches, const Input& input,
        const Limits& limits) {
    TemporaryFile in, out, err;
    write_input(in, input);
    const auto cpu =
        static_cast<unsigned long long>(std::ceil(std::clamp(limits.cpu_seconds, 1.0, 1e9)));
    Child child(worker,
                {worker.string(), switches, std::to_string(cpu), std::to_string(limits.bytes)},
                in.descriptor(), out.descriptor(), err.descriptor());
    int status = 0;
    if (!child.wait(limits.seconds, status)) {
        return {Outcome::out_of_time,
                fmt::format("TetGen ran longer than {:.3g} s", limits.seconds),
                {}};
    }
    auto result = judge(status, last_words(err));
    if (result.outcome == Outcome::done && !read_output(out, result.output)) {
        result.outcome = Outcome::died;
        result.message = "TetGen's result is cut short";
    }
    return result;
}

}  // namespace tyndall::mesh::tetgen
