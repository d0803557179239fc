#include "exports/mitsuba_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "exports/little_endian.h"
#include "exports/path_room.h"
#include "exports/sun_disc.h"
#include "exports/xml_writer.h"
#include "mesh/input_error.h"

namespace tyndall::exports {
namespace {

using mesh::Direction;
using mesh::InputError;
using mesh::Point;
using radiosity::none;

std::string triple(const std::array<double, 3>& v) {
    return fmt::format("{:.9g}, {:.9g}, {:.9g}", v[0], v[1], v[2]);
}

std::string triple(const Point& v) {
    return triple(std::array{v.x, v.y, v.z});
}

class MitsubaWriter {
  public:
    MitsubaWriter(const radiosity::Enclosure& enclosure, const PathTracerOptions& options)
        : e_(enclosure), options_(options), room_(path_room(enclosure, {.band = options.band})) {
        std::vector<std::string> names;
        for (const auto& medium : room_.media) names.push_back(medium.name);
        media_ = plain_names(names);
        for (auto& name : media_) name = "medium_" + name;
    }

    ExportedFiles write(std::span<const render::Camera> cameras) {
        xml_.comment(options_.title.empty() ? "A Tyndall scene" : options_.title);
        xml_.comment("Lengths in m, radiance in W/(m^2 sr). Render by a variant of rgb or mono.");
        auto scene = xml_.element("scene", {{"version", "3.0.0"}});
        write_integrator();
        for (std::size_t m = 0; m < room_.media.size(); ++m) write_medium(m);
        write_sensors(cameras);
        write_surfaces();
        for (const auto& light : room_.lights)
            std::visit([&](const auto& source) { write_light(source); }, light.source);
        if (any(room_.environment)) {
            auto emitter = xml_.element("emitter", {{"type", "constant"}});
            rgb_value("radiance", room_.environment);
        }
        scene.close();
        files_.main = xml_.text();
        return std::move(files_);
    }

  private:
    void rgb_value(const std::string& name, const Spectrum& values) {
        xml_.leaf("rgb", {{"name", name}, {"value", triple(rgb(values))}});
    }
    void number(const std::string& name, double value) {
        xml_.leaf("float", {{"name", name}, {"value", fmt::format("{:.9g}", value)}});
    }
    void whole(const std::string& name, long value) {
        xml_.leaf("integer", {{"name", name}, {"value", std::to_string(value)}});
    }
    void text(const std::string& name, const std::string& value) {
        xml_.leaf("string", {{"name", name}, {"value", value}});
    }
    void refer(const std::string& name, std::uint32_t medium) {
        if (medium != none) xml_.leaf("ref", {{"name", name}, {"id", media_[medium]}});
    }
    std::string part(const std::string& name, std::string bytes) {
        const std::string path = fmt::format("{}_parts/{}", options_.stem, name);
        files_.beside.push_back({path, std::move(bytes)});
        return path;
    }

    void write_integrator() {
        const bool coloured = std::ranges::any_of(
            room_.media, [](const RoomMedium& m) { return differ(m.extinction); });
        auto integrator =
            xml_.element("integrator", {{"type", coloured ? "volpathmis" : "volpath"}});
        whole("max_depth", -1);
        whole("rr_depth", 32);
    }

    void write_medium(std::size_t index) {
        const RoomMedium& medium = room_.media[index];
        if (any(medium.emission))
            throw InputError(fmt::format(
                "medium \"{}\" emits, which Mitsuba's media do not. Export to pbrt: --format pbrt.",
                medium.name));
        auto element = xml_.element(
            "medium",
            {{"id", media_[index]}, {"type", medium.shape ? "heterogeneous" : "homogeneous"}});
        rgb_value("albedo", medium.albedo);
        // Colours are within 0 and 1 there; the scale is not.
        const double largest = std::ranges::max(medium.extinction);
        const Spectrum shares = scaled(medium.extinction, largest > 0.0 ? 1.0 / largest : 0.0);
        number("scale", largest);
        if (medium.shape)
            write_grid(index, *medium.shape, shares);
        else
            rgb_value("sigma_t", shares);
        const bool rayleigh = medium.phase.kind == radiosity::PhaseKind::rayleigh;
        auto phase = xml_.element("phase", {{"type", rayleigh                   ? "rayleigh"
                                                     : medium.phase.isotropic() ? "isotropic"
                                                                                : "hg"}});
        if (!rayleigh && !medium.phase.isotropic()) number("g", medium.phase.asymmetry);
    }

