#include "exports/pbrt_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "exports/path_room.h"
#include "exports/sun_disc.h"
#include "mesh/input_error.h"

namespace tyndall::exports {
namespace {

using mesh::Direction;
using mesh::InputError;
using mesh::Point;
using radiosity::none;

std::string numbers(const std::array<double, 3>& v) {
    return fmt::format("[{:.9g} {:.9g} {:.9g}]", v[0], v[1], v[2]);
}

std::string numbers(const Spectrum& values) {
    return numbers(rgb(values));
}

std::string numbers(const Point& v) {
    return numbers(std::array{v.x, v.y, v.z});
}

class PbrtWriter {
  public:
    PbrtWriter(const radiosity::Enclosure& enclosure, const PathTracerOptions& options)
        : e_(enclosure),
          options_(options),
          room_(path_room(enclosure, {.band = options.band, .one_material = true})) {
        std::vector<std::string> names;
        for (const auto& medium : room_.media) names.push_back(medium.name);
        media_ = plain_names(names);
    }

    ExportedFiles write(std::span<const render::Camera> cameras) {
        std::string title = options_.title.empty() ? "A Tyndall scene" : options_.title;
        std::ranges::replace(title, '\n', ' ');
        print("# {}\n# Lengths in m, radiance in W/(m^2 sr).\n\n", title);
        write_camera(cameras[0]);
        if (cameras.size() > 1)
            files_.note(
                fmt::format("pbrt has one camera a file: this is \"{}\". --camera names another.",
                            cameras[0].name));
        for (std::size_t m = 0; m < room_.media.size(); ++m) write_medium(m);
        print("\nWorldBegin\n");
        for (const auto& light : room_.lights)
            std::visit([&](const auto& source) { write_light(source); }, light.source);
        if (any(room_.environment))
            print("\nLightSource \"infinite\" \"rgb L\" {}\n", numbers(room_.environment));
        write_surfaces();
        if (room_.bands == 3)
            files_.note(
                "pbrt computes with spectra: red, green and blue multiply otherwise there where "
                "light is reflected in colours. Export one band at a time (--band) to check "
                "numbers.");
        files_.main = std::move(text_);
        return std::move(files_);
    }

