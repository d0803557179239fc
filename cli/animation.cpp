#include "cli/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "cli/scene_keys.h"
#include "cli/toml_reader.h"
#include "cli/toml_text.h"

namespace tyndall::cli {
namespace {

constexpr std::size_t most_frames = 10000;
constexpr Range key_value{-1e30, 1e30};

TrackValue read_value(const TableReader& track, const toml::node& node) {
    if (const auto* text = node.as_string()) return {text->get()};
    const auto* array = node.as_array();
    if (!array) return {track.number_at(node, "a value of " + track.thing(), key_value)};
    std::vector<TrackValue> values;
    for (const toml::node& element : *array) {
        if (element.is_string())
            fail_at(place_of(element.source()),
                    fmt::format("a value of {} holds {} in an array. Give numbers, arrays of "
                                "numbers, or strings alone.",
                                track.thing(), text_of(element)));
        values.push_back(read_value(track, element));
    }
    return {std::move(values)};
}

bool is_text(const TrackValue& value) {
    return std::holds_alternative<std::string>(value.value);
}

// Both numbers, both strings, or arrays of the same shape.
bool same_shape(const TrackValue& a, const TrackValue& b) {
    if (a.value.index() != b.value.index()) return false;
    const auto* first = std::get_if<std::vector<TrackValue>>(&a.value);
    if (!first) return true;
    const auto& second = std::get<std::vector<TrackValue>>(b.value);
    return std::equal(first->begin(), first->end(), second.begin(), second.end(), same_shape);
}

std::vector<double> read_keyframes(const TableReader& track, const Animation& animation) {
    constexpr std::array<std::string_view, 2> kinds{"frames", "times"};
    const std::string_view kind = track.exactly_one(kinds);
    const double scale = kind == "times" ? animation.fps : 1.0;
    std::vector<double> frames;
    for (const toml::node& node : track.array(kind)) {
        const double number = track.number_at(
            node, fmt::format("a keyframe ({}) of {}", kind, track.thing()), {0.0, 1e9});
        if (!frames.empty() && scale * number <= frames.back())
            fail_at(place_of(node.source()),
                    fmt::format("{} of {} do not ascend: {} comes after {}. Sort them, each once.",
                                kind, track.thing(), number, frames.back() / scale));
        frames.push_back(scale * number);
    }
    if (frames.empty())
        track.fail(kind,
                   fmt::format("{} of {} are empty. Give at least one.", kind, track.thing()));
    return frames;
}

void read_values(const TableReader& reader, Track& track) {
    const toml::array& array = reader.array("values");
    if (array.size() != track.frames.size())
        reader.fail("values", fmt::format("{} has {} values and {} keyframes. Give as many.",
                                          reader.thing(), array.size(), track.frames.size()));
    for (const toml::node& node : array) {
        track.values.push_back(read_value(reader, node));
        if (!same_shape(track.values.front(), track.values.back()))
            fail_at(place_of(node.source()),
                    fmt::format("the value {} of {} has not the shape of the first, {}. Give "
                                "numbers throughout, or arrays of as many.",
                                text_of(node), reader.thing(), text_of(*array.get(0))));
        if (is_text(track.values.back()) && track.interpolation != Interpolation::step)
            fail_at(place_of(node.source()),
                    fmt::format("the value {} of {} is a string, which has nothing between it and "
                                "the next. Set interpolation = \"step\".",
                                text_of(node), reader.thing()));
    }
}

Track read_track(const toml::table& table, const Animation& animation) {
    constexpr std::array<std::string_view, 3> names{"linear", "smooth", "step"};
    const TableReader unnamed(table, keys::animation_track(), "a track of the animation");
    Track track;
    track.key = unnamed.text("key");
    track.place = unnamed.where("key");
    if (track.key.find('.') == std::string::npos || track.key.find('=') != std::string::npos ||
        track.key.starts_with("animation."))
        unnamed.fail("key", fmt::format("\"{}\" is no key that can change. Give one as --set takes "
                                        "it, such as \"material.lamp.emission\".",
                                        track.key));
    const TableReader reader(table, keys::animation_track(),
                             fmt::format("track \"{}\"", track.key));
    if (reader.has("interpolation"))
        track.interpolation = static_cast<Interpolation>(reader.choice("interpolation", names));
    track.frames = read_keyframes(reader, animation);
    read_values(reader, track);
    return track;
}

TrackValue between(const TrackValue& a, const TrackValue& b, double t) {
    if (const auto* number = std::get_if<double>(&a.value))
        return {*number + t * (std::get<double>(b.value) - *number)};
    const auto* first = std::get_if<std::vector<TrackValue>>(&a.value);
    if (!first) return a;
    std::vector<TrackValue> values;
    for (std::size_t k = 0; k < first->size(); ++k)
        values.push_back(between((*first)[k], std::get<std::vector<TrackValue>>(b.value)[k], t));
    return {std::move(values)};
}

TrackValue value_at(const Track& track, double frame) {
    const auto next = std::upper_bound(track.frames.begin(), track.frames.end(), frame);
    if (next == track.frames.begin()) return track.values.front();
    const auto k = static_cast<std::size_t>(next - track.frames.begin()) - 1;
    if (next == track.frames.end() || track.interpolation == Interpolation::step ||
        frame == track.frames[k])
        return track.values[k];
    double t = (frame - track.frames[k]) / (track.frames[k + 1] - track.frames[k]);
    if (track.interpolation == Interpolation::smooth) t = t * t * (3.0 - 2.0 * t);
    return between(track.values[k], track.values[k + 1], t);
}

// As TOML writes it; a whole number stays one.
std::string toml_of(const TrackValue& value) {
    if (const auto* number = std::get_if<double>(&value.value)) return fmt::format("{}", *number);
    if (const auto* text = std::get_if<std::string>(&value.value))
        return whole_text_of(toml::value<std::string>(*text));
    std::string text;
    for (const TrackValue& element : std::get<std::vector<TrackValue>>(value.value))
        text += (text.empty() ? "" : ", ") + toml_of(element);
    return "[" + text + "]";
}

}  // namespace

std::optional<Animation> read_animation(const TableReader& root) {
    if (!root.has("animation")) return {};
    const TableReader reader = root.table("animation", keys::animation(), "[animation]");
    Animation animation;
    animation.frames = reader.count("frames", 1, most_frames);
    animation.fps = reader.number("fps", {0.0, 1e6, true, false}, animation.fps);
    std::set<std::string> keys;
    for (const toml::table* table : reader.tables("track")) {
        animation.tracks.push_back(read_track(*table, animation));
        const Track& track = animation.tracks.back();
        if (!keys.insert(track.key).second)
            fail_at(track.place, fmt::format("there is a track \"{}\" already. Join their "
                                             "keyframes.",
                                             track.key));
    }
    return animation;
}

std::vector<FrameSetting> settings_of_frame(const Animation& animation, std::size_t frame) {
    std::vector<FrameSetting> settings;
    for (const Track& track : animation.tracks)
        settings.push_back(
            {track.key, toml_of(value_at(track, static_cast<double>(frame))), track.place, frame});
    return settings;
}

}  // namespace tyndall::cli
