// Accuracy against cost of every exchange method, by kind of pair and extinction: the figures of
// docs/studies/exchange.md.
//
//   exchange_methods [FOLDER [METHOD|all [PAIR EXTINCTION]]]
//
// Pairs: two unit squares that touch, are near, far, and have a screen between them; a unit cube
// and its own face; a cube and itself, one that touches it and one that is far. Each in a medium of
// extinction 0, 0.1, 1 and 5 /m. Each method with its settings from coarse to fine, four seeds for
// those that draw numbers: root mean square of the relative errors against reference_pairs at 1e-8
// and median of the CPU seconds. Writes FOLDER/exchange.csv and a plot for each pair and
// extinction; with a METHOD only FOLDER/METHOD.csv, of that one; with a PAIR its plot, and its
// lines in FOLDER/PAIR_EXTINCTION.csv.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "cli/study_plot.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "mesh/shapes.h"
#include "radiosity/exchange_table.h"
#include "radiosity/resources.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

struct Pair {
    std::string name;
    Scene scene;  // without media that fill the rest
    std::vector<std::string> from, to;
    bool vacuum;  // whether it is there without a medium
};

void add(Scene& scene, const std::string& name, const std::vector<mesh::Face>& faces, bool opaque) {
    for (const auto& face : faces) {
        Surface surface;
        surface.name = face.name.empty() ? name : name + "." + face.name;
        surface.polygons = face.polygons;
        if (opaque) surface.material = 0;
        for (auto& polygon : surface.polygons)
            if (!opaque) polygon.opacity = mesh::Opacity::interface;
        scene.surfaces.push_back(surface);
    }
}

Scene squares(const std::vector<mesh::Face>& second) {
    Scene scene;
    add(scene, "one", mesh::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), true);
    add(scene, "two", second, true);
    return scene;
}

Scene cubes(std::optional<mesh::Point> second) {
    Scene scene;
    const auto cube = [&](const std::string& name, mesh::Point corner) {
        add(scene, name, mesh::box(corner, corner + 1.0), false);
        Medium medium;
        medium.name = name;
        medium.at = corner + 0.5;
        scene.media.push_back(medium);
    };
    cube("one", {0, 0, 0});
    if (second) cube("two", *second);
    return scene;
}

std::vector<Pair> pairs() {
    const auto above = [](double z) { return mesh::rectangle({0, 0, z}, {0, 1, 0}, {1, 0, 0}); };
    std::vector<Pair> all;
    const std::vector<std::string> one{"one+"}, two{"two+"};
    all.push_back({"patches touching", squares(mesh::rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1})),
                   one, two, true});
    all.push_back({"patches near", squares(above(0.1)), one, two, true});
    all.push_back({"patches far", squares(above(5.0)), one, two, true});
    Scene screened = squares(above(1.0));
    add(screened, "screen", mesh::rectangle({0.4, 0.1, 0.3}, {0.4, 0, 0}, {0, 0.6, 0}), true);
    all.push_back({"patches occluded", screened, one, two, true});
    Scene face = cubes({});
    add(face, "two", mesh::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), true);
    all.push_back({"zone and its face", face, {"one"}, two, false});
    all.push_back({"zone self", cubes({}), {"one"}, {"one"}, false});
    all.push_back({"zones touching", cubes(mesh::Point(1, 0, 0)), {"one"}, {"two"}, false});
    all.push_back({"zones far", cubes(mesh::Point(3, 1, 0)), {"one"}, {"two"}, false});
    return all;
}

struct Curve {
    std::string name, method;
    std::vector<ExchangeOptions> settings;  // from coarse to fine
    std::vector<std::string> texts;
    bool random = true;
};

std::vector<Curve> curves() {
    std::vector<Curve> all;
    const auto walked = [&](const std::string& name, PointSetKind kind) {
        Curve curve{name, "walked", {}, {}};
        for (std::size_t rays = 16; rays <= 16384; rays *= 4) {
            curve.settings.push_back({.rays = rays, .settings = {.point_set = kind}});
            curve.texts.push_back(fmt::format("{} rays a facet", rays));
        }
        all.push_back(curve);
    };
    walked("walked", PointSetKind::sobol);
    walked("walked (independent points)", PointSetKind::independent);
    const auto cubes = [&](const std::string& name, const std::string& method,
                           Projection projection, std::size_t most) {
        Curve curve{name, method, {}, {}};
        for (std::size_t centres = 1; centres <= most; centres *= 4) {
            const auto resolution = std::size_t(16 * std::sqrt(double(centres)));
            curve.settings.push_back(
                {.settings = {.resolution = std::min<std::size_t>(resolution, 64),
                              .centres = centres,
                              .random_offsets = true,
                              .projection = projection}});
            curve.texts.push_back(fmt::format("{} centres", centres));
        }
        all.push_back(curve);
    };
    for (const std::string method : {"point_to_polygon", "hemicube", "full_cube", "single_plane"})
        cubes(method, method, Projection::walked, 64);
    // Buffers cost the more, the more tetrahedra a medium has.
    cubes("full_cube (buffers)", "full_cube", Projection::z_buffer, 16);
    for (const std::string method :
         {"ray_traced_pairs", "reference_pairs", "contour_integration"}) {
        Curve curve{method, method, {}, {}, false};
        for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
            if (method == "ray_traced_pairs" && tolerance < 1e-4) break;
            curve.settings.push_back(
                {.settings = {.tolerance = tolerance, .uniform_transmittance = true}});
            curve.texts.push_back(fmt::format("tolerance {:g}", tolerance));
            if (method == "contour_integration") break;
        }
        all.push_back(curve);
    }
    return all;
}

