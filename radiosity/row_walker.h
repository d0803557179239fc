// The rays that rows are walked by (exchange_walked.h): where each starts, and what it deposits.
#pragma once

#include <algorithm>
#include <glm/vec4.hpp>
#include <numbers>

#include "radiosity/open_places.h"
#include "radiosity/point_set.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_batches.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {

struct RayStart {
    mesh::Ray ray;
    mesh::WalkStart at;
    double weight = 1.0;  // what the ray counts beside the element's others
};

// Sums of shares, and with their places: (share, share × place from the hull's middle).
using Shares = RowAccumulator<double>;
using PlacedShares = RowAccumulator<glm::dvec4>;

class RowWalker {
  public:
    RowWalker(const Discretization& d, const ExchangeOptions& options, const PointSet& points)
        : d_(d),
          options_(options),
          points_(points),
          scene_(d, options.levels, options.band,
                 options.detail *
                     std::sqrt(4.0 * std::numbers::pi / static_cast<double>(points.size()))),
          middle_(0.5 * (d.enclosure.mesh.hull_min + d.enclosure.mesh.hull_max)) {
        for (const PatchId patch : d.elements.patches)
            centres_.push_back(centre_of(d.enclosure, d.forest, patch));
        for (const ZoneId zone : d.elements.zones)
            centres_.push_back(centre_of(d.enclosure, d.forest, zone));
        centres_.push_back(middle_);  // outside
    }

    void row(ElementId id, Shares& sums, FinishedRows& rows) const {
        double kept = 0.0;
        const double count =
            follow(id.value, [&](const mesh::Ray&, std::uint32_t column, double share, double) {
                sums.add(column, share);
                kept += share;
            });
        const double scale = scale_of(id.value, kept, count);
        if (scale == 0.0 && capacity(id.value) > 0.0) add_itself(id.value, rows);
        sums.take([&](std::uint32_t column, double sum) {
            if (!(sum > 0.0)) return;  // nothing was left when the ray came there
            rows.columns.push_back(column);
            rows.values.push_back(scale * sum);
        });
        rows.ends.push_back(rows.columns.size());
    }

    void row(ElementId id, PlacedShares& sums, FinishedRows& rows) const {
        double kept = 0.0;
        const double count = follow(
            id.value, [&](const mesh::Ray& ray, std::uint32_t column, double share, double at) {
                const Point place = ray.origin - middle_ + at * ray.direction;
                sums.add(column, share * glm::dvec4(1.0, place));
                kept += share;
            });
        const double scale = scale_of(id.value, kept, count);
        if (scale == 0.0 && capacity(id.value) > 0.0) add_itself(id.value, rows);
        sums.take([&](std::uint32_t column, const glm::dvec4& sum) {
            if (!(sum.x > 0.0)) return;
            rows.columns.push_back(column);
            rows.values.push_back(scale * sum.x);
            const Point place(sum.y, sum.z, sum.w);
            rows.moments.push_back(scale * (place - sum.x * (centres_[column] - middle_)));
        });
        rows.ends.push_back(rows.columns.size());
    }

    const PointSet& points() const { return points_; }
    Point middle() const { return middle_; }
    Point centre(std::uint32_t column) const { return centres_[column]; }
    const RowScene& scene() const { return scene_; }

