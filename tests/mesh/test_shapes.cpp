#include "mesh/shapes.h"

#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "support/catch.h"

using namespace tyndall::mesh;

namespace {

glm::dvec3 area_vector(const Polygon& polygon) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i) {
        sum += 0.5 * glm::cross(polygon.corners[i] - polygon.corners[0],
                                polygon.corners[i + 1] - polygon.corners[0]);
    }
    return sum;
}

glm::dvec3 area_vector(const Face& face) {
    glm::dvec3 sum(0.0);
    for (const Polygon& polygon : face.polygons) sum += area_vector(polygon);
    return sum;
}

// By the divergence theorem; positive where fronts look outward [m^3].
double volume(const std::vector<Face>& faces) {
    double sum = 0.0;
    for (const Face& face : faces) {
        for (const Polygon& p : face.polygons) sum += glm::dot(p.corners[0], area_vector(p)) / 3.0;
    }
    return sum;
}

const Face& named(const std::vector<Face>& faces, const std::string& name) {
    for (const Face& face : faces) {
        if (face.name == name) return face;
    }
    FAIL("no face " << name);
    return faces.front();
}

}  // namespace

TEST_CASE("A room's fronts look inward, a box's outward") {
    const auto inward = room({1, 2, 3}, {5, 5, 5}), outward = box({1, 2, 3}, {5, 5, 5});
    CHECK(inward.size() == 6);
    CHECK(volume(inward) == Approx(-24.0));
    CHECK(volume(outward) == Approx(24.0));
    CHECK(area_vector(named(inward, "floor")) == glm::dvec3(0, 0, 12));
    CHECK(area_vector(named(inward, "ceiling")) == glm::dvec3(0, 0, -12));
    CHECK(area_vector(named(inward, "x0")) == glm::dvec3(6, 0, 0));
    CHECK(area_vector(named(inward, "y1")) == glm::dvec3(0, -8, 0));
    CHECK(area_vector(named(outward, "bottom")) == glm::dvec3(0, 0, -12));
    CHECK(area_vector(named(outward, "y0")) == glm::dvec3(0, -8, 0));
    CHECK(area_vector(named(outward, "x1")) == glm::dvec3(6, 0, 0));
}

TEST_CASE("Faces that meet share their corners to the last bit") {
    const Point min(0.1, 0.2, 0.3), max(0.7, 0.9, 1.1);  // max − min + min is not max in binary
    for (const Face& face : room(min, max)) {
        for (const Point& p : face.polygons[0].corners) {
            for (int axis = 0; axis < 3; ++axis) {
                CHECK((p[axis] == min[axis] || p[axis] == max[axis]));
            }
        }
    }
}

TEST_CASE("Openings of a room keep the front of their face and take their part of it") {
    const auto faces =
        room({0, 0, 0}, {5, 4, 3},
             {{"x0", {"window", {1, 1}, {0.5, 1.5}}}, {"ceiling", {"hatch", {0, 0}, {5, 1}}}});
    REQUIRE(faces.size() == 8);
    CHECK(area_vector(named(faces, "x0")).x == Approx(12 - 0.75));
    CHECK(area_vector(named(faces, "window")).x == Approx(0.75));
    CHECK(area_vector(named(faces, "ceiling")).z == Approx(-15));
    CHECK(area_vector(named(faces, "hatch")).z == Approx(-5));
    CHECK(named(faces, "window").polygons[0].opacity == Opacity::interface);
    for (const Point& p : named(faces, "window").polygons[0].corners) {
        CHECK(p.x == 0.0);
        CHECK((p.y == 1.0 || p.y == 1.5));
        CHECK((p.z == 1.0 || p.z == 2.5));
    }
    CHECK(volume(faces) == Approx(-60.0));
}

TEST_CASE("An opening may take all of a face") {
    const auto faces = room({0, 0, 0}, {5, 4, 3}, {{"x1", {"gate", {0, 0}, {4, 3}}}});
    REQUIRE(faces.size() == 6);
    CHECK(area_vector(named(faces, "gate")).x == Approx(-12.0));
}

TEST_CASE("A rectangle's openings are measured in metres along u and v") {
    // Sides of 2 and 3 m, turned by 45 degrees about z.
    const double s = std::sqrt(0.5);
    const auto faces = rectangle({1, 1, 1}, {2 * s, 2 * s, 0}, {0, 0, 3},
                                 {{"slit", {0.5, 1}, {1, 0.5}}, {"low", {0.5, 0}, {1, 0.5}}});
    REQUIRE(faces.size() == 3);
    CHECK(faces[0].name == "");
    CHECK(glm::length(area_vector(faces[0])) == Approx(6 - 1));
    CHECK(glm::length(area_vector(named(faces, "slit"))) == Approx(0.5));
    const Point p = named(faces, "slit").polygons[0].corners[0];
    CHECK(glm::length(p - Point(1 + 0.5 * s, 1 + 0.5 * s, 2)) < 1e-15);  // a few roundings
    CHECK(area_vector(faces[0]).x > 0.0);                                // front = u × v
}

TEST_CASE("Openings may touch, though corner + size rounds") {
    // 0.1 + 0.2 > 0.3 in binary.
    const auto faces = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                 {{"a", {0.1, 0.1}, {0.2, 0.2}}, {"b", {0.3, 0.1}, {0.7, 0.2}}});
    CHECK(area_vector(faces[0]).z == Approx(1 - 0.04 - 0.14));
    for (const Polygon& p : faces[0].polygons) CHECK(area_vector(p).z > 1e-6);  // no slivers
}

TEST_CASE("Impossible shapes are refused") {
    CHECK_THROWS_AS(room({0, 0, 0}, {1, 0, 1}), InputError);
    CHECK_THROWS_AS(box({0, 0, 0}, {1, 1, NAN}), InputError);
    CHECK_THROWS_AS(room({0, 0, 0}, {1, 1, 1}, {{"bottom", {"a", {0, 0}, {1, 1}}}}), InputError);
    CHECK_THROWS_AS(rectangle({0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}), InputError);
    CHECK_THROWS_AS(rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, 0}), InputError);
    CHECK_THROWS_AS(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {{"a", {0.5, 0}, {0.6, 1}}}),
                    InputError);
    CHECK_THROWS_AS(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {{"a", {0.5, 0}, {0, 1}}}),
                    InputError);
}
