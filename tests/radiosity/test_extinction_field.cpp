#include "radiosity/extinction_field.h"

#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// The largest departure of a sampled function from the function itself, at many places.
template <class F>
double departure(const SampledFunction& sampled, F f, Point low, Point high) {
    double worst = 0.0;
    for (int k = 0; k < 7; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i) {
                const Point x =
                    low + (high - low) * Direction((i + 0.4) / 40, (j + 0.3) / 40, (k + 0.45) / 7);
                worst = std::max(worst, std::abs(sampled.grid->at(x) - f(x)));
            }
    return worst;
}

}  // namespace

TEST_CASE("Sampled functions: as many cells as the function asks for") {
    const auto counts = [](const std::function<double(Point)>& f) {
        return sample_function(f, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}).grid->counts();
    };
    using Counts = std::array<std::size_t, 3>;
    CHECK(counts([](Point p) { return 1.0 + p.x + p.y * p.z; }) == Counts{2, 2, 2});
    // Bends in the middle of each axis.
    CHECK(counts([](Point p) {
              return 0.9 * (1 - 2 * std::abs(p.x)) * (1 - 2 * std::abs(p.y)) *
                         (1 - 2 * std::abs(p.z)) +
                     0.1;
          }) == Counts{3, 3, 3});
    const auto of_height = counts([](Point p) { return std::exp(-4.0 * p.z); });
    CHECK(of_height[0] == 2);
    CHECK(of_height[1] == 2);
    CHECK(of_height[2] == 129);  // h² κ''/8 ≤ 3e-4 of the largest at h = 1/128, not at 1/64
    const auto constant = sample_function([](Point) { return 0.3; }, {0, 0, 0}, {1, 1, 1});
    CHECK(constant.uniform);
    CHECK(constant.first == 0.3);
}

TEST_CASE("Sampled functions: the error is what was asked for, and falls with it") {
    const auto f = [](Point p) { return std::exp(-p.x * p.x - p.y * p.y); };
    const Point low(-2, -2, -2), high(2, 2, 2);
    std::size_t before = 0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        const auto sampled = sample_function(f, low, high, {.tolerance = tolerance});
        CHECK(sampled.error <= tolerance);
        // The two axes' departures add up between the points.
        CHECK(departure(sampled, f, low, high) <= 2.0 * tolerance);
        const auto n = sampled.grid->counts();
        CHECK(n[0] * n[1] * n[2] > before);
        before = n[0] * n[1] * n[2];
    }
}

