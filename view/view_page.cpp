#include "view/view_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "radiosity/linear_pieces.h"
#include "radiosity/report_json.h"
#include "render/line_of_sight.h"
#include "render/renderers.h"
#include "render/tone_map.h"
#include "view/markup.h"
#include "view/mesh_statistics.h"
#include "view/packed_arrays.h"
#include "view/page_sources.h"
#include "view/report_notes.h"
#include "view/report_sections.h"
#include "view/viewer_arrays.h"

namespace tyndall::view {
namespace {

using Json = nlohmann::ordered_json;
using mesh::Direction;
using mesh::Point;
using radiosity::PictureProjection;
using render::Camera;

constexpr std::size_t exposure_width = 96;  // pixels of a picture that the exposure is taken from

Json vector_json(Direction v) {
    return {v.x, v.y, v.z};
}

// The radiance shown as white, as a picture of that camera would have it.
double white_of(const radiosity::Solution& solution, const Camera& camera,
                const PageOptions& options) {
    const auto& tone = options.tone_map;
    if (tone.white) return *tone.white / std::exp2(tone.exposure);
    Camera small = camera;
    small.width = std::min(exposure_width, camera.width);
    small.height = std::max<std::size_t>(1, camera.height * small.width / camera.width);
    if (camera.projection == PictureProjection::panorama) small.height = small.width / 2;
    if (camera.projection == PictureProjection::panorama) small.width = 2 * small.height;
    const auto image =
        render::line_of_sight(solution, small, {.samples = 4, .threads = options.threads});
    return render::automatic_white(image, render::select_layer(image, "")) /
           std::exp2(tone.exposure);
}

// Stands in the tetrahedron with most room that is not in a solid, and looks to the farthest one.
Camera roomy_camera(const radiosity::Solution& solution) {
    const auto& enclosure = *solution.enclosure;
    const auto& mesh = enclosure.mesh;
    const auto centroid = [&](std::size_t tet) {
        return solution.forest.centroid(mesh::root_zone(mesh::TetId(tet)));
    };
    Camera camera;
    camera.name = "somewhere";
    camera.fov_x = 1.3;
    double most = 0.0, farthest = 0.0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
        if (const mesh::TetId tet(t); !enclosure.solid(tet) && mesh::volume(mesh, tet) > most) {
            most = mesh::volume(mesh, tet);
            camera.eye = centroid(t);
        }
    camera.target = camera.eye + Direction(1.0, 0.0, 0.0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (enclosure.solid(mesh::TetId(t))) continue;
        // Level, so that it is never along `up`.
        Point there = centroid(t);
        there.z = camera.eye.z;
        if (glm::distance(there, camera.eye) <= farthest) continue;
        farthest = glm::distance(there, camera.eye);
        camera.target = there;
    }
    return camera;
}

// Of another projection than the plane perspective one the eye and the direction are kept.
Json camera_json(const radiosity::Solution& solution, const Camera& camera, Point origin,
                 const PageOptions& options) {
    const auto view = camera.view();
    const bool plain = camera.projection == PictureProjection::perspective;
    const Direction up = camera.up;
    const double aspect = plain ? view.half_x / view.half_y : 4.0 / 3.0;
    const double half_x = plain ? view.half_x : 0.75;
    const Direction forward = plain ? view.forward : glm::normalize(camera.target - camera.eye);
    return {{"name", camera.name},
            {"eye", vector_json(view.eye - origin)},
            {"forward", vector_json(forward)},
            {"up", vector_json(up)},
            {"half_x", half_x},
            {"half_y", half_x / aspect},
            {"white", white_of(solution, camera, options)},
            {"perspective", plain}};
}

Json cameras_json(const radiosity::Solution& solution, Point origin, const PageOptions& options) {
    Json cameras = Json::array();
    auto list = options.cameras;
    if (list.empty()) list.push_back(roomy_camera(solution));
    for (const auto& camera : list)
        cameras.push_back(camera_json(solution, camera, origin, options));
    return cameras;
}

Json names_json(const radiosity::Enclosure& enclosure) {
    Json sides = Json::array(), media = Json::array();
    for (const auto& side : enclosure.sides)
        sides.push_back({{"name", side.name}, {"reflectance", side.reflectance}});
    for (const auto& medium : enclosure.media)
        media.push_back({{"name", medium.name}, {"albedo", medium.albedo}});
    return {{"sides", sides}, {"media", media}};
}

// What leads from leaves to the elements of earlier passes, and those.
void pack_passes(const std::vector<std::int32_t>& above, const std::vector<std::int32_t>& born,
                 const CoarserElements& coarser, const std::string& kind, PackedArrays& packed) {
    packed.add(kind + "_above", above);
    packed.add(kind + "_born", born);
    packed.add("coarser_" + kind + "_above", coarser.above);
    packed.add("coarser_" + kind + "_born", coarser.born);
    packed.add("coarser_" + kind + "_row", coarser.row);
    packed.add("coarser_" + kind + "_level", coarser.level);
    packed.add("coarser_" + kind + "_error", coarser.error);
    packed.add("coarser_" + kind + "_size", coarser.size);
    packed.add("coarser_" + kind + "_direct", coarser.direct);
    packed.add("coarser_" + kind + "_indirect", coarser.indirect);
}

PackedArrays pack(const ViewerArrays& a) {
    PackedArrays packed;
    packed.add("planes", a.planes);
    packed.add("zone_planes", a.zone_planes);
    packed.add("zone_ropes", a.zone_ropes);
    packed.add("zone_row", a.zone_row);
    packed.add("zone_medium", a.zone_medium);
    packed.add("zone_level", a.zone_level);
    packed.add("zone_error", a.zone_error);
    packed.add("zone_volume", a.zone_volume);
    packed.add("zone_direct", a.zone_direct);
    packed.add("zone_indirect", a.zone_indirect);
    packed.add("zone_extinction", a.zone_extinction);
    packed.add("nodes", a.nodes);
    packed.add("walls", a.walls);
    packed.add("patch_row", a.patch_row);
    packed.add("patch_side", a.patch_side);
    packed.add("patch_level", a.patch_level);
    packed.add("patch_error", a.patch_error);
    packed.add("patch_area", a.patch_area);
    packed.add("patch_indirect", a.patch_indirect);
    packed.add("piece_patch", a.piece_patch);
    packed.add("piece_direct", a.piece_direct);
    pack_passes(a.zone_above, a.zone_born, a.coarser_zones, "zone", packed);
    pack_passes(a.patch_above, a.patch_born, a.coarser_patches, "patch", packed);
    packed.add("rows", a.rows);
    packed.add("hull_corners", a.hull_corners);
    packed.add("hull_zones", a.hull_zones);
    return packed;
}

std::size_t first_camera(const PageOptions& options) {
    for (std::size_t k = 0; k < options.cameras.size(); ++k)
        if (options.cameras[k].name == options.view_camera) return k;
    return 0;
}

Json meta_json(const radiosity::Solution& solution, const ViewerArrays& arrays,
               const SharpenedPatches& patches, const PackedArrays& packed,
               const PageOptions& options) {
    const auto& e = *solution.enclosure;
    Json meta{{"title", options.title},
              {"version", TYNDALL_VERSION},
              {"bands", arrays.bands},
              {"origin", vector_json(arrays.origin)},
              {"hull_min", vector_json(e.mesh.hull_min - arrays.origin)},
              {"hull_max", vector_json(e.mesh.hull_max - arrays.origin)},
              {"diagonal", glm::length(e.mesh.hull_max - e.mesh.hull_min)},
              {"environment", e.environment},
              {"curve", static_cast<int>(options.tone_map.curve)},
              {"camera", first_camera(options)},
              {"cameras", cameras_json(solution, arrays.origin, options)},
              {"names", names_json(e)},
              {"pieces_made", patches.made},
              {"pieces_left", patches.left},
              {"meshes", Json::array()},
              {"arrays", Json::array()}};
    for (const auto& mesh : arrays.meshes)
        meta["meshes"].push_back(
            {{"passes", mesh.passes}, {"patches", mesh.patches}, {"zones", mesh.zones}});
    for (const auto& entry : packed.entries())
        meta["arrays"].push_back({entry.name, std::string(1, entry.type), entry.count});
    meta["report"] =
        Json::parse(options.report.empty()
                        ? radiosity::report_to_json(solution.report, radiosity::Costs::left_out)
                        : options.report);
    return meta;
}

// JSON within a script element: nothing in it may look like a tag.
std::string in_script(const std::string& json) {
    std::string result;
    for (const char c : json) result += c == '<' ? "\\u003c" : std::string(1, c);
    return result;
}

// The report at the foot of the page, as in report.html.
std::string report_markup(const radiosity::Solution& solution, const SharpenedPatches& patches,
                          const PageOptions& options) {
    constexpr SectionLevel level{3};
    const ReportFacts facts = report_facts(solution, options.report);
    const auto notes = report_notes(solution, facts, mesh_statistics(solution), options.goal);
    const auto finer = patches.left > 0 ? fmt::format("; {} would be finer", patches.left) : "";
    return warnings_list(facts, notes) + solution_table(facts, options.goal) +
           fmt::format(
               "<p>For direct light patches are cut into {} more pieces in this page{}. "
               "Made by Tyndall {}.</p>\n",
               patches.made, finer, TYNDALL_VERSION) +
           section(level, "passes", "Passes", passes_figures(facts, options.goal)) +
           section(level, "solver", "Solver", solver_figures(facts)) +
           section(
               level, "power", "Where the light goes",
               power_figures(facts, named_sizes(*solution.enclosure)) + temperature_table(facts));
}

}  // namespace

std::string view_page(const radiosity::Solution& whole, const PageOptions& options) {
    render::refuse_bodies(*whole.enclosure,
                          "which view.html cannot show. Make a picture with tyndall render");
    std::optional<radiosity::Solution> pieces;  // the page draws linear functions
    if (radiosity::is_quadratic(whole))
        pieces = radiosity::linear_pieces(whole, options.sharpen.tolerance);
    const radiosity::Solution& solution = pieces ? *pieces : whole;
    const SharpenedPatches patches = sharpen_patches(solution, options.sharpen);
    const ViewerArrays arrays = viewer_arrays(solution, patches);
    const PackedArrays packed = pack(arrays);
    const auto meta = meta_json(solution, arrays, patches, packed, options);
    return filled(page_source("page.html"), [&](std::string_view name) -> std::string {
        if (name == "title") return escaped(options.title);
        if (name == "report") return report_markup(solution, patches, options);
        if (name == "report_link" && !options.report_link.empty())
            return fmt::format("<p><a href=\"{}\">All figures, to print</a></p>",
                               escaped(options.report_link));
        if (name == "meta")
            return in_script(meta.dump(-1, ' ', false, Json::error_handler_t::replace));
        if (name == "arrays") return packed.text();
        return std::string(page_source(name));
    });
}

}  // namespace tyndall::view
