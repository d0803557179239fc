// Rows that solves of one mesh share: the same bits as with rows of their own.
#include "radiosity/shared_rows.h"

#include "radiosity/adaptive.h"
#include "radiosity/moving_bodies.h"
#include "support/catch.h"
#include "support/rooms.h"
#include "support/solution_difference.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A foggy room with a sun in its window; two bands of two extinctions, and a mirror.
Scene sunny_room() {
    Scene scene;
    scene.bands = 2;
    scene.materials = {test::material(0.5), test::material(0.0)};
    scene.materials[1].reflectance = {0.9, 0.9};
    scene.materials[1].specular = {0.6, 0.6};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {2, 1, 1}), 0);
    scene.surfaces.front().material = 1;
    test::add_surfaces(scene, "shelf", mesh::rectangle({0.9, 0, 0.4}, {0, 1, 0}, {0.4, 0, 0}), 0);
    scene.media = {test::medium(0.4, 0.7)};
    scene.media[0].extinction = {0.4, 0.8};
    PointLight lamp;
    lamp.position = {0.4, 0.5, 0.8};
    lamp.intensity = {10.0, 5.0};
    scene.lights = {{"lamp", lamp}};
    return scene;
}

SolveOptions cheap() {
    SolveOptions options;
    options.error = 0.3;
    options.rays = 32;
    options.gather_rays = 32;
    options.element_size = 0.6;
    options.max_elements = 4000;
    return options;
}

std::shared_ptr<const Enclosure> enclosure_of(const Scene& scene) {
    return std::make_shared<const Enclosure>(make_enclosure(scene));
}

Solution solved(const Scene& scene, const SolveOptions& options,
                std::shared_ptr<SharedRows> rows = {}) {
    Passes passes;
    passes.rows = std::move(rows);
    return solve_adaptively(enclosure_of(scene), options, {}, {}, passes);
}

// Of the first rows of a solve.
bool walked(const Solution& solution) {
    return solution.report.passes.front().rays > 0;
}

}  // namespace

TEST_CASE("Solves of scenes that differ in lights and scattering share rows, to the bit",
          "[shared_rows]") {
    const Scene first = sunny_room();
    Scene later = first;
    std::get<PointLight>(later.lights[0].source).position.x = 1.6;
    later.materials[0].reflectance = {0.3, 0.2};
    later.media[0].albedo = {0.2, 0.9};
    // From thick zones to thin ones the first rows are those of the initial mesh all the same.
    for (const double thickness : {10.0, 0.1}) {
        CAPTURE(thickness);
        SolveOptions options = cheap();
        options.indicators.push_back("optical_thickness");
        options.optical_thickness = thickness;
        const auto rows = std::make_shared<SharedRows>();
        const Solution made = solved(first, options, rows);
        CHECK(walked(made));
        CHECK_FALSE(rows->empty());
        const Solution shared = solved(later, options, rows), own = solved(later, options);
        CHECK_FALSE(walked(shared));
        CHECK(walked(own));
        CHECK(shared.coarse.radiance == own.coarse.radiance);
        CHECK(shared.coarse.incident == own.coarse.incident);
        CHECK(test::relative_difference(shared, own) == 0.0);
        CHECK(shared.report.closure_error == own.report.closure_error);
        CHECK(shared.report.net_power == own.report.net_power);
    }
}

TEST_CASE("Rows are made anew where rays would meet something else", "[shared_rows]") {
    const Scene scene = sunny_room();
    const auto made = enclosure_of(scene);
    const auto rows = std::make_shared<const RowSet>();
    const auto fit = [&](const Scene& other, const SolveOptions& options = cheap()) {
        SharedRows shared;
        CHECK_FALSE(shared.of(made, cheap()));
        shared.leave(rows);
        return shared.of(enclosure_of(other), options) == rows;
    };
    CHECK(fit(scene));
    Scene other = scene;
    other.lights.clear();
    other.environment = {1.0, 1.0};
    CHECK(fit(other));
    other = scene;
    other.media[0].extinction[1] = 0.9;
    CHECK_FALSE(fit(other));
    other = scene;
    other.materials[1].specular = {0.6, 0.5};
    CHECK_FALSE(fit(other));
    other = scene;
    for (auto& polygon : other.surfaces.back().polygons)
        for (Point& corner : polygon.corners) corner.z += 0.1;
    CHECK_FALSE(fit(other));
    // A grid that is read again is another object with the same values.
    Enclosure varying = *made, again = *made;
    const auto smoke = [](float densest) {
        const std::vector<float> values{0, 0, 0, 0, 1, 1, 1, densest};
        return ExtinctionBand{std::make_shared<const RegularGrid>(
            std::array<std::size_t, 3>{2, 2, 2}, Point(0.0), Point(2, 1, 1), values)};
    };
    varying.media[0].varying.assign(2, smoke(1));
    again.media[0].varying.assign(2, smoke(1));
    CHECK(same_for_rays(varying, again));
    again.media[0].varying.assign(2, smoke(2));
    CHECK_FALSE(same_for_rays(varying, again));
    CHECK_FALSE(same_for_rays(varying, *made));
    SolveOptions finer = cheap();
    finer.rays = 64;
    CHECK_FALSE(fit(scene, finer));
}
