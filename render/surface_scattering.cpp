#include "render/surface_scattering.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "radiosity/point_set.h"

namespace tyndall::render {
namespace {

using mesh::Direction;
using std::numbers::pi;

// Axes across the normal.
struct Frame {
    Direction u, v, n;

    explicit Frame(Direction normal) : n(normal) {
        const Direction axis = std::abs(n.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
        u = glm::normalize(glm::cross(axis, n));
        v = glm::cross(n, u);
    }
    Direction local(Direction w) const { return {glm::dot(w, u), glm::dot(w, v), glm::dot(w, n)}; }
    Direction world(Direction w) const { return w.x * u + w.y * v + w.z * n; }
};

}  // namespace

SurfaceScattering::SurfaceScattering(const radiosity::Enclosure& e) : e_(e) {
    std::map<double, std::shared_ptr<const GlossyLobe>> lobes;  // by roughness
    for (const auto& side : e.sides) {
        SideLobes result;
        double specular = 0.0, all = 0.0;
        for (std::size_t b = 0; b < e.bands; ++b) {
            all += side.reflectance[b];
            specular += side.specular.empty() ? 0.0 : side.specular[b];
        }
        if (specular > 0.0) {
            specular_ = true;
            result.share = specular / all;
            if (side.roughness > 0.0) {
                auto& lobe = lobes[side.roughness];
                if (!lobe) lobe = std::make_shared<const GlossyLobe>(side.roughness);
                result.lobe = lobe;
            }
        }
        sides_.push_back(std::move(result));
    }
}

double SurfaceScattering::value(std::uint32_t side, Lobe lobe, Direction n, Direction out,
                                Direction in, std::span<double> result) const {
    const double cosine = glm::dot(n, in);
    const auto& optics = e_.sides[side];
    double factor = 0.0, density = 0.0;
    if (cosine > 0.0 && lobe == Lobe::diffuse) {
        factor = density = cosine / pi;
    } else if (cosine > 0.0 && sides_[side].lobe) {
        const Frame frame(n);
        const Direction from = frame.local(out), to = frame.local(in);
        factor = sides_[side].lobe->value(from, to) * cosine;
        density = sides_[side].lobe->density(from, to);
    }
    for (std::size_t b = 0; b < e_.bands; ++b)
        result[b] = factor == 0.0           ? 0.0
                    : lobe == Lobe::diffuse ? factor * optics.diffuse(b)
                                            : factor * optics.specular[b];
    return density;
}

Bounce SurfaceScattering::sample(std::uint32_t side, Lobe lobe, Direction n, Direction out,
                                 RandomNumbers& random, std::span<double> weight) const {
    const auto& optics = e_.sides[side];
    Bounce bounce;
    if (lobe == Lobe::diffuse) {
        const double u = random();
        bounce.direction = radiosity::cosine_direction(n, u, random());
        bounce.density = glm::dot(bounce.direction, n) / pi;
        bounce.lost = !(bounce.density > 0.0);
        for (std::size_t b = 0; b < e_.bands; ++b) weight[b] *= optics.diffuse(b);
        return bounce;
    }
    double factor = 1.0;
    if (const GlossyLobe* glossy = sides_[side].lobe.get()) {
        const Frame frame(n);
        const Direction from = frame.local(out);
        const double choice = random(), u = random();
        const Direction in = glossy->sample(from, choice, u, random());
        bounce.direction = frame.world(in);
        bounce.density = glossy->density(from, in);
        bounce.lost = !(in.z > 0.0 && bounce.density > 0.0);
        if (bounce.lost) return bounce;
        factor = glossy->value(from, in) * in.z / bounce.density;
    } else {
        bounce.direction = 2.0 * glm::dot(out, n) * n - out;
    }
    for (std::size_t b = 0; b < e_.bands; ++b) weight[b] *= optics.specular[b] * factor;
    return bounce;
}

}  // namespace tyndall::render
