#include "radiosity/exchange_walked.h"

#include <algorithm>
#include <glm/vec4.hpp>
#include <numbers>

#include "radiosity/point_set.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_batches.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {
namespace {

struct RayStart {
    mesh::Ray ray;
    mesh::WalkStart at;
    double weight = 1.0;  // what the ray counts beside the element's others
};

// Sums of shares, and with their places: (share, share × place from the hull's middle).
using Shares = RowAccumulator<double>;
using PlacedShares = RowAccumulator<glm::dvec4>;

class Walker {
  public:
    Walker(const Discretization& d, const ExchangeOptions& options, const PointSet& points)
        : d_(d),
          options_(options),
          points_(points),
          scene_(d, options.levels, options.band,
                 options.detail *
                     std::sqrt(4.0 * std::numbers::pi / static_cast<double>(points.size()))),
          middle_(0.5 * (d.enclosure.mesh.hull_min + d.enclosure.mesh.hull_max)) {
        if (options.radiance == Radiance::constant) return;
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
        for (std::size_t k = 0; k < points_.size(); ++k) {
            start = start_of(i, points_(k, seed));
            count += start.weight;
            if (radius() > 0.0) start.ray.length = radius();
            const auto arrival = walk.follow(start.ray, start.at);
            if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
        }
        return count;
    }

    double radius() const { return options_.settings.interaction_radius; }

    double capacity(std::size_t i) const {
        return d_.elements.capacity[i * d_.elements.bands + options_.band];
    }

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
        const std::uint32_t facet_side = forest.base_facet_side(patch);
        return {ray, mesh::start_on(d_.enclosure.mesh, FacetId(facet_side / 2),
                                    facet_side % 2 ? Side::back : Side::front)};
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

template <class Accumulator>
void make_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, const RowSink& sink) {
    const PointSet points(options.rays, options.settings.point_set);
    const Walker walker(discretization, options, points);
    const std::size_t columns =
        options.levels ? options.levels->columns() : discretization.elements.size() + 1;
    // Neighbours walk through the same part of the trees: a task makes a run of rows, where there
    // are enough of them.
    const std::size_t run = std::clamp<std::size_t>(rows.size() / 64, 1, 32);
    make_row_batches(discretization, rows, options, sink, run, Accumulator(columns),
                     [&](ElementId id, Accumulator& sums, FinishedRows& finished) {
                         walker.row(id, sums, finished);
                     });
}

}  // namespace

void exchange_walked(const Discretization& discretization, std::span<const ElementId> rows,
                     const ExchangeOptions& options, const RowSink& sink) {
    if (options.radiance == Radiance::linear)
        make_rows<PlacedShares>(discretization, rows, options, sink);
    else
        make_rows<Shares>(discretization, rows, options, sink);
}

}  // namespace tyndall::radiosity
