// What is known about one run, kept as run.json in its folder.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tyndall::cli {

// Errors against a reference, in units of its mean [-]. NaN where a measure has none.
struct MeasureErrors {
    double rmse, bias, block4, block16;
};

struct RunFigures {
    std::size_t patches = 0, zones = 0, rays = 0;
    double cpu_seconds = 0.0, wall_seconds = 0.0;
    std::size_t memory_bytes = 0;
    // Of the run's report [-]. Of the picture: NaN where it has none.
    double estimated_error = 0.0, estimated_picture_error = 0.0, estimated_solution_error = 0.0;
    // Shape quality of the leaves, 1 for regular ones [-].
    double tet_quality_min = 0.0, tet_quality_mean = 0.0;
    double triangle_quality_min = 0.0, triangle_quality_mean = 0.0;

    std::size_t elements() const { return patches + zones; }
};

struct RunRecord {
    std::string key;                     // of what was run
    std::vector<std::string> overrides;  // for people
    RunFigures figures;
    std::string drawn;                            // what the pictures of the mesh were made with
    std::map<std::string, MeasureErrors> errors;  // by measure
    std::map<std::string, std::string> measured;  // key of each measure's reference
    std::string failure;                          // why there is no result; "": there is one

    bool failed() const { return !failure.empty(); }
};

// The record of a folder; none if there is none, or it cannot be read.
std::optional<RunRecord> read_record(const std::filesystem::path& folder);
void write_record(const std::filesystem::path& folder, const RunRecord& record);

// Sixteen hexadecimal digits that tell texts apart (FNV-1a, 64 bits).
std::string digest(std::string_view text);

}  // namespace tyndall::cli
