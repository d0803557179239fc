// Black bodies in bands: Planck's fractions, grey gases, and temperatures from powers.
#include "radiosity/black_body.h"
#include "radiosity/scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "support/catch.h"

using namespace tyndall::radiosity;

namespace {

// Hottel & Sarofim's two-term picture of a gas, with made numbers.
GreyGases two_gases() {
    return {"made up", 500.0, 2000.0, {{1e-5, {0.3, 1e-4}}, {3e-4, {0.5, -2e-4}}}};
}

SpectralModel planck(std::vector<double> edges) {
    SpectralModel model;
    model.band_edges = std::move(edges);
    return model;
}

}  // namespace

TEST_CASE("Planck's fraction: values by quadrature of 25 digits", "[heat]") {
    const std::array<std::pair<double, double>, 12> table{{{0.0005, 1.2987133335532e-9},
                                                           {0.001, 0.00032076978534901},
                                                           {0.002, 0.066729940289975},
                                                           {0.003, 0.27322926019498},
                                                           {0.004, 0.48086464383557},
                                                           {0.006, 0.73778941819724},
                                                           {0.01, 0.91415697099989},
                                                           {0.0144, 0.96545838418392},
                                                           {0.02, 0.98555383867978},
                                                           {0.05, 0.99890387705581},
                                                           {0.1, 0.99985521024727},
                                                           {1.0, 0.9999998479432}}};
    for (const auto& [lambda_t, fraction] : table) {
        INFO("lambda T = " << lambda_t << " m K");
        // The table's digits, and those of C2 beyond its tenth.
        CHECK(planck_fraction(lambda_t) == Approx(fraction).epsilon(1e-9));
    }
    // At Wien's displacement, a number without any constants of nature.
    CHECK(planck_fraction(second_radiation_constant / 4.965114231744276) ==
          Approx(0.25005454682271).epsilon(1e-12));
    CHECK(planck_fraction(0.0) == 0.0);
    CHECK(planck_fraction(infinity) == 1.0);
    // The two series meet at C2 = lambda T.
    const double seam = second_radiation_constant;
    CHECK(planck_fraction(seam * (1.0 + 1e-12)) ==
          Approx(planck_fraction(seam * (1.0 - 1e-12))).epsilon(1e-11));
}

TEST_CASE("Planck's fraction: the tables of textbooks", "[heat]") {
    // Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, table 12.1. Its last digits are
    // of older constants of nature: they agree to 5e-5.
    for (const auto& [micrometre_kelvin, fraction] : {std::pair{1000.0, 0.000321},
                                                      {2000.0, 0.066728},
                                                      {3000.0, 0.273232},
                                                      {4000.0, 0.480877},
                                                      {5000.0, 0.633747},
                                                      {6000.0, 0.737818},
                                                      {8000.0, 0.856288},
                                                      {10000.0, 0.914199}})
        CHECK(planck_fraction(1e-6 * micrometre_kelvin) == Approx(fraction).margin(5e-5));
}

TEST_CASE("Shares of bands add up", "[heat]") {
    const SpectralModel edges = planck({0.0, 2e-6, 5e-6, infinity});
    SpectralModel gases;
    gases.grey_gases = two_gases();
    for (const double t : {300.0, 900.0, 2500.0}) {
        double sum = 0.0, weights = 0.0;
        for (std::size_t b = 0; b < 3; ++b) {
            sum += black_share(edges, b, t);
            weights += black_share(gases, b, t);
        }
        CHECK(sum == Approx(1.0).epsilon(1e-14));
        CHECK(weights == Approx(1.0).epsilon(1e-14));
    }
    CHECK(black_share(gases, 1, 1000.0) == Approx(0.4));
    CHECK(black_share(gases, 2, 1000.0) == Approx(0.3));
    // Beyond the range the nearer end's.
    CHECK(black_share(gases, 1, 100.0) == black_share(gases, 1, 500.0));
    CHECK(black_share(gases, 1, 9000.0) == black_share(gases, 1, 2000.0));
    // What lies outside of closed bands is left out.
    CHECK(black_share(planck({3e-6, 5e-6}), 0, 1000.0) ==
          Approx(planck_fraction(0.005) - planck_fraction(0.003)));
}

TEST_CASE("A temperature is found from what it emits", "[heat]") {
    SpectralModel gases;
    gases.grey_gases = two_gases();
    const SpectralModel edges = planck({0.0, 2e-6, 5e-6, infinity}), window = planck({8e-6, 14e-6});
    const auto check = [](const SpectralModel& model, const std::vector<double>& weights) {
        for (const double t : {3.0, 77.0, 300.0, 499.0, 1200.0, 2100.0, 6000.0}) {
            const auto radiance = black_radiance(model, weights.size(), t);
            double total = 0.0;
            for (std::size_t b = 0; b < weights.size(); ++b) total += weights[b] * radiance[b];
            if (!(total > 1e-300)) continue;
            INFO(t << " K");
            CHECK(temperature_of(model, weights, total) == Approx(t).epsilon(1e-10));
        }
    };
    check({}, {0.4});
    check(edges, {0.9, 0.1, 0.5});
    check(edges, {0.0, 0.0, 1.0});
    check(edges, {1.0, 0.0, 0.0});  // shines in short waves alone: the power rises as e^T
    check(window, {0.7});
    check(gases, {0.0, 1e-5, 3e-4});
    CHECK(temperature_of(edges, std::vector{0.5, 0.5, 0.5}, 0.0) == 0.0);
    CHECK(std::isnan(temperature_of(edges, std::vector{0.5, 0.5, 0.5}, -1.0)));
    CHECK(std::isnan(temperature_of({}, std::vector{0.0}, 1.0)));
    // 1000 K: sigma T^4 = 56703.74 W/m^2.
    CHECK(temperature_of({}, std::vector{1.0}, 56703.74419 / M_PI) ==
          Approx(1000.0).epsilon(1e-12));
}
