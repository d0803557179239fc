// The glossy lobe: it gives back all light, both ways alike.
#include <cmath>
#include <numbers>

#include "radiosity/point_set.h"
#include "render/glossy_lobe.h"
#include "support/catch.h"

using namespace tyndall;

namespace {

mesh::Direction at_angle(double degrees) {
    const double t = degrees * std::numbers::pi / 180.0;
    return {std::sin(t), 0.0, std::cos(t)};
}

}  // namespace

TEST_CASE("A glossy lobe gives back all light, whatever its direction") {
    const radiosity::PointSet points(1 << 15);
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        const render::GlossyLobe lobe(roughness);
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
            const auto out = at_angle(degrees);
            double drawn = 0.0, square = 0.0, over_sphere = 0.0, of_density = 0.0;
            for (std::size_t k = 0; k < points.size(); ++k) {
                const auto u = points(k, 3);
                const auto in = lobe.sample(out, u[2], u[0], u[1]);
                const double v =
                    in.z > 0.0 ? lobe.value(out, in) * in.z / lobe.density(out, in) : 0.0;
                drawn += v;
                square += v * v;
                const auto any = radiosity::cosine_direction({0, 0, 1}, u[3], u[4]);
                over_sphere += lobe.value(out, any) * std::numbers::pi;
                of_density += lobe.density(out, any) * std::numbers::pi / any.z;
            }
            const double n = double(points.size());
            INFO("roughness " << roughness << ", " << degrees << " degrees");
            // The table of E, and the noise of what few grazing directions carry where the lobe is
            // narrow: 3 standard errors of independent points, more than a net's.
            const double mean = drawn / n, noise = std::sqrt((square / n - mean * mean) / n);
            CHECK(std::abs(mean - 1.0) < 4e-3 + 3.0 * noise);
            CHECK(noise < 0.01);
            // Even directions resolve the lobe only where it is wide.
            if (roughness >= 0.6 && degrees <= 60.0) {
                CHECK(over_sphere / n == Approx(1.0).margin(1e-2));
                CHECK(of_density / n <= 1.0 + 1e-2);
            }
        }
    }
}

TEST_CASE("A glossy lobe is reciprocal, and narrow where it is smooth") {
    const render::GlossyLobe lobe(0.4);
    for (const double a : {5.0, 40.0, 75.0})
        for (const double b : {10.0, 50.0, 85.0}) {
            const auto p = at_angle(a), q = at_angle(-b);
            CHECK(lobe.value(p, q) == Approx(lobe.value(q, p)).epsilon(1e-12));
        }
    const render::GlossyLobe smooth(0.05);
    CHECK(smooth.value(at_angle(40), at_angle(-40)) >
          1e4 * smooth.value(at_angle(40), at_angle(-45)));
    CHECK(smooth.single(0.7) == Approx(1.0).margin(1e-3));  // next to nothing is reflected twice
}