  private:
    template <class... Values>
    void print(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    std::string medium_name(std::uint32_t medium) const {
        return medium == none ? "" : media_[medium];
    }

    // Behind and before what follows.
    void between(std::uint32_t inside, std::uint32_t outside) {
        print("MediumInterface \"{}\" \"{}\"\n", medium_name(inside), medium_name(outside));
    }

    void write_film(const render::Camera& camera) {
        const bool part = camera.whole_width > 0;
        print(
            "Film \"rgb\" \"string filename\" \"{}.exr\"\n"
            "    \"integer xresolution\" {} \"integer yresolution\" {}\n",
            options_.stem, part ? camera.whole_width : camera.width,
            part ? camera.whole_height : camera.height);
        if (part)
            print("    \"integer pixelbounds\" [{} {} {} {}]\n", camera.left,
                  camera.left + camera.width, camera.top, camera.top + camera.height);
        print("PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n");
        print("Sampler \"independent\" \"integer pixelsamples\" {}\n", options_.samples);
        print("Integrator \"volpath\" \"integer maxdepth\" 100000\n\n");
    }

    void write_camera(const render::Camera& camera) {
        using enum radiosity::PictureProjection;
        const radiosity::View view = camera.view();
        if (view.projection == panorama)
            throw InputError(fmt::format(
                "camera \"{}\" is a panorama, whose directions pbrt counts in another way. Name "
                "another camera: --camera.",
                camera.name));
        write_film(camera);
        // pbrt's camera looks along left-handed axes.
        print("Scale -1 1 1\nLookAt {:.9g} {:.9g} {:.9g}  ", view.eye.x, view.eye.y, view.eye.z);
        const Point target = view.eye + view.forward;
        print("{:.9g} {:.9g} {:.9g}  {:.9g} {:.9g} {:.9g}\n", target.x, target.y, target.z,
              view.up.x, view.up.y, view.up.z);
        between(none, medium_at(e_, view.eye));
        if (view.projection == orthographic) {
            print("Camera \"orthographic\" \"float screenwindow\" [{:.9g} {:.9g} {:.9g} {:.9g}]\n",
                  -view.half_x, view.half_x, -view.half_y, view.half_y);
        } else {
            // The angle across the shorter side.
            print("Camera \"perspective\" \"float fov\" {:.9g}",
                  2.0 * std::atan(std::min(view.half_x, view.half_y)) * degrees);
            if (camera.lens)
                print(" \"float lensradius\" {:.9g} \"float focaldistance\" {:.9g}",
                      0.5 * camera.lens->diameter, camera.lens->focus);
            print("\n");
        }
        print("Identity\n");  // media stand in the world, not before the camera
    }

    void write_medium(std::size_t index) {
        const RoomMedium& medium = room_.media[index];
        if (medium.phase.kind == radiosity::PhaseKind::rayleigh)
            throw InputError(fmt::format(
                "medium \"{}\" scatters by Rayleigh's phase function, which pbrt has not. Export "
                "to Mitsuba: --format mitsuba.",
                medium.name));
        Spectrum absorption, scattering;
        for (std::size_t b = 0; b < room_.bands; ++b) {
            scattering.push_back(medium.extinction[b] * medium.albedo[b]);
            absorption.push_back(medium.extinction[b] - scattering[b]);
            if (medium.emission[b] > 0.0 && absorption[b] <= 0.0)
                throw InputError(fmt::format(
                    "medium \"{}\" emits and does not absorb, which path tracers have no word for. "
                    "Give it an albedo below 1.",
                    medium.name));
        }
        print("\nMakeNamedMedium \"{}\" \"string type\" \"{}\" \"float g\" {:.9g}\n", media_[index],
              medium.shape ? "uniformgrid" : "homogeneous",
              medium.phase.isotropic() ? 0.0 : medium.phase.asymmetry);
        print("    \"rgb sigma_a\" {} \"rgb sigma_s\" {}\n", numbers(absorption),
              numbers(scattering));
        if (any(medium.emission)) print("    \"rgb Le\" {}\n", numbers(medium.emission));
        if (medium.shape) write_grid(*medium.shape);
    }

    // Our values stand at points, the outermost on the box; pbrt's in the middle of cells.
    void write_grid(const radiosity::RegularGrid& grid) {
        const Direction half = 0.5 * grid.cell();
        print("    \"point3 p0\" {} \"point3 p1\" {}\n", numbers(grid.low() - half),
              numbers(grid.high() + half));
        const auto& n = grid.counts();
        print("    \"integer nx\" {} \"integer ny\" {} \"integer nz\" {}\n    \"float density\" [",
              n[0], n[1], n[2]);
        for (std::size_t k = 0; k < grid.values().size(); ++k)
            print("{}{:.7g}", k % 12 == 0 ? "\n        " : " ", grid.values()[k]);
        print("\n    ]\n");
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
        const std::string path = fmt::format("{}_parts/{}.ply", options_.stem, name);
        files_.beside.push_back({path, ply_file(sheet.triangles)});
        if (opaque) define_material(sheet.front, name, sheet.name);
        print("\nAttributeBegin\n");
        between(sheet.medium_back, sheet.medium_front);
        if (opaque)
            print("NamedMaterial \"{}\"\n", name);
        else
            print("Material \"interface\"\n");
        if (opaque && sheet.front.emits())
            print("AreaLightSource \"diffuse\" \"rgb L\" {} \"bool twosided\" false\n",
                  numbers(sheet.front.emission));
        print("Shape \"plymesh\" \"string filename\" \"{}\"\nAttributeEnd\n", path);
    }

    void define_material(const Finish& own, const std::string& name, const std::string& surface) {
        const Finish finish = with_lost_light(own);
        const bool specular = any(finish.specular);
        if (!specular || !any(finish.diffuse)) {
            specular ? define_specular(name, finish.specular, finish.roughness)
                     : define_diffuse(name, finish.diffuse);
            return;
        }
        const double share = specular_share(finish, surface);
        define_diffuse(name + "_diffuse", scaled(finish.diffuse, 1.0 / (1.0 - share)));
        define_specular(name + "_specular", scaled(finish.specular, 1.0 / share), finish.roughness);
        print(
            "MakeNamedMaterial \"{0}\" \"string type\" \"mix\" \"string materials\" "
            "[\"{0}_diffuse\" \"{0}_specular\"] \"float amount\" {1:.9g}\n",
            name, share);
    }

    void define_diffuse(const std::string& name, const Spectrum& reflectance) {
        print("\nMakeNamedMaterial \"{}\" \"string type\" \"diffuse\" \"rgb reflectance\" {}\n",
              name, numbers(reflectance));
    }

    void define_specular(const std::string& name, const Spectrum& reflectance, double roughness) {
        files_.note(
            "Mirrors and gloss: pbrt takes the reflectance for that at normal incidence, and "
            "reflects more at grazing angles; Tyndall's mirrors reflect alike at all.");
        print(
            "\nMakeNamedMaterial \"{}\" \"string type\" \"conductor\" \"rgb reflectance\" {} "
            "\"float roughness\" {:.9g} \"bool remaproughness\" false\n",
            name, numbers(reflectance), roughness * roughness);
    }

    void write_light(const radiosity::Sun& sun) {
        const Direction towards = glm::normalize(sun.direction);
        print("\nAttributeBegin\n");
        between(none, none);
        if (sun.angle > 0.0) {
            const SunDisc disc = sun_disc(sun, room_.centre, room_.size);
            const Direction v = glm::cross(towards, disc.up);
            // Columns: the disc's axes, its normal, its centre.
            print("ConcatTransform [");
            for (const Direction& axis : {disc.up, v, towards})
                print("{:.9g} {:.9g} {:.9g} 0  ", axis.x, axis.y, axis.z);
            print("{:.9g} {:.9g} {:.9g} 1]\n", disc.centre.x, disc.centre.y, disc.centre.z);
            print(
                "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                "AreaLightSource \"diffuse\" \"rgb L\" {} \"bool twosided\" false\n"
                "Shape \"disk\" \"float radius\" {:.9g}\n",
                numbers(disc.radiance), disc.radius);
        } else {
            print("LightSource \"distant\" \"rgb L\" {} \"point3 from\" {} \"point3 to\" {}\n",
                  numbers(sun.irradiance), numbers(room_.centre - towards), numbers(room_.centre));
        }
        print("AttributeEnd\n");
    }

    void write_light(const radiosity::PointLight& light) {
        print("\nAttributeBegin\n");
        between(none, medium_at(e_, light.position));
        print("LightSource \"point\" \"rgb I\" {} \"point3 from\" {}\nAttributeEnd\n",
              numbers(light.intensity), numbers(light.position));
    }

    void write_light(const radiosity::SpotLight& light) {
        if (light.soft_edge > 0.0)
            files_.note(
                "Soft edges of spots fall by the cosine in pbrt, and by the angle in Tyndall.");
        print("\nAttributeBegin\n");
        between(none, medium_at(e_, light.position));
        print(
            "LightSource \"spot\" \"rgb I\" {} \"point3 from\" {} \"point3 to\" {} \"float "
            "coneangle\" {:.9g} \"float conedeltaangle\" {:.9g}\nAttributeEnd\n",
            numbers(light.intensity), numbers(light.position),
            numbers(light.position + light.direction),
            (0.5 * light.angle + light.soft_edge) * degrees, light.soft_edge * degrees);
    }

    const radiosity::Enclosure& e_;
    const PathTracerOptions& options_;
    PathRoom room_;
    std::vector<std::string> media_;
    std::string text_;
    ExportedFiles files_;
};

}  // namespace

ExportedFiles pbrt_scene(const radiosity::Enclosure& enclosure,
                         std::span<const render::Camera> cameras,
                         const PathTracerOptions& options) {
    require_camera(cameras);
    return PbrtWriter(enclosure, options).write(cameras);
}

}  // namespace tyndall::exports
