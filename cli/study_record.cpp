#include "cli/study_record.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;

// JSON knows no NaN: it is null.
double number_or_nan(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json figures_json(const RunFigures& f) {
    return {{"patches", f.patches},
            {"zones", f.zones},
            {"rays", f.rays},
            {"cpu_seconds", f.cpu_seconds},
            {"wall_seconds", f.wall_seconds},
            {"memory_bytes", f.memory_bytes},
            {"estimated_error", f.estimated_error},
            {"estimated_picture_error", f.estimated_picture_error},
            {"estimated_solution_error", f.estimated_solution_error},
            {"tet_quality_min", f.tet_quality_min},
            {"tet_quality_mean", f.tet_quality_mean},
            {"triangle_quality_min", f.triangle_quality_min},
            {"triangle_quality_mean", f.triangle_quality_mean}};
}

RunFigures figures_of(const Json& json) {
    RunFigures f;
    f.patches = json.at("patches").get<std::size_t>();
    f.zones = json.at("zones").get<std::size_t>();
    f.rays = json.at("rays").get<std::size_t>();
    f.cpu_seconds = number_or_nan(json.at("cpu_seconds"));
    f.wall_seconds = number_or_nan(json.at("wall_seconds"));
    f.memory_bytes = json.at("memory_bytes").get<std::size_t>();
    f.estimated_error = number_or_nan(json.at("estimated_error"));
    f.estimated_picture_error = number_or_nan(json.value("estimated_picture_error", Json()));
    f.estimated_solution_error = number_or_nan(json.value("estimated_solution_error", Json()));
    f.tet_quality_min = number_or_nan(json.at("tet_quality_min"));
    f.tet_quality_mean = number_or_nan(json.at("tet_quality_mean"));
    f.triangle_quality_min = number_or_nan(json.at("triangle_quality_min"));
    f.triangle_quality_mean = number_or_nan(json.at("triangle_quality_mean"));
    return f;
}

RunRecord run_record_of(const Json& json) {
    RunRecord record;
    record.key = json.at("key").get<std::string>();
    record.overrides = json.at("overrides").get<std::vector<std::string>>();
    record.figures = figures_of(json.at("figures"));
    record.drawn = json.at("drawn").get<std::string>();
    for (const auto& [name, e] : json.at("errors").items()) {
        record.errors[name] = {number_or_nan(e.at("rmse")), number_or_nan(e.at("bias")),
                               number_or_nan(e.at("block4")), number_or_nan(e.at("block16"))};
        record.measured[name] = e.at("reference").get<std::string>();
    }
    record.failure = json.at("failure").get<std::string>();
    return record;
}

}  // namespace

std::optional<RunRecord> read_record(const std::filesystem::path& folder) {
    try {
        return run_record_of(Json::parse(mesh::read_file(folder / "run.json")));
    } catch (const mesh::InputError&) {
        return std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

void write_record(const std::filesystem::path& folder, const RunRecord& record) {
    Json json{{"key", record.key},
              {"overrides", record.overrides},
              {"figures", figures_json(record.figures)},
              {"drawn", record.drawn},
              {"errors", Json::object()},
              {"failure", record.failure}};
    for (const auto& [name, e] : record.errors)
        json["errors"][name] = {{"rmse", e.rmse},
                                {"bias", e.bias},
                                {"block4", e.block4},
                                {"block16", e.block16},
                                {"reference", record.measured.at(name)}};
    mesh::write_file(folder / "run.json",
                     json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string digest(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return fmt::format("{:016x}", hash);
}

}  // namespace tyndall::cli
