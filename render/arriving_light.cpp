#include "render/arriving_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numbers>

namespace tyndall::render {

using mesh::Direction;
using mesh::Point;
using mesh::TetId;
using mesh::VertexId;
using mesh::ZoneId;
using radiosity::none;

namespace {

// Zones below this share of their distance stand for their leaves in walks, as in the solve's own
// last gathers.
constexpr double cube_detail = 0.2;
constexpr std::size_t sub_pixels = 4;  // along a pixel's edge, for its ∫ Y dω
// From a corner on a wall towards the node's middle, so that no ray starts on the wall [-].
constexpr double off_wall = 1e-3;

// Such that f_l of all orders above is below `series`.
std::size_t order_of(const radiosity::PhaseFunction& phase, const ArrivingLightOptions& options) {
    if (phase.isotropic()) return 0;
    if (phase.kind == radiosity::PhaseKind::rayleigh) return 2;
    const double orders = std::log(options.series) / std::log(std::abs(phase.asymmetry));
    return std::clamp<std::size_t>(std::size_t(std::ceil(orders)) - 1, 1, options.most_order);
}

std::array<double, 4> barycentric(const mesh::Forest& forest, ZoneId zone, Point x) {
    std::array<Point, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = forest.point(forest[zone].corners[k]) - x;
    const auto volume = [](Point a, Point b, Point c) { return glm::dot(a, glm::cross(b, c)); };
    std::array<double, 4> w{-volume(p[1], p[2], p[3]), volume(p[0], p[2], p[3]),
                            -volume(p[0], p[1], p[3]), volume(p[0], p[1], p[2])};
    const double sum = w[0] + w[1] + w[2] + w[3];
    for (double& v : w) v /= sum;
    return w;
}

}  // namespace

double phase_coefficient(const radiosity::PhaseFunction& phase, std::size_t l) {
    if (phase.kind == radiosity::PhaseKind::rayleigh) return l == 0 ? 1.0 : l == 2 ? 0.1 : 0.0;
    return l == 0 ? 1.0 : std::pow(phase.asymmetry, double(l));  // (57)
}

// Finds the nodes whose corners have cubes.
class ArrivingLight::Grouping {
  public:
    Grouping(ArrivingLight& light, const ArrivingLightOptions& options) : l_(light) {
        find_walls();
        std::vector<Point> low(l_.e_.media.size(), Point(std::numeric_limits<double>::max()));
        std::vector<Point> high(l_.e_.media.size(), -low.front());
        for_tets([&](TetId tet, std::uint32_t medium) {
            for (const VertexId v : l_.e_.mesh.tets[tet.value]) {
                low[medium] = glm::min(low[medium], l_.e_.mesh.points[v.value]);
                high[medium] = glm::max(high[medium], l_.e_.mesh.points[v.value]);
            }
        });
        for_tets([&](TetId tet, std::uint32_t medium) {
            below(mesh::root_zone(tet), options.group * glm::distance(low[medium], high[medium]));
        });
    }

  private:
    template <class OnTet>
    void for_tets(OnTet&& on_tet) const {
        const auto& e = l_.e_;
        for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) {
            const TetId tet(t);
            if (e.solid(tet) || e.medium_of(tet) == none) continue;
            if (!e.media[e.medium_of(tet)].phase.isotropic()) on_tet(tet, e.medium_of(tet));
        }
    }

    // Base vertices of opaque facets.
    void find_walls() {
        on_wall_.assign(l_.e_.mesh.points.size(), false);
        for (const auto& facet : l_.e_.mesh.facets)
            if (facet.opacity == mesh::Opacity::opaque)
                for (const VertexId v : facet.corners) on_wall_[v.value] = true;
    }

    void below(ZoneId zone, double size) {
        const auto& forest = l_.s_.forest;
        if (!forest.is_leaf(zone) && forest[zone].longest_edge > size) {
            below(forest[zone].first_child, size);
            below(ZoneId(forest[zone].first_child.value + 1ull), size);
            return;
        }
        l_.group_of_[zone.value] = std::uint32_t(l_.corners_.size());
        std::array<std::uint32_t, 4> cubes;
        for (int k = 0; k < 4; ++k) cubes[k] = cube_at(zone, forest[zone].corners[k]);
        l_.corners_.push_back(cubes);
    }

    // A corner that may be on a wall has a cube for each base tet: two of them may lie on two sides
    // of it.
    std::uint32_t cube_at(ZoneId zone, VertexId corner) {
        const auto& forest = l_.s_.forest;
        bool wall = true;
        for (const VertexId v : forest.carrier(corner))
            if (v.valid()) wall = wall && on_wall_[v.value];
        const TetId tet = forest.base_tet(zone);
        const auto [at, fresh] =
            known_.try_emplace({corner.value, wall ? tet.value : none}, l_.cubes_.size());
        if (fresh) {
            const Point x = forest.point(corner);
            auto cube = std::make_unique<Cube>();
            cube->x = wall ? x + off_wall * (forest.centroid(zone) - x) : x;
            cube->tet = tet;
            l_.cubes_.push_back(std::move(cube));
        }
        return std::uint32_t(at->second);
    }

    ArrivingLight& l_;
    std::vector<bool> on_wall_;
    std::map<std::array<std::uint32_t, 2>, std::size_t> known_;
};

