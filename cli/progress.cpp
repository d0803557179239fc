#include "cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace tyndall::cli {

namespace {

using namespace std::chrono_literals;

// A signal handler can only reach a static object.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr auto refresh = 100ms;
constexpr double least_fraction = 0.02;  // below it no time left is foreseen

extern "C" void request_stop(int signal) {
    if (stop_requested.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;  // a write in progress goes on
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

bool stderr_is_terminal() {
    const char* kind = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::strcmp(kind, "dumb") != 0);
}

std::size_t terminal_width() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

std::string clock_text(double seconds) {
    const auto whole = static_cast<long long>(std::llround(seconds));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
    stop_requested = false;
    handle(SIGINT, request_stop);
    handle(SIGTERM, request_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
    handle(SIGINT, SIG_DFL);
    handle(SIGTERM, SIG_DFL);
}

bool StopOnInterrupt::requested() const {
    return stop_requested;
}

std::string progress_text(const radiosity::Progress& progress, double elapsed) {
    const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
    std::string text = fmt::format("{}   {:.0f} %", progress.stage, std::floor(100.0 * fraction));
    if (progress.elements > 0) text += fmt::format("   {} elements", progress.elements);
    if (progress.residual > 0.0) text += fmt::format("   residual {:.1e}", progress.residual);
    if (fraction >= least_fraction && fraction < 1.0)
        text += fmt::format("   {} left", clock_text(elapsed * (1.0 - fraction) / fraction));
    return text;
}

ProgressLine::ProgressLine(const CommonFlags& flags)
    : on_terminal_(!flags.quiet && stderr_is_terminal()) {}

ProgressLine::~ProgressLine() {
    clear();
}

radiosity::ProgressCallback ProgressLine::callback() {
    return [this](const radiosity::Progress& progress) {
        if (on_terminal_) show(progress);
        return !stopped();
    };
}

void ProgressLine::begin_with(const std::string& text) {
    const std::lock_guard lock(mutex_);
    begins_with_ = text;
    stage_.clear();
}

void ProgressLine::clear() {
    const std::lock_guard lock(mutex_);
    if (visible_) std::fputs("\r\x1b[K", stderr);
    visible_ = false;
}

void ProgressLine::show(const radiosity::Progress& progress) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (progress.stage != stage_) {
        stage_ = progress.stage;
        stage_began_ = now;
    } else if (now - last_shown_ < refresh) {
        return;
    }
    last_shown_ = now;
    const double elapsed = std::chrono::duration<double>(now - stage_began_).count();
    std::string text =
        (stopped() ? "stopping: " : "") + begins_with_ + progress_text(progress, elapsed);
    // A line that wraps could not be written over.
    text.resize(std::min(text.size(), terminal_width() - 1));
    fmt::print(stderr, "\r{}\x1b[K", text);
    std::fflush(stderr);
    visible_ = true;
}

}  // namespace tyndall::cli
