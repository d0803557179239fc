#include "cli/solution_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "mesh/input_error.h"
#include "mesh/walk.h"
#include "radiosity/open_places.h"
#include "radiosity/point_set.h"
#include "radiosity/probe.h"

namespace tyndall::cli {
namespace {

using mesh::Direction;
using mesh::FacetId;
using mesh::Point;
using mesh::Side;
using mesh::TetId;
using radiosity::none;
using radiosity::Solution;

using std::numbers::pi;

// Chooses an index with a chance in proportion to its weight.
class Choice {
  public:
    explicit Choice(std::vector<double> weights) : sums_(std::move(weights)) {
        std::partial_sum(sums_.begin(), sums_.end(), sums_.begin());
    }
    bool empty() const { return sums_.empty() || !(sums_.back() > 0.0); }
    std::size_t operator()(double u) const {
        const auto at = std::upper_bound(sums_.begin(), sums_.end(), u * sums_.back());
        return std::min<std::size_t>(static_cast<std::size_t>(at - sums_.begin()),
                                     sums_.size() - 1);
    }

  private:
    std::vector<double> sums_;
};

void add_in_media(const radiosity::Enclosure& e, std::size_t count, std::uint64_t seed,
                  std::vector<SolutionPoint>& points) {
    std::vector<double> weights(e.mesh.tets.size(), 0.0);
    for (std::size_t t = 0; t < weights.size(); ++t) {
        if (e.solid(TetId(t))) continue;
        for (std::size_t b = 0; b < e.bands; ++b)
            weights[t] += e.extinction(TetId(t), b) * mesh::volume(e.mesh, TetId(t));
    }
    const Choice choose(std::move(weights));
    if (choose.empty()) return;
    const radiosity::PointSet set(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto u = set(k, seed);
        const auto& corners = e.mesh.tets[choose(u[0])];
        const auto w = radiosity::uniform_in_tet(u[1], u[2], u[3]);
        Point x(0.0);
        for (std::size_t c = 0; c < 4; ++c) x += w[c] * e.mesh.points[corners[c].value];
        points.push_back({x, Direction(0.0)});
    }
}

void add_on_sides(const radiosity::Enclosure& e, std::size_t count, std::uint64_t seed,
                  std::vector<SolutionPoint>& points) {
    std::vector<double> weights(2 * e.mesh.facets.size(), 0.0);
    for (std::size_t f = 0; f < e.mesh.facets.size(); ++f)
        for (const std::size_t k : {0, 1})
            if (e.facet_sides[f][k] != none) weights[2 * f + k] = mesh::area(e.mesh, FacetId(f));
    const Choice choose(std::move(weights));
    if (choose.empty()) return;
    const radiosity::PointSet set(count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto u = set(k, seed + 1);
        const std::size_t side = choose(u[0]);
        const FacetId facet(side / 2);
        const auto w = radiosity::uniform_in_triangle(u[1], u[2]);
        Point x(0.0);
        for (std::size_t c = 0; c < 3; ++c)
            x += w[c] * e.mesh.points[e.mesh.facets[facet.value].corners[c].value];
        const Direction n = mesh::normal(e.mesh, facet);
        points.push_back({x, side % 2 == 0 ? n : -n});
    }
}

radiosity::Spectrum held_in_space(const Solution& s, Point x) {
    const auto& e = *s.enclosure;
    const TetId tet = mesh::locate(e.mesh, x);
    if (!tet.valid() || e.solid(tet) || radiosity::covered(e, x)) return {};
    if (e.medium_of(tet) == none) return radiosity::Spectrum(e.bands, 0.0);
    const auto zone = s.forest.leaf_at(mesh::root_zone(tet), x);
    radiosity::Spectrum source;
    for (std::size_t b = 0; b < e.bands; ++b)
        source.push_back(radiosity::emission_of(s, zone, b) +
                         radiosity::scatter_of(s, zone, b) *
                             (s.direct.at(zone, b).at(x) + s.indirect.at(zone, b).at(x)));
    return source;
}

// The patch is the one that a short ray onto the wall meets.
radiosity::Spectrum held_on_side(const Solution& s, Point x, Direction normal) {
    const auto& e = *s.enclosure;
    const double step = 1e-6 * glm::distance(e.mesh.hull_min, e.mesh.hull_max);
    normal = glm::normalize(normal);
    const Point above = x + step * normal;
    const TetId tet = mesh::locate(e.mesh, above);
    if (!tet.valid() || e.solid(tet)) return {};
    const auto end = mesh::walk(e.mesh, {above, -normal, 3.0 * step}, {tet},
                                [](TetId, double, double) { return true; });
    if (end.arrival != mesh::Arrival::struck) return {};
    const auto patch = s.forest.leaf_at(mesh::root_patch(end.facet, end.side), x);
    radiosity::Spectrum irradiance;
    for (std::size_t b = 0; b < e.bands; ++b)
        irradiance.push_back(pi * (s.direct.at(patch, b).at(x) + s.indirect.at(patch, b).at(x)));
    return irradiance;
}

}  // namespace

std::vector<SolutionPoint> sample_points(const radiosity::Enclosure& enclosure, std::size_t count,
                                         std::uint64_t seed) {
    std::vector<SolutionPoint> points;
    add_in_media(enclosure, count, seed, points);
    add_on_sides(enclosure, count, seed, points);
    return points;
}

PointValues probed_values(const Solution& solution, const std::vector<SolutionPoint>& points,
                          std::size_t rays, const radiosity::ProgressCallback& progress) {
    const radiosity::Probe probe(solution, {rays, 1});
    PointValues values(points.size());
    std::vector<std::string> errors(points.size());
    std::atomic<std::size_t> done = 0;
    std::atomic<bool> stop = false;
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t k) {
        if (stop) return;
        try {
            const auto& point = points[k];
            values[k] = point.on_side() ? probe.on_surface(point.x, point.normal).irradiance
                                        : probe.in_space(point.x).source;
        } catch (const mesh::InputError& error) {
            errors[k] = error.what();
        }
        const double fraction = double(++done) / double(points.size());
        if (!radiosity::report(progress, {"probes", fraction, 0, 0.0})) stop = true;
    });
    for (const auto& error : errors)
        if (!error.empty()) throw mesh::InputError(error);
    if (stop) throw mesh::InputError("stopped on request: the solution was not probed.");
    return values;
}