    // Our values stand at points, the outermost on the box; theirs in the middle of cells.
    void write_grid(std::size_t index, const radiosity::RegularGrid& grid, const Spectrum& shares) {
        const Direction half = 0.5 * grid.cell();
        const Point low = grid.low() - half, high = grid.high() + half;
        const bool coloured = differ(shares);
        std::string bytes = "VOL";
        append(bytes, std::uint8_t{3});
        append(bytes, std::int32_t{1});  // 32-bit floats
        for (const auto count : grid.counts()) append(bytes, static_cast<std::int32_t>(count));
        append(bytes, std::int32_t{coloured ? 3 : 1});
        for (const Point& corner : {Point(0.0), Point(1.0)})
            for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(corner[k]));
        for (const float value : grid.values())
            for (std::size_t b = 0; b < (coloured ? 3u : 1u); ++b)
                append(bytes, static_cast<float>(value * shares[b]));
        auto volume = xml_.element("volume", {{"name", "sigma_t"}, {"type", "gridvolume"}});
        text("filename", part(media_[index] + ".vol", std::move(bytes)));
        xml_.leaf("boolean", {{"name", "raw"}, {"value", "true"}});
        auto transform = xml_.element("transform", {{"name", "to_world"}});
        xml_.leaf("scale", {{"value", triple(high - low)}});
        xml_.leaf("translate", {{"value", triple(low)}});
    }

    void write_sensors(std::span<const render::Camera> cameras) {
        std::vector<std::string> names;
        for (const auto& camera : cameras) names.push_back(camera.name);
        names = plain_names(names);
        for (std::size_t k = 0; k < cameras.size(); ++k)
            write_sensor(cameras[k], "camera_" + names[k]);
    }

    void write_sensor(const render::Camera& camera, const std::string& id) {
        using enum radiosity::PictureProjection;
        const radiosity::View view = camera.view();
        if (view.projection == panorama)
            throw InputError(fmt::format(
                "camera \"{}\" is a panorama, which Mitsuba has no sensor for. Name another: "
                "--camera, or export to pbrt.",
                camera.name));
        const bool flat = view.projection == orthographic;
        auto sensor = xml_.element("sensor", {{"id", id},
                                              {"type", flat          ? "orthographic"
                                                       : camera.lens ? "thinlens"
                                                                     : "perspective"}});
        number("near_clip", 1e-4 * room_.size);
        number("far_clip", 1e4 * room_.size);
        if (!flat) {
            text("fov_axis", "x");
            number("fov", 2.0 * std::atan(view.half_x) * degrees);
        }
        if (camera.lens) {
            number("aperture_radius", 0.5 * camera.lens->diameter);
            number("focus_distance", camera.lens->focus);
        }
        {
            auto transform = xml_.element("transform", {{"name", "to_world"}});
            if (flat)
                xml_.leaf("scale", {{"x", fmt::format("{:.9g}", view.half_x)},
                                    {"y", fmt::format("{:.9g}", view.half_x)}});
            look_at(view.eye, view.eye + view.forward, view.up);
        }
        refer("medium", medium_at(e_, view.eye));
        write_film(camera);
        auto sampler = xml_.element("sampler", {{"type", "independent"}});
        whole("sample_count", static_cast<long>(options_.samples));
    }

    void write_film(const render::Camera& camera) {
        auto film = xml_.element("film", {{"type", "hdrfilm"}});
        const bool part = camera.whole_width > 0;
        whole("width", static_cast<long>(part ? camera.whole_width : camera.width));
        whole("height", static_cast<long>(part ? camera.whole_height : camera.height));
        if (part) {
            whole("crop_width", static_cast<long>(camera.width));
            whole("crop_height", static_cast<long>(camera.height));
            whole("crop_offset_x", static_cast<long>(camera.left));
            whole("crop_offset_y", static_cast<long>(camera.top));
        }
        text("pixel_format", room_.bands == 1 ? "luminance" : "rgb");
        text("component_format", "float32");
        xml_.leaf("rfilter", {{"type", "box"}});
    }

    void look_at(const Point& origin, const Point& target, const Direction& up) {
        xml_.leaf("lookat",
                  {{"origin", triple(origin)}, {"target", triple(target)}, {"up", triple(up)}});
    }

    void write_surfaces() {
        std::vector<std::string> names;
        for (const auto& wall : room_.walls) names.push_back(wall.name);
        for (const auto& boundary : room_.boundaries) names.push_back(boundary.name);
        names = plain_names(names);
        std::size_t k = 0;
        for (const auto& wall : room_.walls) write_sheet(wall, names[k++], true);
        for (const auto& boundary : room_.boundaries) write_sheet(boundary, names[k++], false);
    }

    void write_sheet(const Sheet& sheet, const std::string& name, bool opaque) {
        auto shape = xml_.element("shape", {{"type", "ply"}, {"id", "surface_" + name}});
        text("filename", part(name + ".ply", ply_file(sheet.triangles)));
        xml_.leaf("boolean", {{"name", "face_normals"}, {"value", "true"}});
        refer("exterior", sheet.medium_front);
        refer("interior", sheet.medium_back);
        if (!opaque) {
            xml_.leaf("bsdf", {{"type", "null"}});
            return;
        }
        write_finishes(sheet);
        if (sheet.front.emits()) {
            auto emitter = xml_.element("emitter", {{"type", "area"}});
            rgb_value("radiance", sheet.front.emission);
        }
    }