ArrivingLight::ArrivingLight(const radiosity::Solution& solution,
                             const ArrivingLightOptions& options)
    : s_(solution),
      e_(*solution.enclosure),
      bands_(e_.bands),
      scene_(e_, s_.forest, radiosity::reflected_sources(s_), cube_detail) {
    for (const auto& medium : e_.media) order_ = std::max(order_, order_of(medium.phase, options));
    group_of_.assign(s_.forest.zone_count(), none);
    if (order_ == 0) return;
    weigh_pixels(options.resolution);
    Grouping(*this, options);
}

void ArrivingLight::weigh_pixels(std::size_t resolution) {
    const std::size_t count = harmonics_count(order_);
    std::vector<double> values(count);
    for (const auto& face : radiosity::full_cube_faces(resolution))
        for (std::size_t j = 0; j < face.nv; ++j)
            for (std::size_t i = 0; i < face.nu; ++i) {
                const double share = face.weights[j * face.nu + i];
                pixels_.push_back({glm::normalize(face.direction(i, j)), share});
                const std::size_t first = harmonics_.size();
                harmonics_.resize(first + count, 0.0);
                double sum = 0.0;
                for (std::size_t k = 0; k < sub_pixels * sub_pixels; ++k) {
                    const auto aside = [](std::size_t n) {
                        return (double(n) + 0.5) / double(sub_pixels) - 0.5;
                    };
                    Direction d = face.direction(i, j);
                    d[face.along_u] += aside(k % sub_pixels) * face.u_step();
                    d[face.along_v] += aside(k / sub_pixels) * face.v_step();
                    const double length = glm::length(d), weight = 1.0 / std::pow(length, 3);
                    sum += weight;
                    spherical_harmonics(d / length, order_, values);
                    for (std::size_t n = 0; n < count; ++n)
                        harmonics_[first + n] += weight * values[n];
                }
                for (std::size_t n = 0; n < count; ++n)
                    harmonics_[first + n] *= 4.0 * std::numbers::pi * share / sum;
            }
}

void ArrivingLight::make(Cube& cube) const {
    const std::size_t count = harmonics_count(order_);
    cube.mean.assign(bands_, 0.0);
    cube.moments.assign(bands_ * count, 0.0);
    thread_local std::vector<double> radiance;
    radiance.resize(bands_);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        radiosity::radiance_along(scene_, {cube.x, pixels_[p].direction}, {cube.tet}, radiance);
        const double* harmonics = &harmonics_[p * count];
        for (std::size_t b = 0; b < bands_; ++b) {
            // An ancestor's linear function may dip below zero.
            const double value = std::max(0.0, radiance[b]);
            cube.mean[b] += pixels_[p].share * value;
            double* moments = &cube.moments[b * count];
            for (std::size_t n = 0; n < count; ++n) moments[n] += value * harmonics[n];
        }
    }
    for (std::size_t b = 0; b < bands_; ++b)
        if (cube.mean[b] > 0.0)
            for (std::size_t n = 0; n < count; ++n) cube.moments[b * count + n] /= cube.mean[b];
}

const ArrivingLight::Cube& ArrivingLight::made(std::uint32_t index) const {
    Cube& cube = *cubes_[index];
    std::call_once(cube.made, [&] { make(cube); });
    return cube;
}

std::span<const double> ArrivingLight::mean(std::size_t cube) const {
    return made(std::uint32_t(cube)).mean;
}

void ArrivingLight::weigh(std::uint32_t medium, Direction direction,
                          std::vector<double>& weights) const {
    weights.resize(harmonics_count(order_));
    spherical_harmonics(direction, order_, weights);
    for (std::size_t l = 0; l <= order_; ++l) {
        const double f = phase_coefficient(e_.media[medium].phase, l);
        for (std::size_t n = l * l; n < (l + 1) * (l + 1); ++n) weights[n] *= f;
    }
}

void ArrivingLight::shares(ZoneId group, std::span<const double> weights, Point a, Point b,
                           std::span<double> at_a, std::span<double> at_b) const {
    const auto at = std::array{barycentric(s_.forest, group, a), barycentric(s_.forest, group, b)};
    thread_local std::vector<double> mean;
    mean.assign(2 * bands_, 0.0);
    std::ranges::fill(at_a, 0.0);
    std::ranges::fill(at_b, 0.0);
    for (int k = 0; k < 4; ++k) {
        const Cube& cube = made(corners_[group_of_[group.value]][k]);
        const double w_a = std::max(0.0, at[0][k]), w_b = std::max(0.0, at[1][k]);
        for (std::size_t band = 0; band < bands_; ++band) {
            const double* moments = &cube.moments[band * weights.size()];
            double q = 0.0;
            for (std::size_t n = 0; n < weights.size(); ++n) q += weights[n] * moments[n];  // (57)
            const double m = cube.mean[band], scattered = m * std::max(0.0, q);
            at_a[band] += w_a * scattered;
            at_b[band] += w_b * scattered;
            mean[2 * band] += w_a * m;
            mean[2 * band + 1] += w_b * m;
        }
    }
    for (std::size_t band = 0; band < bands_; ++band) {
        const double m_a = mean[2 * band], m_b = mean[2 * band + 1];
        at_a[band] = m_a > 0.0 ? at_a[band] / m_a : 1.0;
        at_b[band] = m_b > 0.0 ? at_b[band] / m_b : 1.0;
    }
}

}  // namespace tyndall::render
