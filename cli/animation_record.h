// What there is of an animation in its folder: whole frames, and their report.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/run_report.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// A frame that is whole, as report.json tells of it.
struct FrameRecord {
    std::vector<std::string> changed;  // since the frame before
    std::string done;                  // kept, superposed, moved or solved
    double cpu_seconds = 0.0;          // of its light
    double picture_cpu_seconds = 0.0;
    // Rays walked for this frame's light, of those of a full solve: of moved frames; else none [-].
    std::optional<double> rays_share;
    double estimated_error = 0.0;
    std::size_t patches = 0, zones = 0;
    std::vector<std::string> warnings;
    // Of solved frames: exchange areas of the first elements are those of a frame before.
    bool rows_kept = false;
};

// Solutions that frames are sums of, or the one that frames with moved bodies begin with.
struct UnitsRecord {
    std::size_t first = 0, end = 0;                // frames
    std::vector<std::vector<std::string>> groups;  // their sources; none where bodies move
    std::vector<std::string> moving;               // surfaces that move
    std::size_t solves = 0;
    double cpu_seconds = 0.0;
};

class AnimationRecord {
  public:
    // What an earlier job has left in the folder, where it was of the same `key` (run_key of the
    // scene); else an empty record, and frames of the other scene are removed from the folder.
    AnimationRecord(std::filesystem::path folder, std::string key, double fps);

    bool has(std::size_t frame) const;
    void forget(std::size_t frame) { frames_.erase(frame); }
    void add(std::size_t frame, FrameRecord record);
    void add(UnitsRecord units);

    std::optional<double> white;  // radiance shown as white in all frames [W/m^2/sr]

    std::filesystem::path picture(std::size_t frame, const char* extension) const;
    std::filesystem::path solution(std::size_t frame) const;

    std::size_t size() const { return frames_.size(); }
    std::string text(const RunFacts& facts, std::size_t frames) const;
    // report.json, and solutions.vtkhdf.series, which ParaView plays.
    void write(const RunFacts& facts, std::size_t frames) const;

  private:
    void read();

    std::filesystem::path folder_;
    std::string key_;
    double fps_;
    std::map<std::size_t, FrameRecord> frames_;
    std::vector<UnitsRecord> units_;
};

}  // namespace tyndall::cli
