// Planes behind silhouette edges, and meshes cut along them.
#include "radiosity/shadow_boundaries.h"

#include <random>
#include <set>

#include "radiosity/adaptive.h"
#include "radiosity/refine.h"
#include "radiosity/solution_file.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A 4 × 3 × 3 m room in haze, with a window of 1 × 1 m in the wall x = 0 or without.
Scene room(bool window = true) {
    Scene scene;
    // Black outside: what the light does there would drown what is asked of the room.
    scene.materials = {test::material(0.5), test::material(0.0, 1e6), test::material(0.0)};
    scene.materials[0].back = 2;
    std::vector<mesh::FaceOpening> openings;
    if (window) openings.push_back({"x0", {"window", {1, 1}, {1, 1}}});
    for (const auto& face : mesh::room({0, 0, 0}, {4, 3, 3}, openings))
        test::add_surfaces(scene, "room", {face},
                           face.name == "window" ? std::optional<std::size_t>() : 0);
    scene.media = {test::medium(0.2, 0.9, Point(3.0, 1.4, 0.5))};
    return scene;
}

bool in_room(Point x) {
    return x.x > 0 && x.x < 4 && x.y > 0 && x.y < 3 && x.z > 0 && x.z < 3;
}

std::array<Point, 4> corners_of(const Enclosure& enclosure, std::size_t tet) {
    std::array<Point, 4> corners;
    for (int k = 0; k < 4; ++k)
        corners[k] = enclosure.mesh.points[enclosure.mesh.tets[tet][k].value];
    return corners;
}

Point centroid(const Enclosure& enclosure, std::size_t tet) {
    const auto c = corners_of(enclosure, tet);
    return 0.25 * (c[0] + c[1] + c[2] + c[3]);
}

Sun sun(double angle = 0.0) {
    return {{0.8, 0.1, -0.4}, {100.0}, angle};
}

// Planes of the sheets that reach into the room, told apart by their normals.
std::set<std::uint32_t> planes_inside(const Enclosure& enclosure, const ShadowBoundaries& all) {
    std::set<std::uint32_t> planes;
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t) {
        if (!in_room(centroid(enclosure, t))) continue;
        for (const auto k : all.at(TetId(t)))
            if (all.section(all.sheets()[k], corners_of(enclosure, t)).crosses)
                planes.insert(all.sheets()[k].plane_index);
    }
    return planes;
}

Enclosure with_light(Scene scene, decltype(Light::source) source) {
    scene.lights = {{"light", std::move(source), ""}};
    return make_enclosure(scene);
}

// What the leaves hold of direct light, against itself at random points of the room.
struct Fit {
    double error = 0.0;  // root mean square, over the root of direct light's mean square
    std::size_t elements = 0;
};

Fit fit(const Enclosure& enclosure, Refinement refinement, double goal, std::size_t max_elements) {
    SolveOptions options;
    options.refinement = refinement;
    options.error = goal;
    options.max_elements = max_elements;
    options.rays = 4;
    options.gather_rays = 1;
    const auto shared = std::make_shared<const Enclosure>(enclosure);
    const Solution solution = solve_adaptively(shared, options);
    const DirectLight light(enclosure);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    double square = 0.0, sum = 0.0;
    constexpr int points = 40000;
    for (int k = 0; k < points; ++k) {
        const Point x(4 * uniform(random), 3 * uniform(random), 3 * uniform(random));
        const TetId tet = mesh::locate(enclosure.mesh, x);
        double exact = 0.0;
        light.at_zone(x, tet, {&exact, 1});
        const ZoneId leaf = solution.forest.leaf_at(mesh::root_zone(tet), x);
        const double held = std::max(0.0, solution.direct.at(leaf, 0).at(x));
        square += (held - exact) * (held - exact);
        sum += exact * exact;
    }
    return {std::sqrt(square / sum), solution.report.zones + solution.report.patches};
}

}  // namespace

TEST_CASE("A window in the sun has four planes, through its edges along the beam", "[shadows]") {
    const auto enclosure = with_light(room(), sun());
    const ShadowBoundaries all(enclosure, true);
    const Direction beam = glm::normalize(sun().direction);
    const auto planes = planes_inside(enclosure, all);
    CHECK(planes.size() == 4);
    for (const auto k : planes) {
        const ShadowPlane& plane = all.plane(k);
        CHECK(std::abs(glm::dot(plane.normal, beam)) < 1e-12);
        CHECK(glm::length(plane.normal) == Approx(1.0));
        // Two of the window's corners lie on it, and no more.
        int on = 0;
        for (const Point corner : {Point(0, 1, 1), Point(0, 2, 1), Point(0, 1, 2), Point(0, 2, 2)})
            on += std::abs(plane.at(corner)) < 1e-12;
        CHECK(on == 2);
    }
    for (const auto& sheet : all.sheets()) CHECK(sheet.partner == none);
}

TEST_CASE("A point light's planes pass through it", "[shadows]") {
    const Point lamp(-2.0, 1.3, 2.8);
    const auto enclosure = with_light(room(), PointLight{lamp, {10.0}});
    const ShadowBoundaries all(enclosure, true);
    const auto planes = planes_inside(enclosure, all);
    CHECK(planes.size() == 4);
    for (const auto k : planes) CHECK(std::abs(all.plane(k).at(lamp)) < 1e-12);
}

