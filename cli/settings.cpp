#include "cli/settings.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "radiosity/exchange_methods.h"
#include "radiosity/indicators.h"
#include "radiosity/smoothing.h"
#include "radiosity/solvers.h"
#include "render/renderers.h"
#include "render/tone_map.h"

namespace tyndall::cli {
namespace {

constexpr std::array<std::string_view, 3> point_set_names{"sobol", "independent", "stratified"};
constexpr std::array<std::string_view, 2> projection_names{"z_buffer", "walked"};
constexpr std::array<std::string_view, 2> mirror_names{"walked", "scattered"};
constexpr std::array<std::string_view, 2> shot_names{"rows", "on_the_fly"};
constexpr std::array<std::string_view, 5> refinement_names{"none", "uniform", "adaptive", "view",
                                                           "aligned"};
constexpr std::array<std::string_view, 4> start_names{"single-zone", "base", "uniform", "mesh"};
constexpr std::array<std::string_view, 3> radiance_names{"constant", "linear", "quadratic"};
constexpr std::array<std::string_view, 2> direct_light_names{"closed_form", "rows"};

std::vector<std::string_view> exchange_names() {
    std::vector<std::string_view> names;
    for (const auto& method : radiosity::exchange_methods()) names.push_back(method.name);
    return names;
}

std::vector<std::string_view> indicator_names() {
    std::vector<std::string_view> names;
    for (const auto& indicator : radiosity::indicators()) names.push_back(indicator.name);
    return names;
}

std::size_t memory(const TableReader& table, std::string_view key) {
    constexpr Range range{1e6, 1e15};
    const toml::node& node = table.node(key);
    if (!node.is_string()) return static_cast<std::size_t>(table.number(key, range));
    const std::string text = table.text(key);
    const auto bytes = bytes_of(text);
    if (!bytes || !range.holds(*bytes)) {
        table.fail(
            key, fmt::format("{} \"{}\" of {} is not a size from 1 MB to 1000 TB. Give bytes as a "
                             "number, or a string such as \"2 GB\" or \"512 MiB\".",
                             key, text, table.thing()));
    }
    return static_cast<std::size_t>(*bytes);
}

// A key and what to do with it: a new setting is one line.
struct SceneSetting {
    Key key;
    void (*read)(const TableReader&, std::string_view, Settings&);
};

using T = const TableReader&;
using K = std::string_view;

// clang-format off
constexpr SceneSetting solve_settings[] = {
    {{"error", "number above 0 and below 1", "0.01", "goal: estimated relative error of the picture, or of the solution where there is no camera"},
     [](T t, K k, Settings& s) { s.solve.error = t.number(k, {0.0, 1.0, true, true}); }},
    {{"camera", "name of a camera", "the first camera", "the camera whose picture matters; \"\" for a solution good everywhere"},
     [](T t, K k, Settings& s) { s.camera = t.text(k); }},
    {{"start", "\"single-zone\", \"base\", \"uniform\" or \"mesh\"", "\"uniform\"", "the mesh to begin with: one zone a medium and the input polygons; the base tets and facets; these bisected down to element_size (0: to about 4000 zones and 1500 patches); your own tetrahedra, those of the file mesh"},
     [](T t, K k, Settings& s) { s.solve.start = static_cast<radiosity::Start>(t.choice(k, start_names)); }},
    {{"mesh", "path of a file", "", "Gmsh's .msh, or TetGen's .ele beside its .node, relative to the scene file: the base mesh where start is \"mesh\""},
     [](T t, K k, Settings& s) { s.mesh = t.text(k); }},
    {{"refinement", "\"none\", \"uniform\", \"adaptive\", \"view\" or \"aligned\"", "\"aligned\"", "the initial mesh; all down to element_size; where it is needed; where the picture needs it; along shadow boundaries too"},
     [](T t, K k, Settings& s) { s.solve.refinement = static_cast<radiosity::Refinement>(t.choice(k, refinement_names)); }},
    {{"indicators", "array of \"direct\", \"shadow_boundary\", \"indirect\", \"jump\", \"optical_thickness\"", "[\"direct\", \"shadow_boundary\", \"indirect\"]", "the errors that elements are bisected for: direct light that departs from linear; a shadow's edge across (with refinement \"aligned\"); indirect light that departs from linear; a jump to the neighbours; zones too thick for the coarse solution"},
     [](T t, K k, Settings& s) { s.solve.indicators = t.choices(k, indicator_names()); }},
    {{"optical_thickness", "number above 0", "0.5", "extinction × size from which a zone counts as thick"},
     [](T t, K k, Settings& s) { s.solve.optical_thickness = t.number(k, positive); }},
    {{"promotions", "whole number", "0", "times the refined mesh, at a looser goal, is solved anew before the last refinement"},
     [](T t, K k, Settings& s) { s.solve.promotions = t.count(k, 0, 10); }},
    {{"radiance", "\"constant\", \"linear\" or \"quadratic\"", "\"linear\"", "what an element holds: its mean, a linear function with that mean, or a quadratic one (of direct light in zones, and of indirect light on patches)"},
     [](T t, K k, Settings& s) { s.solve.radiance = static_cast<radiosity::Radiance>(t.choice(k, radiance_names)); }},
    {{"direct_light", "\"closed_form\" or \"rows\"", "\"closed_form\"", "light straight from emitting surfaces: integrated over their visible part, or through the exchange areas"},
     [](T t, K k, Settings& s) { s.solve.direct_light = static_cast<radiosity::DirectLightMode>(t.choice(k, direct_light_names)); }},
    {{"element_size", "number [m]", "0", "longest edge of the initial elements; 0: chosen from the scene"},
     [](T t, K k, Settings& s) { s.solve.element_size = t.number(k, {0.0, 1e9}); }},
    {{"max_elements", "whole number", "150000", "patches and zones together"},
     [](T t, K k, Settings& s) { s.solve.max_elements = t.count(k, 1, 4'000'000'000); }},
    {{"max_memory", "number [byte], or \"2 GB\"", "\"2 GiB\"", "stops refining before"},
     [](T t, K k, Settings& s) { s.solve.max_memory = memory(t, k); }},
    {{"max_time", "number [s]", "0", "wall time; 0: no limit"},
     [](T t, K k, Settings& s) { s.solve.max_time = t.number(k, {0.0, 1e9}); }},
    {{"max_passes", "whole number", "100",
      "rounds of refinement at most, for direct and for indirect light; an element is halved once in each"},
     [](T t, K k, Settings& s) { s.solve.max_passes = t.count(k, 0, 1000); }},
    {{"rays", "whole number", "256", "walked from each element for its row of exchange areas"},
     [](T t, K k, Settings& s) { s.solve.rays = t.count(k, 1, 1'000'000); }},
    {{"row_detail", "number", "0", "theta of the rows' level of detail: rays deposit in coarser elements the farther they are; 0: never"},
     [](T t, K k, Settings& s) { s.solve.row_detail = t.number(k, {0.0, 100.0}); }},
    {{"gather_rays", "whole number", "256", "walked from each point of a surface in the last, fine gather; a quarter as many from points of zones"},
     [](T t, K k, Settings& s) { s.solve.gather_rays = t.count(k, 1, 1'000'000); }},
    {{"exchange", "name of a method", "\"walked\"", "how exchange areas are computed"},
     [](T t, K k, Settings& s) { const auto names = exchange_names(); s.solve.exchange = names[t.choice(k, names)]; }},
    {{"mirrors", "\"walked\" or \"scattered\"", "\"walked\"", "light that perfect mirrors reflect: rays go on at them; or they scatter it evenly, which is all that methods other than \"walked\" can do"},
     [](T t, K k, Settings& s) { s.mirrors = static_cast<radiosity::Mirrors>(t.choice(k, mirror_names)); }},
    {{"point_set", "\"sobol\", \"independent\" or \"stratified\"", "\"sobol\"", "how rays' starts and directions are spread in walked rows"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.point_set = static_cast<radiosity::PointSetKind>(t.choice(k, point_set_names)); }},
    {{"exchange_tolerance", "number above 0 and below 1", "1e-6", "relative error of exchange areas, of the methods that can keep one"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.tolerance = t.number(k, {0.0, 1.0, true, true}); }},
    {{"resolution", "whole number", "64", "pixels along the edge of a hemi-cube, a full cube or a single plane"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.resolution = t.count(k, 2, 4096); }},
    {{"centres", "whole number", "1", "points of an element on which such a cube stands"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.centres = t.count(k, 1, 4096); }},
    {{"random_offsets", "true or false", "false", "whether cubes stand at random points and turned, each in its own way"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.random_offsets = t.flag(k); }},
    {{"projection", "\"z_buffer\" or \"walked\"", "\"z_buffer\"", "how a cube's pixel finds what it sees: everything is drawn into buffers, or a ray is walked through the pixel"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.projection = static_cast<radiosity::Projection>(t.choice(k, projection_names)); }},
    {{"uniform_transmittance", "true or false", "false", "contour_integration through a medium: times one transmittance a pair, instead of a refusal"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.uniform_transmittance = t.flag(k); }},
    {{"interaction_radius", "number [m]", "0", "pairs farther apart are left out and what they exchange is put back nearer by; 0: all pairs count"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.interaction_radius = t.number(k, {0.0, 1e9}); }},
    {{"smoothing", "\"none\", \"least_squares\" or \"scaling\"", "\"none\"", "how rows are changed so that reciprocity and closure both hold"},
     [](T t, K k, Settings& s) { s.solve.exchange_settings.smoothing = static_cast<radiosity::Smoothing>(t.choice(k, radiosity::smoothing_names())); }},
    {{"solver", "name of a method", "\"gmres\"", "how the linear system is solved: \"gmres\" (or \"krylov\"), \"bicgstab\", \"gauss_seidel\" (or \"gathering\"), \"jacobi\", \"progressive_refinement\", \"direct\""},
     [](T t, K k, Settings& s) { const auto names = radiosity::solver_names(); s.solve.solver = names[t.choice(k, names)]; }},
    {{"solver_tolerance", "number above 0 and below 1", "1e-6", "relative residual"},
     [](T t, K k, Settings& s) { s.solve.solver_tolerance = t.number(k, {0.0, 1.0, true, true}); }},
    {{"solver_iterations", "whole number", "200", "at most: passes over the exchange areas; one shot of every element, in the mean"},
     [](T t, K k, Settings& s) { s.solve.solver_iterations = t.count(k, 1, 1'000'000); }},
    {{"over_relaxation", "number above 0 and below 2", "1", "gauss_seidel and jacobi: each change times this"},
     [](T t, K k, Settings& s) { s.solve.over_relaxation = t.number(k, {0.0, 2.0, true, true}); }},
    {{"shots", "\"rows\" or \"on_the_fly\"", "\"rows\"", "progressive_refinement: where a shot's exchange areas come from: all rows, made first and kept; or the shooter's row, made when it shoots and forgotten"},
     [](T t, K k, Settings& s) { s.solve.shots = static_cast<radiosity::Shots>(t.choice(k, shot_names)); }},
    {{"overshooting", "true or false", "false", "progressive_refinement: shoots what is foreseen to arrive as well"},
     [](T t, K k, Settings& s) { s.solve.overshooting = t.flag(k); }},
    {{"ambient", "true or false", "false", "progressive_refinement: adds the ambient estimate of what is unshot, where it ends before its tolerance"},
     [](T t, K k, Settings& s) { s.solve.ambient = t.flag(k); }},
    {{"seed", "whole number", "1", "of all random numbers"},
     [](T t, K k, Settings& s) { s.solve.seed = t.count(k, 0, 1ull << 53); }},
};

constexpr SceneSetting render_settings[] = {
    {{"method", "name of a method", "\"line_of_sight\"", "how the picture is made from the solution"},
     [](T t, K k, Settings& s) { const auto names = render::renderer_names(); s.render.method = names[t.choice(k, names)]; }},
    {{"samples", "whole number", "16", "rays a pixel"},
     [](T t, K k, Settings& s) { s.render.samples = t.count(k, 1, 65536); }},
    {{"contrast", "number from 0", "0.01", "line_of_sight: pixels across which radiance departs from linear by no more than this share of it take one ray instead of samples; 0: none does"},
     [](T t, K k, Settings& s) { s.render.contrast = t.number(k, {0.0, 1e9}); }},
    {{"scattering_tolerance", "number from 0", "0.002", "line_of_sight: single scattering is looked at along the ray where zones would be off by more than this share of the elements' mean radiance; 1e9, which is what uniform meshes and studies begin with: media are shown as the mesh holds them"},
     [](T t, K k, Settings& s) { s.render.scattering_tolerance = t.number(k, {0.0, 1e9}); }},
    {{"final_gather", "whole number", "0", "line_of_sight: rays a pixel that gather indirect light right where a surface is seen; 0: surfaces are shown as the mesh holds them"},
     [](T t, K k, Settings& s) { s.render.final_gather = t.count(k, 0, 1'000'000); }},
    {{"error", "number from 0", "0", "last_scatter, two_pass, path_traced: go on until the picture's estimated error in blocks of 4 x 4 pixels, over its mean, is below this, whatever samples says; 0: no goal"},
     [](T t, K k, Settings& s) { s.render.error = t.number(k, {0.0, 1e9}); }},
    {{"time", "number [s]", "0", "last_scatter, two_pass, path_traced: or until so much wall time is spent; 0: no limit"},
     [](T t, K k, Settings& s) { s.render.time = t.number(k, {0.0, 1e9}); }},
    {{"scatterings", "whole number", "0", "two_pass: scatterings by chance, the last of which takes the solution's light; 0: 1, or 3 where a medium does not scatter evenly"},
     [](T t, K k, Settings& s) { s.render.scatterings = t.count(k, 0, 1000); }},
    {{"seed", "whole number", "solve.seed", "of the places in a pixel that rays go through"},
     [](T t, K k, Settings& s) { s.render.seed = t.count(k, 0, 1ull << 53); }},
    {{"exposure", "number [stops]", "0", "added to the automatic exposure of the PNG"},
     [](T t, K k, Settings& s) { s.tone_map.exposure = t.number(k, {-100.0, 100.0}); }},
    {{"tone", "\"shoulder\", \"filmic\", \"reinhard\" or \"linear\"", "\"shoulder\"", "curve from radiance to the light of the PNG"},
     [](T t, K k, Settings& s) { s.tone_map.curve = static_cast<render::ToneCurve>(t.choice(k, render::tone_curve_names())); }},
    {{"white", "number [W/m²/sr]", "automatic", "radiance shown as white in the PNG"},
     [](T t, K k, Settings& s) { s.tone_map.white = t.number(k, positive); }},
};
// clang-format on

template <std::size_t size>
KeyTable table_of(std::string_view title, const SceneSetting (&settings)[size]) {
    KeyTable table{title, {}};
    for (const SceneSetting& setting : settings) table.keys.push_back(setting.key);
    return table;
}

template <std::size_t size>
void read(const TableReader& root, std::string_view name, const KeyTable& keys,
          const SceneSetting (&settings)[size], Settings& result) {
    if (!root.has(name)) return;
    const TableReader table = root.table(name, keys, std::string(keys.title));
    for (const SceneSetting& setting : settings) {
        if (table.has(setting.key.name)) setting.read(table, setting.key.name, result);
    }
}

}  // namespace

const KeyTable& solve_keys() {
    static const KeyTable table = table_of("[solve]", solve_settings);
    return table;
}

const KeyTable& render_keys() {
    static const KeyTable table = table_of("[render]", render_settings);
    return table;
}

Settings read_settings(const TableReader& root) {
    Settings settings;
    read(root, "solve", solve_keys(), solve_settings, settings);
    if (const auto trouble = radiosity::solver_trouble(settings.solve))
        root.table("solve", solve_keys(), "[solve]").fail(trouble->key, trouble->message);
    settings.render.seed = settings.solve.seed;
    // Who asks for a uniform mesh wants to see what it holds.
    if (settings.solve.refinement < radiosity::Refinement::adaptive)
        settings.render.scattering_tolerance = render::as_elements_hold;
    read(root, "render", render_keys(), render_settings, settings);
    return settings;
}

std::optional<double> bytes_of(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
    struct Unit {
        std::string_view name;
        double bytes;
    };
    constexpr Unit units[]{{"", 1.0},       {"B", 1.0},      {"kB", 1e3},    {"KB", 1e3},
                           {"MB", 1e6},     {"GB", 1e9},     {"TB", 1e12},   {"KiB", 0x1p10},
                           {"MiB", 0x1p20}, {"GiB", 0x1p30}, {"TiB", 0x1p40}};
    for (const Unit& known : units) {
        if (unit == known.name) return value * known.bytes;
    }
    return std::nullopt;
}

}  // namespace tyndall::cli