Enclosure filled(Pair pair, double extinction) {
    Material grey;
    grey.reflectance = {0.5};
    pair.scene.materials = {grey};
    if (extinction > 0.0) {
        Medium rest;
        rest.name = "rest";
        pair.scene.media.push_back(rest);
        for (Medium& medium : pair.scene.media) {
            medium.extinction = {extinction};
            medium.albedo = {0.5};
        }
    }
    return make_enclosure(pair.scene);
}

double area(const Enclosure& enclosure, const Pair& pair, const std::string& method,
            const ExchangeOptions& options) {
    const auto table =
        exchange_table(enclosure, exchange_method(method), options, pair.from, pair.to);
    return table.entries.front().exchange_area[0];
}

struct Measured {
    double seconds, error;
};

// None where the method cannot do the pair.
std::optional<Measured> measured(const Enclosure& enclosure, const Pair& pair, const Curve& curve,
                                 ExchangeOptions options, double exact) {
    std::vector<double> seconds;
    double square = 0.0;
    const int seeds = curve.random ? 4 : 1;
    try {
        for (int seed = 1; seed <= seeds; ++seed) {
            options.seed = static_cast<std::uint64_t>(seed);
            const double begin = cpu_seconds();
            const double error = area(enclosure, pair, curve.method, options) / exact - 1.0;
            seconds.push_back(cpu_seconds() - begin);
            square += error * error / seeds;
        }
    } catch (const mesh::InputError&) {
        return {};
    }
    std::ranges::nth_element(seconds, seconds.begin() + seeds / 2);
    return Measured{seconds[static_cast<std::size_t>(seeds / 2)], std::sqrt(square)};
}

std::string slug(std::string text) {
    std::ranges::replace(text, ' ', '_');
    return text;
}

}  // namespace

int main(int count, char** words) {
    const std::filesystem::path folder = count > 1 ? words[1] : "exchange";
    const std::string only = count > 2 && std::string(words[2]) != "all" ? words[2] : "";
    const std::string only_pair = count > 4 ? words[3] : "";
    const double only_extinction = count > 4 ? std::stod(words[4]) : -1.0;
    std::filesystem::create_directories(folder);
    std::string csv = "pair,extinction,method,setting,cpu_seconds,relative_error\n";
    for (const Pair& pair : pairs())
        for (const double extinction : {0.0, 0.1, 1.0, 5.0}) {
            if (extinction == 0.0 && !pair.vacuum) continue;
            const std::string name = fmt::format("{}_{:g}", slug(pair.name), extinction);
            if (!only_pair.empty() && (pair.name != only_pair || extinction != only_extinction))
                continue;
            const Enclosure enclosure = filled(pair, extinction);
            const double exact =
                area(enclosure, pair, "reference_pairs", {.settings = {.tolerance = 1e-8}});
            cli::Plot plot{fmt::format("{}, extinction {} /m", pair.name, extinction),
                           "CPU seconds [s]",
                           "relative error [%]",
                           {},
                           {}};
            for (const Curve& curve : curves()) {
                if (!only.empty() && curve.method != only) continue;
                cli::Curve drawn{curve.name, {}};
                for (std::size_t k = 0; k < curve.settings.size(); ++k) {
                    const auto point = measured(enclosure, pair, curve, curve.settings[k], exact);
                    if (!point) continue;
                    csv += fmt::format("{},{},{},{},{:.3g},{:.3g}\n", pair.name, extinction,
                                       curve.name, curve.texts[k], point->seconds, point->error);
                    // Below what the reference is good for there is nothing to see.
                    drawn.points.push_back(
                        {std::max(point->seconds, 1e-5), std::max(point->error, 1e-9)});
                }
                if (!drawn.points.empty()) plot.curves.push_back(drawn);
            }
            if (only.empty()) mesh::write_file(folder / (name + ".svg"), cli::svg_of(plot));
            const std::string table = !only.empty() ? only : only_pair.empty() ? "exchange" : name;
            mesh::write_file(folder / (table + ".csv"), csv);
            fmt::print("{}, extinction {}: {:.10g} m2\n", pair.name, extinction, exact);
            std::fflush(stdout);
        }
    return 0;
}