TEST_CASE("A wide sun has two planes an edge, as far apart as its disc", "[shadows]") {
    const double angle = 0.02;
    const auto enclosure = with_light(room(), sun(angle));
    const ShadowBoundaries all(enclosure, true);
    CHECK(planes_inside(enclosure, all).size() == 8);
    const Direction beam = glm::normalize(sun().direction);
    for (const auto& sheet : all.sheets()) {
        REQUIRE(sheet.partner != none);
        const auto& other = all.sheets()[sheet.partner];
        CHECK(all.sheets()[other.partner].plane_index == sheet.plane_index);
        const Point edge = enclosure.mesh.points[sheet.edge[0].value];
        CHECK(all.width(sheet, edge) < 1e-12);
        // The disc is a polygon of 32 corners: its width is that of the circle to 1 %; seen from an
        // edge that leans towards it, it fills more.
        const Direction along = glm::normalize(enclosure.mesh.points[sheet.edge[1].value] - edge);
        const double lean = std::sqrt(1.0 - std::pow(glm::dot(along, beam), 2));
        CHECK(all.width(sheet, edge + 2.0 * beam) == Approx(angle * lean / lean).epsilon(0.02));
    }
}

TEST_CASE("A box casts the shadow of its outline alone", "[shadows]") {
    Scene scene = room(false);
    test::add_surfaces(scene, "box", mesh::box({1, 1, 1}, {2, 2, 2}), 0);
    const Point lamp(0.3, 0.4, 2.8);
    const auto enclosure = with_light(scene, PointLight{lamp, {10.0}});
    const ShadowBoundaries all(enclosure, true);
    // Seen from beside a corner, six of the twelve edges are the outline.
    CHECK(planes_inside(enclosure, all).size() == 6);
    // From inside a convex room nothing else is one.
    std::set<std::uint32_t> planes;
    for (const auto& sheet : all.sheets()) planes.insert(sheet.plane_index);
    CHECK(planes.size() == 6);
}

TEST_CASE("Sheets end at what seals them off", "[shadows]") {
    Scene scene = room();
    test::add_surfaces(scene, "screen", mesh::rectangle({2, 0, 0}, {0, 3, 0}, {0, 0, 3}), 0);
    const auto enclosure = with_light(scene, sun());
    const ShadowBoundaries all(enclosure, true);
    std::size_t before = 0, behind = 0;
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t) {
        const Point x = centroid(enclosure, t);
        if (!in_room(x)) continue;
        for (const auto k : all.at(TetId(t)))
            (x.x < 2.0 ? before : behind) +=
                all.section(all.sheets()[k], corners_of(enclosure, t)).crosses;
    }
    CHECK(before > 0);
    CHECK(behind == 0);
}

TEST_CASE("Leaves cut along a sharp shadow hold it with few elements", "[shadows][long]") {
    const auto enclosure = with_light(room(), sun());
    const Fit aligned = fit(enclosure, Refinement::aligned, 0.015, 100000);
    const Fit plain = fit(enclosure, Refinement::adaptive, 0.001, 30 * aligned.elements);
    CAPTURE(aligned.elements, aligned.error, plain.elements, plain.error);
    // A jump that elements do not follow leaves an error that falls as the square root of their
    // thickness: thirty times as many do not reach it.
    CHECK(aligned.error < 0.03);
    CHECK(plain.elements > 20 * aligned.elements);
    CHECK(plain.error > 2.0 * aligned.error);
}

TEST_CASE("A tiny lamp's penumbrae are cut on both sides", "[shadows]") {
    Scene scene = room();
    // 2 cm wide, 2 m before the window, towards it.
    test::add_surfaces(scene, "lamp", mesh::rectangle({-2, 1.49, 2.49}, {0, 0.02, 0}, {0, 0, 0.02}),
                       1);
    const auto enclosure = make_enclosure(scene);
    const Fit aligned = fit(enclosure, Refinement::aligned, 0.02, 100000);
    const Fit plain = fit(enclosure, Refinement::adaptive, 0.02, aligned.elements);
    CAPTURE(aligned.elements, aligned.error, plain.elements, plain.error);
    CHECK(aligned.error < 0.5 * plain.error);
}

TEST_CASE("Meshes along shadows are the same at any number of threads and in a file", "[shadows]") {
    const auto enclosure =
        std::make_shared<const Enclosure>(with_light(room(), PointLight{{-2.0, 1.3, 2.8}, {10.0}}));
    SolveOptions options;
    options.refinement = Refinement::aligned;
    options.error = 0.05;
    options.rays = options.gather_rays = 4;
    options.threads = 1;
    const Solution one = solve_adaptively(enclosure, options);
    options.threads = 3;
    const Solution three = solve_adaptively(enclosure, options);
    REQUIRE(one.forest.zone_count() == three.forest.zone_count());
    REQUIRE(one.forest.patch_count() == three.forest.patch_count());
    const auto path = std::filesystem::temp_directory_path() /
                      ("tyndall_shadows_" + std::to_string(std::random_device()()) + ".vtkhdf");
    write_solution(path, one, "");
    const Solution read = read_solution(path).solution;
    std::filesystem::remove(path);
    REQUIRE(read.forest.vertex_count() == one.forest.vertex_count());
    std::size_t elsewhere = 0, different = 0, off_middle = 0;
    for (std::size_t v = 0; v < one.forest.vertex_count(); ++v) {
        elsewhere += one.forest.point(VertexId(v)) != three.forest.point(VertexId(v));
        elsewhere += one.forest.point(VertexId(v)) != read.forest.point(VertexId(v));
    }
    for (const auto& edge : one.forest.vertex_edges()) off_middle += edge.t != 0.5;
    for (std::size_t z = 0; z < one.forest.zone_count(); ++z)
        for (const Solution* other : {&three, &read}) {
            different += one.forest[ZoneId(z)].corners != other->forest[ZoneId(z)].corners;
            different +=
                one.direct.at(ZoneId(z), 0).constant != other->direct.at(ZoneId(z), 0).constant;
        }
    CHECK(off_middle > 100);
    CHECK(elsewhere == 0);
    CHECK(different == 0);
}
