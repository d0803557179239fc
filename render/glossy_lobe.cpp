#include "render/glossy_lobe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/point_set.h"

namespace tyndall::render {
namespace {

using mesh::Direction;

using std::numbers::pi;
constexpr double least_roughness = 0.03;
constexpr std::size_t cosines = 256, samples = 1024;

// Of Smith's masking: G₁ = 1 / (1 + Λ), G₂ = 1 / (1 + Λ_o + Λ_i).
double lambda(Direction w, double alpha) {
    const double z = w.z * w.z;
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - z) / z) - 1.0);
}

// A facet normal among those that `out` sees. Source: Heitz (2018).
Direction visible_normal(Direction out, double alpha, double u, double v) {
    const Direction w = glm::normalize(Direction(alpha * out.x, alpha * out.y, out.z));
    const double square = w.x * w.x + w.y * w.y;
    const Direction a =
        square > 0.0 ? Direction(-w.y, w.x, 0.0) / std::sqrt(square) : Direction(1, 0, 0);
    const Direction b = glm::cross(w, a);
    const double r = std::sqrt(u), turn = 2.0 * pi * v;
    const double x = r * std::cos(turn), share = 0.5 * (1.0 + w.z);
    const double y =
        (1.0 - share) * std::sqrt(std::max(0.0, 1.0 - x * x)) + share * r * std::sin(turn);
    const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    const Direction n = x * a + y * b + z * w;
    return glm::normalize(Direction(alpha * n.x, alpha * n.y, std::max(0.0, n.z)));
}

Direction mirrored(Direction out, Direction normal) {
    return 2.0 * glm::dot(out, normal) * normal - out;
}

}  // namespace

GlossyLobe::GlossyLobe(double roughness)
    : alpha_(std::pow(std::max(roughness, least_roughness), 2)) {
    // With visible normals a sample counts G₂ / G₁, or nothing below the surface.
    const radiosity::PointSet points(samples);
    for (std::size_t k = 0; k < cosines; ++k) {
        const double root = (double(k) + 1e-3) / double(cosines - 1);
        const double z = std::min(1.0, root * root);
        const Direction out(std::sqrt(1.0 - z * z), 0.0, z);
        double sum = 0.0;
        for (std::size_t n = 0; n < samples; ++n) {
            const auto u = points(n, 1);
            const Direction in = mirrored(out, visible_normal(out, alpha_, u[0], u[1]));
            if (in.z <= 0.0) continue;
            const double of_out = lambda(out, alpha_);
            sum += (1.0 + of_out) / (1.0 + of_out + lambda(in, alpha_));
        }
        single_.push_back(sum / double(samples));
    }
    double mean = 0.0;
    constexpr std::size_t steps = 4096;
    for (std::size_t k = 0; k < steps; ++k) {
        const double z = (double(k) + 0.5) / steps;
        mean += 2.0 * single(z) * z / steps;
    }
    mean_single_ = std::min(mean, 1.0 - 1e-9);
}

double GlossyLobe::single(double cosine) const {
    const double at = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * double(cosines - 1);
    const auto k = std::min<std::size_t>(std::size_t(at), cosines - 2);
    const double share = at - double(k);
    return (1.0 - share) * single_[k] + share * single_[k + 1];
}

double GlossyLobe::facets(Direction out, Direction in) const {
    const Direction half = glm::normalize(out + in);
    const double a = alpha_ * alpha_, z = half.z * half.z;
    // (x² + y²)/α² + z², without the loss of 1 − z² near the normal.
    const double d = (half.x * half.x + half.y * half.y) / a + z;
    return 1.0 / (pi * a * d * d);  // D
}

double GlossyLobe::value(Direction out, Direction in) const {
    if (out.z <= 0.0 || in.z <= 0.0) return 0.0;
    const double masked = 1.0 / (1.0 + lambda(out, alpha_) + lambda(in, alpha_));
    return facets(out, in) * masked / (4.0 * out.z * in.z) +
           (1.0 - single(out.z)) * (1.0 - single(in.z)) / (pi * (1.0 - mean_single_));  // (52)
}

Direction GlossyLobe::sample(Direction out, double choice, double u, double v) const {
    if (choice >= single(out.z)) return radiosity::cosine_direction({0, 0, 1}, u, v);
    return mirrored(out, visible_normal(out, alpha_, u, v));
}

double GlossyLobe::density(Direction out, Direction in) const {
    if (out.z <= 0.0 || in.z <= 0.0) return 0.0;
    const double once = single(out.z);
    const double visible = facets(out, in) / (4.0 * out.z * (1.0 + lambda(out, alpha_)));
    return once * visible + (1.0 - once) * in.z / pi;
}

}  // namespace tyndall::render
