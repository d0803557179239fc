#include "cli/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "mesh/input_error.h"
#include "radiosity/resources.h"

namespace tyndall::cli {
namespace {

using namespace std::chrono_literals;
constexpr auto first_pause = 1ms, longest_pause = 50ms;
constexpr int cannot_start = 127;

// Between fork and exec: nothing that allocates.
[[noreturn]] void become(const char* program, char* const* argv, int messages, pid_t parent,
                         const sigset_t& signals) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(cannot_start);  // it died before the line above
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(messages, STDERR_FILENO);
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    ::sigprocmask(SIG_SETMASK, &signals, nullptr);
    ::execv(program, argv);
    ::_exit(cannot_start);
}

pid_t start(const std::filesystem::path& program, std::vector<std::string> arguments,
            const std::filesystem::path& messages) {
    const int file = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0)
        throw mesh::InputError(
            fmt::format("cannot write '{}': {}.", messages.string(), std::strerror(errno)));
    std::string name = program.string();
    std::vector<char*> argv{name.data()};
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    // A signal that comes before the child has become the program must not meet our handlers: it
    // waits until they are gone.
    sigset_t wait, before;
    sigemptyset(&wait);
    sigaddset(&wait, SIGINT);
    sigaddset(&wait, SIGTERM);
    ::sigprocmask(SIG_BLOCK, &wait, &before);
    const pid_t parent = ::getpid();
    const pid_t id = ::fork();
    if (id == 0) become(name.c_str(), argv.data(), file, parent, before);
    const int error = errno;
    ::sigprocmask(SIG_SETMASK, &before, nullptr);
    ::close(file);
    if (id < 0)
        throw mesh::InputError(
            fmt::format("cannot start '{}': {}.", program.string(), std::strerror(error)));
    return id;
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ChildOutcome run_child(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& messages,
                       const std::function<bool()>& keep_on) {
    ChildOutcome outcome;
    const double began = radiosity::wall_seconds();
    const pid_t id = start(program, arguments, messages);
    int status = 0;
    rusage usage{};
    for (auto pause = std::chrono::milliseconds(first_pause);;
         pause = std::min<std::chrono::milliseconds>(2 * pause, longest_pause)) {
        const pid_t ended = ::wait4(id, &status, WNOHANG, &usage);
        if (ended == id) break;
        if (ended < 0 && errno != EINTR)
            throw mesh::InputError(
                fmt::format("lost sight of '{}' ({}).", program.string(), std::strerror(errno)));
        if (!outcome.stop_was_asked && !keep_on()) {
            outcome.stop_was_asked = true;
            ::kill(id, SIGTERM);
        }
        std::this_thread::sleep_for(pause);
    }
    outcome.wall_seconds = radiosity::wall_seconds() - began;
    outcome.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    outcome.peak_memory_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    if (outcome.exit_code == cannot_start)
        throw mesh::InputError(fmt::format("cannot start '{}'.", program.string()));
    return outcome;
}

}  // namespace tyndall::cli
