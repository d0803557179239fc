// A grey medium in radiative equilibrium: the slab of Heaslet & Warming (1965) and the square of
// Crosbie & Schrenker (1984), in boxes that are wide, or long, enough.
#include <cmath>
#include <numbers>

#include "radiosity/adaptive.h"
#include "radiosity/probe.h"
#include "support/catch.h"
#include "support/heated_box.h"
#include "support/reference.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// As the mesh is: the gather at a probe is what sees more than the elements' means.
const SolveOptions as_meshed{.start = Start::base,
                             .refinement = Refinement::none,
                             .direct_light = DirectLightMode::rows,
                             .rays = 256,
                             .gather_rays = 16,
                             .solver_tolerance = 1e-8};

Solution solve(Enclosure enclosure) {
    return solve_adaptively(std::make_shared<const Enclosure>(std::move(enclosure)), as_meshed);
}

}  // namespace

TEST_CASE("Heaslet & Warming's slab: flux to 0.1 %", "[heat]") {
    const auto file = test::reference("4abc_slab");
    for (const double thickness : {0.1, 0.5, 1.0, 2.0, 5.0}) {
        // A ray that leaves the middle towards a side wall has gone through `half` m, and few do.
        const double half = std::max(6.0, 20.0 / std::sqrt(thickness));
        const auto across = test::graded(half, 1.5, 1.3);
        const Solution s = solve(
            test::heated_box({across, across, test::thin_at_ends(10)}, {.extinction = thickness}));
        const Probe probe(s, {.rays = 16384});
        double cold = 0.0, hot = 0.0;
        for (const double x : {-0.3, 0.1, 0.4})
            for (const double y : {-0.2, 0.05, 0.3}) {
                cold += probe.on_surface({x, y, 1.0}, {0, 0, -1}).irradiance[0];
                hot += probe.on_surface({x, y, 0.0}, {0, 0, 1}).irradiance[0];
            }
        const double into_cold = cold / (9.0 * std::numbers::pi);
        const double out_of_hot = 1.0 - hot / (9.0 * std::numbers::pi);
        std::string name = thickness < 1.0 ? std::to_string(thickness).substr(0, 3)
                                           : std::to_string(int(thickness));
        const double expected = test::reference_value(file, "slab_RE_black_Q_tau" + name);
        WARN("optical thickness " << thickness << ": " << into_cold / expected - 1.0 << " and "
                                  << out_of_hot / expected - 1.0 << " off, "
                                  << s.report.zones << " zones");
        CHECK(into_cold == Approx(expected).epsilon(1e-3));
        CHECK(out_of_hot == Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("Crosbie & Schrenker's square: source function on the centre line", "[heat]") {
    // Optical side 1, bottom hot, all black, two-dimensional: a long box with white ends.
    const std::array<double, 11> source{.6295, .5190, .4329, .3605, .3001, .2500,
                                        .2082, .1728, .1422, .1147, .0862};
    std::vector<double> cells;
    for (int k = 0; k <= 10; ++k) cells.push_back(0.1 * k);
    const Solution s = solve(test::heated_box({cells, test::graded(6.0, 0.6, 1.4),
                                               test::thin_at_ends(12)},
                                              {.reflectance_x = 0.0}));
    const Probe probe(s, {.rays = 65536});
    for (std::size_t k = 0; k < source.size(); ++k) {
        double sum = 0.0;
        for (const double y : {-0.2, -0.05, 0.1, 0.25})
            sum += probe.in_space({0.5, y, 0.1 * double(k)}).source[0];
        WARN("z = " << 0.1 * double(k) << ": " << sum / 4 << " for " << source[k] << ", "
                    << sum / 4 / source[k] - 1.0);
        CHECK(sum / 4.0 == Approx(source[k]).epsilon(5e-3));
    }
}