TEST_CASE("Sampled functions: a jump ends at the limit and is told, bad values are refused") {
    const auto jump = sample_function([](Point p) { return p.z > 0.3 ? 1.0 : 0.0; }, {0, 0, 0},
                                      {1, 1, 1}, {.most_cells = 64});
    CHECK(jump.grid->counts()[2] == 65);
    CHECK(jump.error == Approx(0.5));
    const auto refused = [](const std::function<double(Point)>& f) {
        try {
            sample_function(f, {0, 0, 0}, {1, 2, 1});
        } catch (const mesh::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK_THAT(refused([](Point p) { return 1.0 - p.y; }),
               Contains("below 0") && Contains("at [0, 1.125, 0] m"));
    CHECK_THAT(refused([](Point p) { return std::log(p.x); }), Contains("[0, 0, 0]"));
    CHECK_THAT(refused([](Point p) { return std::sqrt(p.x - 0.1); }), Contains("nan"));
}

TEST_CASE("Extinction over a tet: mean and centre of a linear one in closed form") {
    const auto sampled =
        sample_function([](Point p) { return 1.0 + p.x + 2.0 * p.y; }, {0, 0, 0}, {1, 1, 1});
    const ExtinctionBand band{sampled.grid, 0.5};
    const std::array<Point, 4> corners{{{0, 0, 0}, {0.9, 0.1, 0}, {0.2, 0.8, 0.1}, {0.1, 0, 1}}};
    double sum = 0.0;
    Point centre(0.0);
    for (const Point& c : corners) sum += band.at(c);
    for (const Point& c : corners) centre += c * (sum + band.at(c)) / (5.0 * sum);
    const auto found = over_tet(band, corners);
    // Single precision of the grid's values.
    CHECK(found.mean == Approx(0.25 * sum).epsilon(1e-6));
    CHECK(glm::distance(found.centre, centre) < 1e-6);
    CHECK(rough_mean(band, corners) == Approx(0.25 * sum).epsilon(1e-6));

    // A small ball of smoke in a big tet is found, and weighed to some per cent.
    const auto ball = sample_function(
        [](Point p) {
            const Direction d = p - Point(0.25, 0.25, 0.25);
            return std::exp(-glm::dot(d, d) / 0.005);
        },
        {0, 0, 0}, {1, 1, 1});
    const auto of_ball = over_tet({ball.grid, 1.0}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    const double whole = std::pow(std::numbers::pi * 0.005, 1.5);
    CHECK(of_ball.mean / 6.0 == Approx(whole).epsilon(0.01));
    CHECK(glm::distance(of_ball.centre, Point(0.25, 0.25, 0.25)) < 0.01);

    const auto nothing = over_tet(
        {std::make_shared<const RegularGrid>(std::array<std::size_t, 3>{2, 2, 2}, Point(5, 5, 5),
                                             Point(6, 6, 6), std::vector<float>(8, 1.0f)),
         1.0},
        corners);
    CHECK(nothing.mean == 0.0);
    CHECK(nothing.centre == 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]));
}

TEST_CASE("Segments where extinction varies: optical depth and weights against closed forms") {
    // κ = 1 + 3 z along z: τ(s) = s + 1.5 s².
    const auto linear =
        sample_function([](Point p) { return 1.0 + 3.0 * p.z; }, {0, 0, 0}, {1, 1, 1});
    const ExtinctionBand band{linear.grid, 1.0};
    CHECK(band.depth({0.5, 0.5, 0.0}, {0, 0, 1}, 0.2, 0.9) ==
          Approx(0.7 + 1.5 * (0.81 - 0.04)).epsilon(1e-7));
    // κ = exp(−2 z), on a slanted line: what is left is the grid's tolerance.
    const auto fog = sample_function([](Point p) { return std::exp(-2.0 * p.z); }, {0, 0, 0},
                                     {1, 1, 1}, {.tolerance = 1e-5});
    const Direction d = glm::normalize(Direction(0.3, 0.4, 0.5));
    CHECK(ExtinctionBand{fog.grid, 3.0}.depth({0, 0, 0}, d, 0.0, 1.0) ==
          Approx(3.0 * (1.0 - std::exp(-2.0 * d.z)) / (2.0 * d.z)).epsilon(1e-5));

    // Weights by a fine sum, for segments of growing thickness; front + back is exact.
    for (const double length : {0.01, 0.1, 0.3}) {
        const auto w = band.weights({0.5, 0.5, 0.1}, {0, 0, 1}, 0.0, length);
        double front = 0.0, back = 0.0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double s = length * (i + 0.5) / steps;
            const double lost = length / steps * (1.3 + 3.0 * s) * std::exp(-1.3 * s - 1.5 * s * s);
            front += lost * (1.0 - s / length);
            back += lost * s / length;
        }
        INFO(length);
        CHECK(w.front + w.back == Approx(front + back).epsilon(1e-6));
        CHECK(w.transmittance ==
              Approx(std::exp(-1.3 * length - 1.5 * length * length)).epsilon(1e-6));
        // Simpson's rule on a departure: 1e-4 of the whole at τ = 0.5.
        CHECK(w.back == Approx(back).margin(2e-4 * (front + back)));
    }
    // Halves alike: the uniform segment's weights, to the bit.
    const auto uniform = segment_weights(0.7), halves = segment_weights(0.35, 0.35);
    CHECK(halves.front == uniform.front);
    CHECK(halves.back == uniform.back);
    // All of it in one half: no weight is negative.
    for (const auto& w : {segment_weights(0.0, 50.0), segment_weights(50.0, 0.0)}) {
        CHECK(w.front >= 0.0);
        CHECK(w.back >= 0.0);
        CHECK(w.front + w.back == Approx(1.0));
    }
}