PointValues held_values(const Solution& solution, const std::vector<SolutionPoint>& points) {
    PointValues values(points.size());
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t k) {
        const auto& point = points[k];
        values[k] = point.on_side() ? held_on_side(solution, point.x, point.normal)
                                    : held_in_space(solution, point.x);
    });
    return values;
}

std::optional<PointErrors> point_errors(const std::vector<SolutionPoint>& points, PointKind kind,
                                        const PointValues& values, const PointValues& reference) {
    PointErrors errors;
    double sum = 0.0, reference_sum = 0.0, size = 0.0, squares = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (points[k].on_side() != (kind == PointKind::on_sides)) continue;
        if (values[k].empty() || values[k].size() != reference[k].size()) continue;
        ++errors.points;
        for (std::size_t b = 0; b < values[k].size(); ++b, ++count) {
            const double v = values[k][b], r = reference[k][b];
            sum += v;
            reference_sum += r;
            size += std::abs(r);
            squares += (v - r) * (v - r);
        }
    }
    if (count == 0) return std::nullopt;
    const double n = static_cast<double>(count);
    errors.mean = sum / n;
    errors.reference_mean = reference_sum / n;
    const auto relative = [](double off, double unit) {  // 0 / 0: nothing there, nothing wrong
        return off == 0.0 ? 0.0 : off / unit;
    };
    errors.rmse = relative(std::sqrt(squares / n), size / n);
    errors.bias = relative((sum - reference_sum) / n, size / n);
    return errors;
}

}  // namespace tyndall::cli
