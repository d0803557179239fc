// The arrays of a page: ropes lead to the neighbour, and a walk over them sees what the line of
// sight sees.
#include "radiosity/adaptive.h"
#include "radiosity/regular_grid.h"
#include "render/seen_solution.h"
#include "support/catch.h"
#include "support/random_rays.h"
#include "support/rooms.h"
#include "support/viewer_walk.h"

using namespace tyndall;
using mesh::Direction;
using mesh::Point;

namespace {

// A foggy room with a slit partition and a solid block, lit by a lamp; fog in three bands.
radiosity::Scene block_room() {
    radiosity::Scene scene = test::slit_room();
    scene.bands = 3;
    scene.materials[0].reflectance = {0.6, 0.5, 0.4};
    scene.materials[1].reflectance = {0.0, 0.0, 0.0};
    scene.materials[1].emission = radiosity::Spectrum{10.0, 8.0, 5.0};
    test::add_surfaces(scene, "block", mesh::box({2.0, 0.3, 0.0}, {2.4, 0.8, 0.5}), 0);
    scene.media[0].extinction = {0.2, 0.3, 0.5};
    scene.media[0].albedo = {0.9, 0.9, 0.9};
    return scene;
}

radiosity::Solution solved(const radiosity::Scene& scene, double extent) {
    radiosity::SolveOptions options{
        .error = 0.1, .max_elements = 3000, .rays = 16, .gather_rays = 16};
    options.element_size = 0.5 * extent;
    return radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene)), options);
}

const radiosity::Solution& block_solution() {
    static const radiosity::Solution solution = solved(block_room(), 1.0);
    return solution;
}

view::SharpenedPatches as_they_are(const radiosity::Solution& s) {
    return {s.forest, s.direct};
}

// What the line of sight sees along one ray, with the patches' own direct light.
std::vector<double> seen_along(const radiosity::Solution& s, const mesh::Ray& ray) {
    const render::SeenSolution sees(s, 1e30);
    const auto& e = *s.enclosure;
    const mesh::TetId start = mesh::locate(e.mesh, ray.origin);
    render::Seen seen;
    seen.clear(e.bands);
    const auto end = mesh::walk(e.mesh, ray, {start}, [&](mesh::TetId tet, double in, double out) {
        if (e.solid(tet) || e.medium_of(tet) == radiosity::none) return true;
        return mesh::descend(s.forest, mesh::root_zone(tet), ray, in, out, mesh::at_leaves,
                             [&](mesh::ZoneId zone, double s_in, double s_out) {
                                 return sees.cross(ray, zone, s_in, s_out, seen);
                             });
    });
    sees.arrive(ray, end, 0.0, seen);
    std::vector<double> sum(e.bands, 0.0);
    for (std::size_t part = 0; part < render::solved_parts; ++part)
        for (std::size_t b = 0; b < e.bands; ++b) sum[b] += seen.radiance[part * e.bands + b];
    return sum;
}

// The leaves in the arrays' order.
void collect(const mesh::Forest& forest, mesh::ZoneId zone, std::vector<mesh::ZoneId>& leaves) {
    if (forest.is_leaf(zone)) return leaves.push_back(zone);
    collect(forest, forest[zone].first_child, leaves);
    collect(forest, mesh::ZoneId(forest[zone].first_child.value + 1ull), leaves);
}

std::vector<mesh::ZoneId> leaves_of(const radiosity::Solution& s) {
    std::vector<mesh::ZoneId> leaves;
    for (std::size_t t = 0; t < s.enclosure->mesh.tets.size(); ++t)
        collect(s.forest, mesh::root_zone(mesh::TetId(t)), leaves);
    return leaves;
}

// The worst error of rays from points in the fog, relative to the radiance, or to a thousandth of
// the mean where that is more.
double worst_error(const radiosity::Solution& s, const view::ViewerArrays& a, int rays) {
    const test::ViewerWalk walk{a};
    test::Random random(7);
    std::vector<std::array<double, 2>> pairs;
    double mean = 0.0;
    for (int n = 0; n < rays; ++n) {
        const Point low = s.enclosure->mesh.hull_min, high = s.enclosure->mesh.hull_max;
        Point x;
        do
            for (int k = 0; k < 3; ++k) x[k] = test::uniform(random, low[k], high[k]);
        while (s.enclosure->solid(mesh::locate(s.enclosure->mesh, x)));
        const Direction d = test::random_direction(random);
        const auto expected = seen_along(s, {x, d});
        const auto found = walk.radiance(x - a.origin, d, s.enclosure->environment);
        for (std::size_t b = 0; b < a.bands; ++b) {
            pairs.push_back({expected[b], found[b]});
            mean += expected[b];
        }
    }
    mean /= static_cast<double>(pairs.size());
    REQUIRE(mean > 0.0);
    double worst = 0.0;
    for (const auto& [expected, found] : pairs)
        worst = std::max(worst, std::abs(found - expected) / std::max(expected, 1e-3 * mean));
    return worst;
}

}  // namespace

