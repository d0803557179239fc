#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "cli/progress.h"
#include "support/catch.h"

namespace {

using namespace tyndall::cli;
using tyndall::radiosity::Progress;

// What a child shows on a terminal of its own while it computes.
std::string on_terminal(const CommonFlags& flags) {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
        ::setenv("TERM", "xterm", 1);
        {
            ProgressLine line(flags);
            const auto callback = line.callback();
            callback({"mesh", 0.5});
            callback({"pass 1: rows", 0.25, 1234, 1e-3});
        }
        std::_Exit(0);
    }
    std::string shown;
    char buffer[4096];
    // Reading fails when the child has closed its end.
    for (ssize_t count; (count = ::read(terminal, buffer, sizeof buffer)) > 0;)
        shown.append(buffer, static_cast<std::size_t>(count));
    ::waitpid(child, nullptr, 0);
    ::close(terminal);
    return shown;
}

}  // namespace

TEST_CASE("the line tells stage, percentage, elements, residual and time left") {
    CHECK(progress_text({"pass 3: rows", 0.25, 12340, 1.23e-4}, 30.0) ==
          "pass 3: rows   25 %   12340 elements   residual 1.2e-04   1:30 left");
    CHECK(progress_text({"mesh", 0.0}, 5.0) == "mesh   0 %");
    CHECK(progress_text({"mesh", 0.999}, 5.0) == "mesh   99 %   0:00 left");
    CHECK(progress_text({"mesh", 1.0}, 5.0) == "mesh   100 %");
    CHECK(progress_text({"rows", 0.5}, 7321.0) == "rows   50 %   2:02:01 left");
    CHECK(progress_text({"rows", 1.7}, 1.0) == "rows   100 %");
}

TEST_CASE("a terminal shows one line that is written over and taken away") {
    const auto shown = on_terminal({});
    CHECK_THAT(shown,
               Contains("\rmesh   50 %") && Contains("\rpass 1: rows   25 %   1234 elements"));
    CHECK(shown.find('\n') == std::string::npos);
    CHECK(shown.substr(shown.size() - 4) == "\r\x1b[K");
}

TEST_CASE("the flag --quiet shows nothing") {
    CommonFlags flags;
    flags.quiet = true;
    CHECK(on_terminal(flags).empty());
}

TEST_CASE("Ctrl-C asks for a stop; the second one ends the program") {
    CommonFlags flags;
    {
        ProgressLine line(flags);
        const auto callback = line.callback();
        CHECK(callback({"rows", 0.1}));
        std::raise(SIGTERM);
        CHECK_FALSE(callback({"rows", 0.2}));
        CHECK(line.stopped());
    }
    const pid_t child = ::fork();
    if (child == 0) {
        const StopOnInterrupt interrupt;
        std::raise(SIGINT);
        if (interrupt.requested()) std::raise(SIGINT);
        std::_Exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == SIGINT);
}

TEST_CASE("the next line does not stop because an earlier one was") {
    CommonFlags flags;
    ProgressLine line(flags);
    CHECK(line.callback()({"rows", 0.1}));
}