    // A material reflects on the side that its normal looks to; twosided takes one for each.
    void write_finishes(const Sheet& sheet) {
        if (!sheet.back) {
            write_finish(sheet.front, sheet.name);
            return;
        }
        auto both = xml_.element("bsdf", {{"type", "twosided"}});
        write_finish(sheet.front, sheet.name);
        if (!(sheet.front == *sheet.back)) write_finish(*sheet.back, sheet.name);
    }

    void write_finish(const Finish& own, const std::string& name) {
        const Finish finish = with_lost_light(own);
        if (!any(finish.specular)) {
            write_diffuse(finish.diffuse);
            return;
        }
        if (finish.roughness > 0.0)
            files_.note(
                "Glossy surfaces: what microfacets reflect more than once, which Mitsuba loses, "
                "is in their diffuse part: right in the mean, not in every direction.");
        if (!any(finish.diffuse)) {
            write_specular(finish.specular, finish.roughness);
            return;
        }
        const double share = specular_share(finish, name);
        auto blend = xml_.element("bsdf", {{"type", "blendbsdf"}});
        number("weight", share);
        write_diffuse(scaled(finish.diffuse, 1.0 / (1.0 - share)));
        write_specular(scaled(finish.specular, 1.0 / share), finish.roughness);
    }

    void write_diffuse(const Spectrum& reflectance) {
        auto bsdf = xml_.element("bsdf", {{"type", "diffuse"}});
        rgb_value("reflectance", reflectance);
    }

    void write_specular(const Spectrum& reflectance, double roughness) {
        auto bsdf =
            xml_.element("bsdf", {{"type", roughness > 0.0 ? "roughconductor" : "conductor"}});
        text("material", "none");  // reflects all light, whatever its direction
        rgb_value("specular_reflectance", reflectance);
        if (roughness > 0.0) {
            text("distribution", "ggx");
            number("alpha", roughness * roughness);
        }
    }

    void write_light(const radiosity::Sun& sun) {
        if (sun.angle > 0.0) {
            const SunDisc disc = sun_disc(sun, room_.centre, room_.size);
            auto shape = xml_.element("shape", {{"type", "disk"}});
            {
                auto transform = xml_.element("transform", {{"name", "to_world"}});
                xml_.leaf("scale", {{"value", fmt::format("{:.9g}", disc.radius)}});
                look_at(disc.centre, room_.centre, disc.up);
            }
            xml_.element("bsdf", {{"type", "diffuse"}},
                         [&] { rgb_value("reflectance", Spectrum(room_.bands, 0.0)); });
            auto emitter = xml_.element("emitter", {{"type", "area"}});
            rgb_value("radiance", disc.radiance);
            return;
        }
        auto emitter = xml_.element("emitter", {{"type", "directional"}});
        xml_.leaf("vector", {{"name", "direction"}, {"value", triple(sun.direction)}});
        rgb_value("irradiance", sun.irradiance);
    }

    void write_light(const radiosity::PointLight& light) {
        auto emitter = xml_.element("emitter", {{"type", "point"}});
        xml_.leaf("point", {{"name", "position"}, {"value", triple(light.position)}});
        rgb_value("intensity", light.intensity);
        refer("medium", medium_at(e_, light.position));
    }

    void write_light(const radiosity::SpotLight& light) {
        if (light.soft_edge > 0.0)
            files_.note("Soft edges of spots fall linearly in Mitsuba, and smoothly in Tyndall.");
        auto emitter = xml_.element("emitter", {{"type", "spot"}});
        {
            auto transform = xml_.element("transform", {{"name", "to_world"}});
            look_at(light.position, light.position + light.direction, across(light.direction));
        }
        rgb_value("intensity", light.intensity);
        number("beam_width", 0.5 * light.angle * degrees);
        number("cutoff_angle", (0.5 * light.angle + light.soft_edge) * degrees);
        refer("medium", medium_at(e_, light.position));
    }

    const radiosity::Enclosure& e_;
    const PathTracerOptions& options_;
    PathRoom room_;
    std::vector<std::string> media_;  // ids
    XmlWriter xml_;
    ExportedFiles files_;
};

}  // namespace

ExportedFiles mitsuba_scene(const radiosity::Enclosure& enclosure,
                            std::span<const render::Camera> cameras,
                            const PathTracerOptions& options) {
    require_camera(cameras);
    return MitsubaWriter(enclosure, options).write(cameras);
}

}  // namespace tyndall::exports
