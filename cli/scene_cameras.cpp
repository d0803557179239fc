#include "cli/scene_cameras.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cli/scene_keys.h"
#include "cli/scene_optics.h"

namespace tyndall::cli {
namespace {

constexpr Range length{0.0, 1e9, true};

constexpr std::array<std::string_view, 3> projections{"perspective", "orthographic", "panorama"};
constexpr std::array<std::string_view, 2> angles{"fov_x", "fov_y"}, extents{"extent_x", "extent_y"};

void read_angle(const TableReader& reader, render::Camera& camera) {
    constexpr Range range{0.0, 180.0, true, true};
    const std::string_view which = reader.exactly_one(angles);
    const double radians = reader.number(which, range) * std::numbers::pi / 180.0;
    (which == angles[0] ? camera.fov_x : camera.fov_y) = radians;
}

void read_extent(const TableReader& reader, render::Camera& camera) {
    const std::string_view which = reader.exactly_one(extents);
    (which == extents[0] ? camera.extent_x : camera.extent_y) = reader.number(which, length);
}

// What is no part of this projection.
template <std::size_t n>
void refuse(const TableReader& reader, const std::array<std::string_view, n>& keys,
            std::string_view projection) {
    for (const auto key : keys)
        if (reader.has(key))
            reader.fail(key, fmt::format("{} of {} has no part in {} {} picture. Leave it out.",
                                         key, reader.thing(),
                                         projection == "orthographic" ? "an" : "a", projection));
}

void read_projection(const TableReader& reader, render::Camera& camera) {
    using radiosity::PictureProjection;
    if (reader.has("projection"))
        camera.projection =
            static_cast<PictureProjection>(reader.choice("projection", projections));
    const auto name = projections[static_cast<std::size_t>(camera.projection)];
    // Angles are passed over there, so that --set can turn a camera into a panorama and back.
    if (camera.projection != PictureProjection::perspective)
        refuse(reader, std::array<std::string_view, 1>{"lens"}, name);
    if (camera.projection != PictureProjection::orthographic) refuse(reader, extents, name);
    if (camera.projection == PictureProjection::perspective) read_angle(reader, camera);
    if (camera.projection == PictureProjection::orthographic) read_extent(reader, camera);
    if (!reader.has("lens")) return;
    const TableReader lens = reader.table("lens", keys::lens());
    camera.lens = {lens.number("diameter", length), lens.number("focus", length)};
}

void read_size(const TableReader& reader, render::Camera& camera) {
    constexpr std::size_t longest = 65536, most = std::size_t(1) << 28;
    const bool panorama = camera.projection == radiosity::PictureProjection::panorama;
    if (panorama) camera.height = camera.width / 2;
    if (reader.has("width")) camera.width = reader.count("width", panorama ? 2 : 1, longest);
    if (panorama) camera.height = camera.width / 2;
    if (reader.has("height")) camera.height = reader.count("height", 1, longest);
    if (panorama && camera.width != 2 * camera.height)
        reader.fail(reader.has("height") ? "height" : "width",
                    fmt::format("{} is a panorama of {} × {} pixels. It shows 360° by 180°: give "
                                "twice as many across as upright.",
                                reader.thing(), camera.width, camera.height));
    if (camera.width * camera.height > most)
        reader.fail("width",
                    fmt::format("{} has {} × {} pixels, more than {}. Make the picture smaller.",
                                reader.thing(), camera.width, camera.height, most));
}

}  // namespace

render::Camera read_camera(const TableReader& reader, const std::string& name) {
    render::Camera camera;
    camera.name = name;
    camera.eye = reader.vector("eye", coordinate);
    camera.target = reader.vector("target", coordinate);
    const glm::dvec3 view = camera.target - camera.eye;
    if (!(glm::length(view) > 0.0)) {
        reader.fail("target",
                    fmt::format("target of {} is its eye. Move one of them.", reader.thing()));
    }
    if (reader.has("up")) camera.up = read_direction(reader, "up");
    if (!(glm::length(glm::cross(glm::normalize(view), camera.up)) > 1e-9)) {
        reader.fail("up",
                    fmt::format("up of {} is parallel to its view. Give another up, such as {}.",
                                reader.thing(),
                                std::abs(view.y) < std::abs(view.z) ? "[0, 1, 0]" : "[0, 0, 1]"));
    }
    read_projection(reader, camera);
    read_size(reader, camera);
    return camera;
}

}  // namespace tyndall::cli
