// [animation] of a scene file: keys that change in time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tyndall::cli {

class TableReader;

enum class Interpolation {
    linear,  // straight between keyframes
    smooth,  // with slope 0 at them: 3 t^2 - 2 t^3
    step,    // each value until the next keyframe
};

// A number, a string, or an array of numbers or of such arrays.
struct TrackValue {
    std::variant<double, std::string, std::vector<TrackValue>> value;
};

struct Track {
    std::string key;             // as --set takes it
    std::string place;           // file:line:column of the key
    std::vector<double> frames;  // keyframes, ascending
    std::vector<TrackValue> values;
    Interpolation interpolation = Interpolation::linear;
};

struct Animation {
    std::size_t frames = 1;
    double fps = 24.0;  // [1/s]
    std::vector<Track> tracks;
};

// Throws mesh::InputError with the place of what is wrong: no keyframes or both kinds, times and
// values that differ in number or shape, keyframes that do not ascend, strings that are
// interpolated, a key that is given twice or is of the animation itself. That the scene has the
// key, read_scene_file finds out.
std::optional<Animation> read_animation(const TableReader& root);

// What a track sets in a frame.
struct FrameSetting {
    std::string key, value;  // as --set takes them
    std::string place;       // of the track
    std::size_t frame = 0;

    std::string text() const { return key + "=" + value; }
};

// The value of every track in a frame; before the first keyframe the first value, after the last
// one the last.
std::vector<FrameSetting> settings_of_frame(const Animation& animation, std::size_t frame);

}  // namespace tyndall::cli
