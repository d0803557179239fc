#include "cli/animation_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/file_series.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/resources.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string frames_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json json_of(std::size_t frame, const FrameRecord& record) {
    return {{"frame", frame},
            {"changed", record.changed},
            {"done", record.done},
            {"cpu_seconds", record.cpu_seconds},
            {"picture_cpu_seconds", record.picture_cpu_seconds},
            {"rows_kept", record.rows_kept},
            {"rays_share", record.rays_share ? Json(*record.rays_share) : Json()},
            {"estimated_error", record.estimated_error},
            {"patches", record.patches},
            {"zones", record.zones},
            {"warnings", record.warnings}};
}

FrameRecord frame_record_of(const Json& json) {
    FrameRecord record{json.at("changed"),     json.at("done"),
                       json.at("cpu_seconds"), json.at("picture_cpu_seconds"),
                       std::nullopt,           json.at("estimated_error"),
                       json.at("patches"),     json.at("zones"),
                       json.at("warnings")};
    record.rows_kept = json.value("rows_kept", false);
    if (json.at("rays_share").is_number()) record.rays_share = json.at("rays_share").get<double>();
    return record;
}

Json json_of(const UnitsRecord& units) {
    return {{"frames", {units.first, units.end - 1}},
            {"groups", units.groups},
            {"moving", units.moving},
            {"solves", units.solves},
            {"cpu_seconds", units.cpu_seconds}};
}

UnitsRecord units_of(const Json& json) {
    return {json.at("frames").at(0), json.at("frames").at(1).get<std::size_t>() + 1,
            json.at("groups"),       json.at("moving"),
            json.at("solves"),       json.at("cpu_seconds")};
}

void remove_files(const fs::path& folder, std::initializer_list<const char*> extensions) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (std::any_of(extensions.begin(), extensions.end(),
                        [&](const char* one) { return entry.path().extension() == one; }))
            fs::remove(entry.path(), none);
}

}  // namespace

AnimationRecord::AnimationRecord(fs::path folder, std::string key, double fps)
    : folder_(std::move(folder)), key_(std::move(key)), fps_(fps) {
    read();
    if (!frames_.empty()) return;
    remove_files(folder_ / "frames", {".exr", ".png"});
    remove_files(folder_ / "solutions", {".vtkhdf"});
}

// A report that cannot be read, or is not of an animation, is none.
void AnimationRecord::read() {
    try {
        const Json json = Json::parse(mesh::read_file(folder_ / "report.json"));
        if (json.at("key") != key_) return;
        std::map<std::size_t, FrameRecord> frames;
        for (const Json& frame : json.at("frames"))
            frames[frame.at("frame")] = frame_record_of(frame);
        for (const Json& units : json.at("units")) units_.push_back(units_of(units));
        if (json.at("white").is_number()) white = json.at("white").get<double>();
        frames_ = std::move(frames);
    } catch (const mesh::InputError&) {
    } catch (const nlohmann::json::exception&) {
    }
}

bool AnimationRecord::has(std::size_t frame) const {
    const bool pictured = fs::exists(picture(frame, "exr")) && fs::exists(picture(frame, "png"));
    return frames_.contains(frame) && fs::exists(solution(frame)) && (pictured || !white);
}

void AnimationRecord::add(std::size_t frame, FrameRecord record) {
    frames_[frame] = std::move(record);
}

void AnimationRecord::add(UnitsRecord units) {
    units_.push_back(std::move(units));
}

fs::path AnimationRecord::picture(std::size_t frame, const char* extension) const {
    return folder_ / "frames" / fmt::format("{:04}.{}", frame, extension);
}

fs::path AnimationRecord::solution(std::size_t frame) const {
    return folder_ / "solutions" / fmt::format("{:04}.vtkhdf", frame);
}

std::string AnimationRecord::text(const RunFacts& facts, std::size_t frames) const {
    Json json{{"scene", facts.scene},
              {"version", TYNDALL_VERSION},
              {"key", key_},
              {"seed", facts.seed},
              {"threads", facts.threads},
              {"frame_count", frames},
              {"fps", fps_},
              {"white", white ? Json(*white) : Json()},
              {"cpu_seconds", radiosity::cpu_seconds()},
              {"wall_seconds", radiosity::wall_seconds() - facts.began},
              {"peak_memory_bytes", radiosity::peak_memory_bytes()},
              {"units", Json::array()},
              {"frames", Json::array()}};
    for (const auto& units : units_) json["units"].push_back(json_of(units));
    for (const auto& [frame, record] : frames_) json["frames"].push_back(json_of(frame, record));
    return frames_text(json);
}

void AnimationRecord::write(const RunFacts& facts, std::size_t frames) const {
    std::vector<std::pair<std::string, double>> series;
    for (const auto& [frame, record] : frames_)
        series.emplace_back("solutions/" + solution(frame).filename().string(),
                            static_cast<double>(frame) / fps_);
    mesh::write_file(folder_ / "solutions.vtkhdf.series", file_series(series));
    mesh::write_file(folder_ / "report.json", text(facts, frames));
}

}  // namespace tyndall::cli
