// Study files: which runs of a scene, and what they are measured by.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/types.h"

namespace tyndall::cli {

// An override of the scene with the place in the study file (or "--set …") that it comes from.
struct PlacedSetting {
    std::string key;    // "solve.error"
    std::string value;  // as TOML writes it
    std::string place;

    std::string text() const { return key + "=" + value; }
};

// What is compared with a reference.
enum class MeasureKind { picture, single_scattering, surfaces, media, probe };

inline constexpr std::array<std::string_view, 5> measure_names{"picture", "single_scattering",
                                                               "surfaces", "media", "probe"};

// A file (picture, solution, folder with one, probe values), or a finer run.
struct ReferenceSource {
    std::filesystem::path file;            // empty: a run with `overrides`
    std::vector<PlacedSetting> overrides;  // of that run, after those of [set]
    std::string place;
};

struct StudyMeasure {
    MeasureKind kind = MeasureKind::picture;
    ReferenceSource reference;

    std::string_view name() const { return measure_names[static_cast<std::size_t>(kind)]; }
    bool of_picture() const { return kind != MeasureKind::probe; }
};

struct AxisValue {
    std::string toml;              // as TOML writes it
    std::string label;             // strings without their quotes
    std::optional<double> number;  // of a numeric value
    std::string place;
};

struct Axis {
    std::string key;
    std::vector<AxisValue> values;
    std::string place;

    bool numeric() const;
};

// Every combination of the axes' values is run.
struct Matrix {
    std::string name;                  // "" if it has none
    std::vector<Axis> axes;            // in the file's order
    std::optional<std::size_t> along;  // index of the numeric axis that curves follow

    std::size_t size() const;
};

struct SlicePlane {
    mesh::Point point{0.0};
    mesh::Direction normal{0.0};
};

struct Study {
    std::filesystem::path file, scene;
    std::string scene_place, title;
    std::vector<StudyMeasure> measures;
    std::vector<Matrix> matrices;
    std::vector<PlacedSetting> set;  // for every run, the reference's too
    std::vector<double> errors;      // for which the elements needed are told [-]
    std::filesystem::path points;    // of probes; empty: points of the program's choice
    std::string points_place;
    std::size_t probe_rays = 1024, probe_count = 128;
    std::optional<SlicePlane> slice;
};

// Purpose: reads a study file. Paths in it are relative to it.
// Errors: mesh::InputError "file:line:column: what is wrong. What to do.". Whether the axes' keys
//   are known and their values fit shows when the scene is read with them (study_matrix.h).
Study read_study_file(const std::filesystem::path& path);

// Every key of a study file as Markdown tables: the reference in the documentation.
std::string study_file_reference();

}  // namespace tyndall::cli
