#include "radiosity/closed_forms.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "mesh/visible_polygon.h"
#include "support/catch.h"
#include "support/gauss.h"

using namespace tyndall;
using mesh::Direction;
using mesh::Point;
using radiosity::projected_solid_angle;
using radiosity::solid_angle;

namespace {

using std::numbers::pi;

std::vector<Point> rectangle(double x0, double x1, double y0, double y1, double z) {
    return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

std::vector<Point> disc(int n, double radius, double z) {
    std::vector<Point> corners;
    for (int k = 0; k < n; ++k)
        corners.push_back(
            {radius * std::cos(2 * pi * k / n), radius * std::sin(2 * pi * k / n), z});
    return corners;
}

}  // namespace

TEST_CASE("Solid angles from textbooks", "[closed_forms]") {
    // A cube's face from its centre; a corner's eighth from three quadrant directions.
    CHECK(solid_angle(rectangle(-1, 1, -1, 1, 1)) == Approx(4 * pi / 6).epsilon(1e-14));
    CHECK(solid_angle(std::vector<Point>{{2, 0, 0}, {0, 3, 0}, {0, 0, 5}}) ==
          Approx(pi / 2).epsilon(1e-14));
    // Rectangle a × b at height h over its corner: asin(ab / √((a²+h²)(b²+h²))).
    CHECK(solid_angle(rectangle(0, 2, 0, 0.7, 1.3)) ==
          Approx(std::asin(2 * 0.7 / std::sqrt((4 + 1.69) * (0.49 + 1.69)))).epsilon(1e-14));
    // Near a half space, and edge-on.
    // (the fan's diagonal passes overhead: rounding over height is what is left).
    const double h = 1e-6;
    CHECK(solid_angle(rectangle(-1, 1, -1, 1, h)) ==
          Approx(4 * (pi / 2 - std::sqrt(2.0) * h)).epsilon(1e-9));
    CHECK(solid_angle(rectangle(1, 2, 1, 2, 0)) == 0.0);
    // Small and far: area / distance².
    CHECK(solid_angle(rectangle(0, 1e-6, 0, 1e-6, 1e3)) == Approx(1e-18).epsilon(1e-12));
}

TEST_CASE("Lambert's form from textbooks", "[closed_forms]") {
    const Direction up(0, 0, 1);
    // Corner of a parallel rectangle (Howell C-11: a = b = h = 1), as a factor: times π.
    const double factor = 1 / (2 * pi) * 2 * (1 / std::sqrt(2.0)) * std::atan(1 / std::sqrt(2.0));
    CHECK(projected_solid_angle(rectangle(0, 1, 0, 1, 1), up) ==
          Approx(pi * factor).epsilon(1e-14));
    // Disc of radius r at height h: π r² / (r² + h²); the inscribed polygon tends to it as 1/n².
    CHECK(projected_solid_angle(disc(2000, 0.5, 1.5), up) == Approx(pi * 0.1).epsilon(1e-5));
    CHECK(projected_solid_angle(rectangle(-1, 1, -1, 1, 1e-9), up) == Approx(pi).epsilon(1e-8));
    // Either way round, and a polygon that touches the horizon (C-12: perpendicular rectangle).
    auto wall = std::vector<Point>{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}};
    const double c12 = 0.5 * (std::atan(1.0) - 1 / std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)));
    CHECK(projected_solid_angle(wall, up) == Approx(c12).epsilon(1e-14));
    std::reverse(wall.begin(), wall.end());
    CHECK(projected_solid_angle(wall, up) == Approx(c12).epsilon(1e-14));
}

TEST_CASE("A polygon across the horizon counts above it only", "[closed_forms]") {
    const Direction up(0, 0, 1);
    const std::vector<Point> wall{{1, 0, -3}, {1, 1, -3}, {1, 1, 1}, {1, 0, 1}};
    std::vector<Point> above;
    mesh::clip(wall, up, 0.0, above);
    const double c12 = 0.5 * (std::atan(1.0) - 1 / std::sqrt(2.0) * std::atan(1 / std::sqrt(2.0)));
    CHECK(projected_solid_angle(above, up) == Approx(c12).epsilon(1e-14));
    above.clear();
    mesh::clip(rectangle(0, 1, 0, 1, -1), up, 0.0, above);
    CHECK(above.empty());
}

TEST_CASE("Opposed unit squares by integration", "[closed_forms]") {
    // Howell C-11 for a = b = h: F = 0.199824895698387.
    double sum = 0.0;
    for (const auto& [x, wx] : test::gauss(24, 0.0, 1.0))
        for (const auto& [y, wy] : test::gauss(24, 0.0, 1.0))
            sum +=
                wx * wy / pi * projected_solid_angle(rectangle(-x, 1 - x, -y, 1 - y, 1), {0, 0, 1});
    CHECK(sum == Approx(0.199824895698387).epsilon(1e-12));
}

TEST_CASE("Parts add up to the whole", "[closed_forms]") {
    const Direction n = glm::normalize(Direction(0.3, -0.2, 1));
    const auto whole = rectangle(-0.4, 0.9, -0.3, 0.8, 0.6);
    std::vector<Point> left, right;
    const Direction cut = glm::normalize(Direction(1, 0.4, 0));
    mesh::clip(whole, cut, 0.1, left);
    mesh::clip(whole, -cut, -0.1, right);
    CHECK(solid_angle(left) + solid_angle(right) == Approx(solid_angle(whole)).epsilon(1e-14));
    CHECK(projected_solid_angle(left, n) + projected_solid_angle(right, n) ==
          Approx(projected_solid_angle(whole, n)).epsilon(1e-14));
}
