// Phase functions: what they integrate to, and directions drawn from them.
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/phase_function.h"
#include "radiosity/point_set.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// ∫ f(c) Φ(c) dω by the midpoint rule in the cosine.
template <class Function>
double integral(const PhaseFunction& phase, Function&& f) {
    constexpr int steps = 200000;
    double sum = 0.0;
    for (int k = 0; k < steps; ++k) {
        const double c = -1.0 + 2.0 * (k + 0.5) / steps;
        sum += f(c) * phase_value(phase, c);
    }
    return sum * 2.0 * std::numbers::pi * 2.0 / steps;
}

}  // namespace

TEST_CASE("Phase functions are 1 over all directions, and have the mean cosine they say") {
    for (const double g : {-0.6, 0.0, 0.3, 0.85}) {
        const PhaseFunction phase{PhaseKind::henyey_greenstein, g};
        // The midpoint rule's error at the forward peak of g = 0.85.
        CHECK(integral(phase, [](double) { return 1.0; }) == Approx(1.0).epsilon(1e-7));
        CHECK(integral(phase, [](double c) { return c; }) == Approx(g).margin(1e-7));
    }
    const PhaseFunction rayleigh{PhaseKind::rayleigh};
    CHECK(integral(rayleigh, [](double) { return 1.0; }) == Approx(1.0).epsilon(1e-9));
    CHECK(integral(rayleigh, [](double c) { return c * c; }) == Approx(0.4).epsilon(1e-9));
    CHECK_FALSE(rayleigh.isotropic());
    CHECK(PhaseFunction{}.isotropic());
}

TEST_CASE("Directions are drawn as phase functions say") {
    const Direction before = glm::normalize(Direction(0.3, -0.5, 0.8));
    // Moments of the cosine from a net of 2^14 points: its error is far below 1/√N.
    const PointSet points(1 << 14);
    for (const auto& phase :
         {PhaseFunction{PhaseKind::henyey_greenstein, -0.6}, PhaseFunction{},
          PhaseFunction{PhaseKind::henyey_greenstein, 5e-5},
          PhaseFunction{PhaseKind::henyey_greenstein, 0.85}, PhaseFunction{PhaseKind::rayleigh}}) {
        double first = 0.0, second = 0.0;
        Direction mean(0.0);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto u = points(k, 1);
            const Direction d = sample_phase(phase, before, u[0], u[1]);
            REQUIRE(glm::length(d) == Approx(1.0).epsilon(1e-12));
            const double c = glm::dot(d, before);
            first += c;
            second += c * c;
            mean += d;
        }
        const double n = double(points.size());
        CHECK(first / n == Approx(integral(phase, [](double c) { return c; })).margin(5e-4));
        CHECK(second / n == Approx(integral(phase, [](double c) { return c * c; })).margin(5e-4));
        // Even about the axis.
        CHECK(glm::length(mean / n - (first / n) * before) < 2e-3);
    }
}