    // A ray of an element, as it starts.
    RayStart start(std::size_t i, std::size_t ray) const {
        return start_of(i, points_(ray, hash_seed(options_.seed, i)));
    }
    // Whether light can be where a ray of an element starts.
    bool open(std::size_t i, const RayStart& at) const {
        const Enclosure& e = d_.enclosure;
        if (e.mesh.bodies.empty()) return true;
        if (!d_.elements.is_patch(i)) return !covered(e, at.ray.origin);
        return !e.solid(at.at.tet) &&
               !covered(e, at.ray.origin, normal_of(d_.forest, d_.elements.patches[i]));
    }
    double capacity(std::size_t i) const {
        return d_.elements.capacity[i * d_.elements.bands + options_.band];
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    // deposit(ray, column, share, distance) for all the rays of an element. Returns the sum of
    // their weights.
    template <class Deposit>
    double follow(std::size_t i, Deposit&& deposit) const {
        const std::uint64_t seed = hash_seed(options_.seed, i);
        RayStart start;
        double count = 0.0;
        RowWalk walk(scene_, [&](std::uint32_t column, double share, double distance) {
            deposit(start.ray, column, start.weight * share, distance);
        });
        const auto all = [&](auto&& place) {
            for (std::size_t k = 0; k < points_.size(); ++k) {
                start = start_of(i, points_(k, seed));
                if (!place(start)) continue;
                count += start.weight;
                if (radius() > 0.0) start.ray.length = radius();
                const auto arrival = walk.follow(start.ray, start.at);
                if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
            }
        };
        all([&](const RayStart& at) { return open(i, at); });
        // What a body covers altogether has the light that is just beside it.
        if (count == 0.0 && !d_.enclosure.mesh.bodies.empty() && !d_.elements.is_patch(i))
            all([&](RayStart& at) {
                const OpenPlace there = open_place(d_.enclosure, at.ray.origin, at.at.tet);
                at.ray.origin = there.x;
                at.at = {there.tet};
                return open(i, at);
            });
        return count;
    }

    double radius() const { return options_.settings.interaction_radius; }

    // What a share counts [m^2]; `kept`: shares of all rays that were deposited, `count` their
    // weights. What gets beyond the radius counts as if it were spread like the rest.
    double scale_of(std::size_t i, double kept, double count) const {
        if (radius() > 0.0) return kept > 0.0 ? capacity(i) / kept : 0.0;
        return count > 0.0 ? capacity(i) / count : 0.0;
    }

    // Nothing within the radius, or nothing where rays start: what is beyond is taken to shine as
    // the element itself.
    void add_itself(std::size_t i, FinishedRows& rows) const {
        rows.columns.push_back(static_cast<std::uint32_t>(i));
        rows.values.push_back(capacity(i));
        if (options_.radiance == Radiance::linear) rows.moments.push_back(Direction(0.0));
    }

    RayStart start_of(std::size_t i, Numbers u) const {
        const std::uint32_t member = d_.elements.pick_member(i, u[0]);
        return d_.elements.is_patch(i) ? on_patch(PatchId(member), u) : in_zone(ZoneId(member), u);
    }

    RayStart on_patch(PatchId patch, const Numbers& u) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[patch].corners;
        const auto w = uniform_in_triangle(u[0], u[1]);
        mesh::Ray ray;
        ray.origin =
            w[0] * forest.point(c[0]) + w[1] * forest.point(c[1]) + w[2] * forest.point(c[2]);
        ray.direction = cosine_direction(normal_of(forest, patch), u[3], u[4]);
        return {ray,
                mesh::start_before(d_.enclosure.mesh, forest.base_facet_side(patch), ray.origin)};
    }

    RayStart in_zone(ZoneId zone, const Numbers& u) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[zone].corners;
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        mesh::Ray ray;
        ray.origin = Point(0.0);
        for (int k = 0; k < 4; ++k) ray.origin += w[k] * forest.point(c[k]);
        ray.direction = uniform_direction(u[3], u[4]);
        const TetId tet = forest.base_tet(zone);
        // Origins are uniform, and count as much as they are dense: as if distributed as κ.
        const ExtinctionBand* varying = d_.enclosure.varying(tet, options_.band);
        return {ray,
                {tet},
                varying ? std::max(varying->at(ray.origin),
                                   least_density * d_.enclosure.extinction(tet, options_.band))
                        : 1.0};
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    const PointSet& points_;
    RowScene scene_;
    Point middle_;                // of the hull
    std::vector<Point> centres_;  // of columns, for moments
};

}  // namespace tyndall::radiosity
