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

// The mesh as it is, all light in the rows: what comes out is the coarse solution, and what is
// gathered from it at the elements' corners.
Solution solve(Enclosure enclosure, std::size_t gather_rays) {
    return solve_adaptively(std::make_shared<const Enclosure>(std::move(enclosure)),
                            {.start = Start::base,
                             .refinement = Refinement::none,
                             .direct_light = DirectLightMode::rows,
                             .rays = 256,
                             .gather_rays = gather_rays,
                             .solver_tolerance = 1e-8});
}

// Net flux out of the floor (z = 0), or into the ceiling, over π: the mean over the patches of its
// inner quarter, whose noise is their own each.
double flux(const Solution& s, double half, bool floor) {
    const Elements& e = s.coarse.elements;
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < e.patches.size(); ++i) {
        const Point x = s.forest.centroid(e.patches[i]);
        if (std::abs(x.x) > 0.5 * half || std::abs(x.y) > 0.5 * half || x.z != (floor ? 0.0 : 1.0))
            continue;
        sum += e.capacity[i] * (s.coarse.radiance[i] - s.coarse.incident[i]);
        area += e.capacity[i];
    }
    return (floor ? sum : -sum) / area;
}

}  // namespace

TEST_CASE("Heaslet & Warming's slab: flux to 0.1 %", "[heat][long]") {
    const auto file = test::reference("4abc_slab");
    for (const std::string thickness : {"0.1", "1", "2", "5"}) {
        // The side walls are white. What they change is seen from within `half` under a small
        // angle, or through many mean free paths: 30 m in the thinnest slab, 8 m in the thickest.
        const double extinction = std::stod(thickness);
        const double half = std::max(8.0, 10.0 / std::sqrt(extinction));
        const auto across = test::graded(half, 1.5, 1.3);
        const Solution s = solve(
            test::heated_box({across, across, test::thin_at_ends(10)}, {.extinction = extinction}),
            16);
        const double expected = test::reference_value(file, "slab_RE_black_Q_tau" + thickness);
        const double out_of_hot = flux(s, half, true), into_cold = flux(s, half, false);
        INFO("optical thickness " << thickness << ": " << into_cold / expected - 1.0 << " and "
                                  << out_of_hot / expected - 1.0 << " off, " << s.report.zones
                                  << " zones");
        CHECK(into_cold == Approx(expected).epsilon(1e-3));
        CHECK(out_of_hot == Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("Crosbie & Schrenker's square: source function on the centre line", "[heat][long]") {
    // Optical side 1, bottom hot, all black, two-dimensional: a long box with white ends.
    const std::array<double, 11> source{.6295, .5190, .4329, .3605, .3001, .2500,
                                        .2082, .1728, .1422, .1147, .0862};
    // Cells as fine along the box as across where it matters: long ones were 1 % off at the cold
    // end.
    const std::vector<double> across = test::thin_at_ends(10);
    std::vector<double> along;
    for (int k = -10; k <= 10; ++k) along.push_back(0.3 * k);
    const Solution s =
        solve(test::heated_box({across, along, across}, {.reflectance_x = 0.0}), 1024);
    // Means over cells along the box and over directions, each with a noise of its own.
    constexpr int places = 12;
    std::vector<double> found(source.size());
    for (int j = 0; j < places; ++j) {
        const Probe probe(s, {.rays = 4096, .seed = std::uint64_t(j) + 1});
        for (std::size_t k = 0; k < source.size(); ++k)
            found[k] += probe.in_space({0.5, 0.2 * (j - 5.5), 0.1 * double(k)}).source[0] / places;
    }
    for (std::size_t k = 0; k < source.size(); ++k) {
        INFO("z = " << 0.1 * double(k) << ": " << found[k] << " for " << source[k] << ", "
                    << found[k] / source[k] - 1.0);
        // What is gathered at corners is what the probes look at: from 16 rays each instead of 1024
        // single values were 1 % off.
        CHECK(found[k] == Approx(source[k]).epsilon(5e-3));
    }
}
