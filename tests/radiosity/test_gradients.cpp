// Gradients of elements from their neighbours, and the moments of exchange areas they multiply.
#include "radiosity/element_mesh.h"
#include "radiosity/exchange_walked.h"
#include "support/catch.h"
#include "support/cube.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

Point centre_of(const Forest& forest, const Elements& e, std::size_t i) {
    return e.is_patch(i) ? forest.centroid(e.patches[i]) : forest.centroid(e.zone(i));
}

// A cube of 2 m, 3 cells a metre.
test::Cube grid(double extinction) {
    return {.extinction = extinction, .reflectance = 0.5, .size = {2, 2, 2}, .cells = 3};
}

}  // namespace

TEST_CASE("Gradients: a linear function's are exact, a constant's are 0", "[gradients]") {
    const auto enclosure = test::cube_enclosure(grid(1.0));
    const Forest forest(enclosure.mesh);
    const auto e = elements_of_leaves(enclosure, forest);
    const ElementGradients gradients(enclosure, forest, e);
    const Direction slope(0.3, -1.1, 2.0);
    std::vector<double> x(e.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = 7.0 + glm::dot(slope, centre_of(forest, e, i));
    const auto found = gradients.of(x);
    for (std::size_t i = 0; i < x.size(); ++i) {
        Direction expected = slope;
        // A wall tells the gradient along it.
        if (e.is_patch(i)) {
            const auto n = normal_of(forest, e.patches[i]);
            expected -= glm::dot(slope, n) * n;
        }
        // Single precision of the weights.
        REQUIRE(glm::distance(Direction(found[i]), expected) < 1e-5);
    }
    for (const auto& g : gradients.of(std::vector<double>(e.size(), 3.0)))
        REQUIRE(g == glm::vec3(0.0f));
}

TEST_CASE("Gradients: nothing is learned through a wall, nor from another medium", "[gradients]") {
    auto scene = test::slit_room();
    const auto enclosure = make_enclosure(scene);
    ElementMesh mesh(enclosure);
    mesh.refine_to({0.4, 100000, 100000});
    const auto e = elements_of_leaves(enclosure, mesh.forest());
    const ElementGradients gradients(enclosure, mesh.forest(), e);
    // 1 in the left half of the room, 0 in the right: only elements beside the slit see a slope.
    std::vector<double> x(e.size());
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = centre_of(mesh.forest(), e, i).x < 1.5 ? 1.0 : 0.0;
    const auto found = gradients.of(x);
    std::size_t sloped = 0;
    for (std::size_t i = e.patches.size(); i < x.size(); ++i) {
        const Point c = centre_of(mesh.forest(), e, i);
        if (glm::length(Direction(found[i])) == 0.0) continue;
        ++sloped;
        REQUIRE(std::abs(c.y - 1.0) < 0.6);  // the slit, 0.1 m either side of y = 1, and an element
    }
    CHECK(sloped > 0);
}

TEST_CASE("Rows with moments: J linear in space is received as the rays meet it", "[gradients]") {
    const double extinction = 20.0;
    const auto enclosure = test::cube_enclosure(grid(extinction));
    const Forest forest(enclosure.mesh);
    const auto e = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, e};
    const ExchangeOptions options{.rays = 64, .radiance = Radiance::linear, .progress = {}};
    const auto linear = all_rows(exchange_walked, d, options);
    const auto constant = all_rows(exchange_walked, d, {.rays = 64, .progress = {}});
    // The areas are the same to rounding: moments only come beside them.
    REQUIRE(linear.columns == constant.columns);
    REQUIRE(linear.values == constant.values);
    REQUIRE(linear.moments.size() == linear.values.size());
    REQUIRE(constant.moments.empty());

    // A moment is its area times a place within the element: no farther than its corners.
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t k = linear.starts[i]; k < linear.starts[i + 1]; ++k)
            if (linear.columns[k] != e.outside())
                REQUIRE(glm::length(linear.moments[k]) <=
                        linear.values[k] * 0.6f + 1e-8f);  // rounded

    // Far from all walls the mean of what arrives of a linear J is J itself. Zones of 6.7 optical
    // lengths, those whose centres are 10 from the walls.
    std::vector<double> x(e.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.0 + centre_of(forest, e, i).x;
    const auto with = multiply(linear, e, x), without = multiply(constant, e, x);
    double square_with = 0.0, square_without = 0.0, count = 0.0;
    for (std::size_t i = e.patches.size(); i < e.size(); ++i) {
        const auto off = glm::abs(centre_of(forest, e, i) - Point(1.0));
        if (std::max({off.x, off.y, off.z}) > 0.5) continue;
        square_with += std::pow(with[i] / e.capacity[i] - x[i], 2);
        square_without += std::pow(without[i] / e.capacity[i] - x[i], 2);
        count += 1.0;
    }
    // A mean free path is 0.05 m, and 64 independent rays would leave 0.05/√(3·64) = 0.0036 of
    // x's slope; constant elements err by 0.01 to 0.02 at each side that rays cross.
    CHECK(std::sqrt(square_with / count) < 0.0036);
    CHECK(std::sqrt(square_without / count) > 2.0 * std::sqrt(square_with / count));
}
