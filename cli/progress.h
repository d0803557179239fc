// Progress on a terminal, and Ctrl-C.
#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

#include "cli/common_flags.h"
#include "radiosity/progress.h"

namespace tyndall::cli {

// While one lives, Ctrl-C (SIGINT) and SIGTERM ask for a stop instead of ending the program; the
// second one ends it. One at a time.
class StopOnInterrupt {
  public:
    StopOnInterrupt();
    ~StopOnInterrupt();
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

    bool requested() const;
};

// What the line says: "pass 3: rows   42 %   12340 elements   residual 1.2e-04   0:35 left".
// `elapsed`: since the stage began [s]; the time left is that of the stage, foreseen from its
// fraction.
std::string progress_text(const radiosity::Progress& progress, double elapsed);

// Shows where a long computation is, on one line of stderr that it writes over; nothing if stderr
// is no terminal or with --quiet. Clears the line in the end. Also tells the computation to stop
// when the user asks for it.
class ProgressLine {
  public:
    explicit ProgressLine(const CommonFlags& flags);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // To be handed to a computation that this object outlives.
    radiosity::ProgressCallback callback();
    // Whether the user asked for a stop.
    bool stopped() const { return interrupt_.requested(); }
    // What every line begins with from now on: "frame 3 of 48: ".
    void begin_with(const std::string& text);
    // Takes the line away, so that other text can be printed.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    void show(const radiosity::Progress& progress);

    StopOnInterrupt interrupt_;
    bool on_terminal_;
    std::mutex mutex_;
    std::string begins_with_, stage_;
    Clock::time_point stage_began_, last_shown_;
    bool visible_ = false;
};

}  // namespace tyndall::cli