TEST_CASE("Every rope leads to the leaf that shares the face", "[view]") {
    const auto& s = block_solution();
    const auto a = view::viewer_arrays(s, as_they_are(s));
    const test::ViewerWalk walk{a};
    const auto leaves = leaves_of(s);
    REQUIRE(leaves.size() == a.zone_count());
    REQUIRE(leaves.size() > 1000);
    test::Random random(3);
    std::size_t neighbours = 0, walls = 0, hull = 0;
    for (std::size_t z = 0; z < leaves.size(); ++z) {
        const auto& corners = s.forest[leaves[z]].corners;
        for (int k = 0; k < 4; ++k) {
            const auto face = a.zone_planes[4 * z + k];
            // The corners of the face lie on its plane, to single precision in a room of 3 m.
            const auto w = test::random_weights<3>(random);
            Point x(0.0);
            for (int c = 0; c < 3; ++c) {
                const Point p = s.forest.point(corners[mesh::face_corners[k][c]]) - a.origin;
                CHECK(std::abs(walk.at(walk.plane(face), p)) < 2e-6);
                x += w[c] * p;
            }
            const Direction out = -Direction(walk.plane(face));
            auto rope = walk.descend(a.zone_ropes[4 * z + k], x - out, out, 1.0);
            if (test::ViewerWalk::is(rope, view::RopeKind::wall)) {
                ++walls;
                // The zones behind the wall have the face, too.
                rope = walk.descend(a.walls[2 * (rope / 4) + 1], x - out, out, 1.0);
            }
            if (rope == view::outside) {
                ++hull;
                continue;
            }
            REQUIRE(test::ViewerWalk::is(rope, view::RopeKind::zone));
            const auto* planes = &a.zone_planes[4 * static_cast<std::size_t>(rope / 4)];
            CHECK(std::count(planes, planes + 4, face ^ 1) == 1);
            CHECK(walk.nearest_face(rope / 4, x) > -2e-6);
            ++neighbours;
        }
    }
    CHECK(neighbours > 3000);
    CHECK(walls > 300);
    CHECK(hull > 100);
}

TEST_CASE("A walk over the arrays sees what the line of sight sees", "[view]") {
    const auto& s = block_solution();
    const auto a = view::viewer_arrays(s, as_they_are(s));
    // Single precision places faces to 1e-7 of the room; J and I may jump there by their own size.
    CHECK(worst_error(s, a, 3000) < 1e-4);
}

TEST_CASE("It does so in an open scene, and where extinction varies linearly", "[view][long]") {
    radiosity::Scene scene = test::slit_room();
    scene.environment = {0.5};
    scene.surfaces[test::surface_named(scene, "room.ceiling")].material.reset();
    for (auto& polygon : scene.surfaces[test::surface_named(scene, "room.ceiling")].polygons)
        polygon.opacity = mesh::Opacity::interface;
    scene.media[0].at = Point(0.5, 0.5, 0.5);
    const auto open = solved(scene, 1.4);
    CHECK(worst_error(open, view::viewer_arrays(open, as_they_are(open)), 1000) < 1e-4);

    // Twice the mean at the floor, none at the ceiling: within a leaf the page is exact.
    const auto grid = std::make_shared<const radiosity::RegularGrid>(
        std::array<std::size_t, 3>{2, 2, 2}, Point(0, 0, 0), Point(3, 2, 2),
        std::vector<float>{2, 2, 2, 2, 0, 0, 0, 0}, radiosity::BeyondGrid::edge);
    scene.media[0].shape = {{grid, ""}};
    const auto varying = solved(scene, 1.4);
    const auto a = view::viewer_arrays(varying, as_they_are(varying));
    REQUIRE(a.zone_extinction.size() == 4 * a.zone_count());
    CHECK(worst_error(varying, a, 1000) < 1e-4);
}

TEST_CASE("Far from the origin a page is as exact", "[view]") {
    radiosity::Scene scene = test::slit_room();
    const Point far(400.0, -300.0, 200.0);
    for (auto& surface : scene.surfaces)
        for (auto& polygon : surface.polygons)
            for (auto& corner : polygon.corners) corner += far;
    const auto s = solved(scene, 1.4);
    CHECK(worst_error(s, view::viewer_arrays(s, as_they_are(s)), 500) < 1e-4);
}
