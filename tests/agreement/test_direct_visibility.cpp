// Exact visibility against shadow rays, in a room as the program meshes it.
#include <glm/geometric.hpp>
#include <random>

#include "mesh/shapes.h"
#include "radiosity/direct_light.h"
#include "support/catch.h"

using namespace tyndall;
using mesh::Direction;
using mesh::Point;

namespace {

// Turned about z and tilted a little.
std::vector<mesh::Polygon> turned(std::vector<mesh::Face> faces, Point about, double angle) {
    std::vector<mesh::Polygon> polygons;
    for (auto& face : faces)
        for (auto& polygon : face.polygons) {
            for (Point& p : polygon.corners) {
                const Point q = p - about;
                const double x = q.x * std::cos(angle) - q.y * std::sin(angle);
                const double y = q.x * std::sin(angle) + q.y * std::cos(angle);
                p = about + Point(x, y, q.z + 0.2 * x);
            }
            polygons.push_back(polygon);
        }
    return polygons;
}

void add(radiosity::Scene& scene, const std::string& name, std::vector<mesh::Polygon> polygons,
         std::size_t material) {
    scene.surfaces.push_back({name, std::move(polygons), material, ""});
}

// A room with turned boxes in the air and a lamp under its ceiling.
radiosity::Scene cluttered_room(std::mt19937_64& rng, int boxes) {
    const auto uniform = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(rng);
    };
    radiosity::Scene scene;
    scene.materials.resize(2);
    scene.materials[0].reflectance = {0.5};
    scene.materials[1].reflectance = {0.0};
    scene.materials[1].emission = {1.0};
    for (auto& face : mesh::room({0, 0, 0}, {4, 3, 3}))
        add(scene, "room." + face.name, std::move(face.polygons), 0);
    for (int k = 0; k < boxes; ++k) {
        const Point at(uniform(0.8, 3.2), uniform(0.8, 2.2), uniform(0.6, 2.2));
        const Point half(uniform(0.05, 0.3), uniform(0.05, 0.3), uniform(0.02, 0.2));
        add(scene, "box" + std::to_string(k),
            turned(mesh::box(at - half, at + half), at, uniform(0, 6)), 0);
    }
    const Direction u(0, 0.9, 0), v(1.2, 0, 0);  // front: u × v looks down
    for (auto& face : mesh::rectangle({1.4, 1.0, 2.9}, u, v))
        add(scene, "lamp", std::move(face.polygons), 1);
    scene.viewpoints = {{0.1, 0.1, 0.1}};
    scene.environment = {0.0};
    return scene;
}

}  // namespace

TEST_CASE("Direct light, exact and sampled, agree in cluttered rooms", "[direct_light]") {
    const int seed = GENERATE(1, 2, 3);
    std::mt19937_64 rng(seed);
    const auto enclosure = radiosity::make_enclosure(cluttered_room(rng, 4 * seed));
    const radiosity::DirectLight exact(enclosure);
    const radiosity::DirectLight sampled(enclosure, {.exact_occluders = 0, .shadow_rays = 8192});
    double worst = 0.0, sum = 0.0, difference = 0.0;
    int partly = 0;
    for (int k = 0; k < 400; ++k) {
        const Point x(std::uniform_real_distribution<double>(0.05, 3.95)(rng),
                      std::uniform_real_distribution<double>(0.05, 2.95)(rng),
                      std::uniform_real_distribution<double>(0.05, 2.8)(rng));
        const auto tet = mesh::locate(enclosure.mesh, x);
        if (enclosure.solid(tet)) continue;
        double a, b;
        exact.at_zone(x, tet, {&a, 1});
        sampled.at_zone(x, tet, {&b, 1});
        worst = std::max(worst, std::abs(a - b));
        sum += a;
        difference += a - b;
        partly += a != b;
        exact.at_patch(x, {0.6, 0, 0.8}, tet, {&a, 1});
        sampled.at_patch(x, {0.6, 0, 0.8}, tet, {&b, 1});
        worst = std::max(worst, std::abs(a - b));
    }
    CHECK(partly > 20);
    CHECK(sum > 1.0);
    // H of the whole lamp is up to 0.5 near it; 8192 quasi-random rays err by up to 0.5 % of that…
    CHECK(worst < 2.5e-3);
    // … without bias.
    CHECK(std::abs(difference) < 1e-3 * sum);
}
