// What a report says beside the solution's own figures: report.json as a page needs it.
#pragma once

#include <optional>
#include <string>

#include "radiosity/solution.h"

namespace tyndall::view {

struct ReportFacts {
    radiosity::Report report;
    // Of the run, where report.json is there; else empty, or 0.
    std::string scene;    // path as it was given
    std::string command;  // that makes the same again
    std::string resumed_from;
    std::optional<std::uint64_t> seed;
    std::size_t threads = 0;
    double cpu_seconds = 0.0, wall_seconds = 0.0, peak_memory_bytes = 0.0;
};

// Purpose: the facts in the text of report.json; with "" those of the solution alone.
// Errors: mesh::InputError where the text is no report.
ReportFacts report_facts(const radiosity::Solution& solution, const std::string& report_json);

}  // namespace tyndall::view
