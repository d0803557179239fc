// What a run says at its end: report.json, and a few lines for people.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "radiosity/solution.h"

namespace tyndall::cli {

// What a report needs beyond the solution's own.
struct RunFacts {
    std::string scene;  // path as given
    std::uint64_t seed = 1;
    std::size_t threads = 0;             // that were used
    double began = 0.0;                  // radiosity::wall_seconds() then [s]
    std::filesystem::path resumed_from;  // the pass that was gone on with; empty: none
    std::vector<std::filesystem::path> written;
    std::string command{};  // that makes the same again
};

// A command line as a shell takes it, words quoted where they must be.
std::string command_line(const std::vector<std::string>& words);

// The number of threads that are used now.
std::size_t threads_in_use();

// report.json, with what has been spent until now. Ends with a line break.
std::string report_text(const radiosity::Report& report, const RunFacts& facts);

// A few lines about the result; warnings among them.
std::string summary_text(const radiosity::Report& report, const RunFacts& facts);

}  // namespace tyndall::cli
