// The rays that rows are walked by (exchange_walked.h): where each starts, and what it deposits.
#pragma once

#include <algorithm>
#include <array>
#include <glm/vec4.hpp>
#include <numbers>

#include "radiosity/open_places.h"
#include "radiosity/point_set.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_batches.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {

// A value in each band.
template <class Value, std::size_t Bands>
struct InBands {
    explicit InBands(double value) { of.fill(Value(value)); }
    InBands& operator+=(const InBands& other) {
        for (std::size_t b = 0; b < Bands; ++b) of[b] += other.of[b];
        return *this;
    }
    std::array<Value, Bands> of;
};

template <std::size_t Bands>
struct RayStart {
    mesh::Ray ray;
    mesh::WalkStart at;
    std::array<double, Bands> weight;  // what the ray counts beside the element's others
};

// Sums of shares, and with their places: (share, share × place from the hull's middle).
template <std::size_t Bands>
using Shares = RowAccumulator<InBands<double, Bands>>;
template <std::size_t Bands>
using PlacedShares = RowAccumulator<InBands<glm::dvec4, Bands>>;

// Walks the rows of several bands at once.
template <std::size_t Bands>
class RowWalker {
  public:
    using Values = std::array<double, Bands>;

    RowWalker(const Discretization& d, const ExchangeOptions& options,
              std::span<const std::size_t> bands, const PointSet& points)
        : d_(d),
          options_(options),
          bands_(bands),
          points_(points),
          scene_(d, options.levels, bands,
                 options.detail *
                     std::sqrt(4.0 * std::numbers::pi / static_cast<double>(points.size()))),
          middle_(0.5 * (d.enclosure.mesh.hull_min + d.enclosure.mesh.hull_max)),
          spread_(options.settings.interaction_radius > 0.0 || d.enclosure.has_mirrors()) {
        if (options.radiance == Radiance::constant) return;
        for (const PatchId patch : d.elements.patches)
            centres_.push_back(centre_of(d.enclosure, d.forest, patch));
        for (const ZoneId zone : d.elements.zones)
            centres_.push_back(centre_of(d.enclosure, d.forest, zone));
        centres_.push_back(middle_);  // outside
    }

    void row(ElementId id, Shares<Bands>& sums, std::span<FinishedRows> rows) const {
        InBands<double, Bands> shares(0.0);
        Values kept{};
        const Values count = follow(id.value, [&](const Deposited& at, std::uint32_t column,
                                                  const Values& share, const Values&) {
            for (std::size_t b = 0; b < Bands; ++b) {
                shares.of[b] = at.start.weight[b] * share[b];
                kept[b] += shares.of[b];
            }
            if (counts(at.leg)) sums.add(column, shares);
        });
        const Values scale = scales_of(id.value, kept, count, rows);
        sums.take([&](std::uint32_t column, const InBands<double, Bands>& sum) {
            for (std::size_t b = 0; b < Bands; ++b) {
                if (!(sum.of[b] > 0.0)) continue;  // nothing was left when the ray came there
                rows[b].columns.push_back(column);
                rows[b].values.push_back(scale[b] * sum.of[b]);
            }
        });
        for (FinishedRows& of_band : rows) of_band.ends.push_back(of_band.columns.size());
    }

    void row(ElementId id, PlacedShares<Bands>& sums, std::span<FinishedRows> rows) const {
        InBands<glm::dvec4, Bands> shares(0.0);
        Values kept{};
        const Values count = follow(id.value, [&](const Deposited& at, std::uint32_t column,
                                                  const Values& share, const Values& distance) {
            for (std::size_t b = 0; b < Bands; ++b) {
                const Point place =
                    at.leg.ray->origin - middle_ + distance[b] * at.leg.ray->direction;
                const double counts = at.start.weight[b] * share[b];
                shares.of[b] = counts * glm::dvec4(1.0, place);
                kept[b] += counts;
            }
            if (counts(at.leg)) sums.add(column, shares);
        });
        const Values scale = scales_of(id.value, kept, count, rows);
        sums.take([&](std::uint32_t column, const InBands<glm::dvec4, Bands>& sums_of) {
            for (std::size_t b = 0; b < Bands; ++b) {
                const glm::dvec4& sum = sums_of.of[b];
                if (!(sum.x > 0.0)) continue;
                rows[b].columns.push_back(column);
                rows[b].values.push_back(scale[b] * sum.x);
                if (centres_.empty()) continue;
                const Point place(sum.y, sum.z, sum.w);
                rows[b].moments.push_back(scale[b] *
                                          (place - sum.x * (centres_[column] - middle_)));
            }
        });
        for (FinishedRows& of_band : rows) of_band.ends.push_back(of_band.columns.size());
    }

    Point middle() const { return middle_; }
    // Of a column, where there are moments.
    Point centre(std::uint32_t column) const { return centres_[column]; }
    const RowScene& scene() const { return scene_; }

    // A ray of an element, as it starts.
    RayStart<Bands> start(std::size_t i, std::size_t ray) const {
        return start_of(i, points_(ray, hash_seed(options_.seed, i)));
    }
    // Whether light can be where a ray of an element starts.
    bool open(std::size_t i, const RayStart<Bands>& at) const {
        const Enclosure& e = d_.enclosure;
        if (e.mesh.bodies.empty()) return true;
        if (!d_.elements.is_patch(i)) return !covered(e, at.ray.origin);
        return !e.solid(at.at.tet) &&
               !covered(e, at.ray.origin, normal_of(d_.forest, d_.elements.patches[i]));
    }
    double capacity(std::size_t i, std::size_t b) const {
        return d_.elements.capacity[i * d_.elements.bands + bands_[b]];
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    // By which ray a deposit is made, and on which part of its way.
    struct Deposited {
        const RayStart<Bands>& start;
        const RowLeg& leg;
    };
    // Whether it is of the legs that are asked for.
    bool counts(const RowLeg& leg) const {
        return options_.legs == RowLegs::all || (leg.in_mirror && leg.on_patch);
    }

    // deposit(deposited, column, shares, distances) for all the rays of an element. Returns the sum
    // of their weights.
    template <class Deposit>
    Values follow(std::size_t i, Deposit&& deposit) const {
        const std::uint64_t seed = hash_seed(options_.seed, i);
        RayStart<Bands> start;
        Values count{};
        const auto pass_on = [&](const RowLeg& leg, std::uint32_t column, const Values& shares,
                                 const Values& distances) {
            deposit({start, leg}, column, shares, distances);
        };
        RowWalk<Bands, decltype(pass_on)> walk(scene_, pass_on);
        const bool bodies = !d_.enclosure.mesh.bodies.empty();
        bool any = false;
        // What a body covers altogether has the light that is just beside it.
        for (const bool beside : {false, true}) {
            if (beside && (any || !bodies || d_.elements.is_patch(i))) break;
            for (std::size_t k = 0; k < points_.size(); ++k) {
                start = start_of(i, points_(k, seed));
                if (beside) move_beside(start);
                if (bodies && !open(i, start)) continue;
                any = true;
                for (std::size_t b = 0; b < Bands; ++b) count[b] += start.weight[b];
                if (radius() > 0.0) start.ray.length = radius();
                const auto arrival = walk.follow(start.ray, start.at);
                if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
            }
        }
        return count;
    }

    void move_beside(RayStart<Bands>& start) const {
        const OpenPlace there = open_place(d_.enclosure, start.ray.origin, start.at.tet);
        start.ray.origin = there.x;
        start.at = {there.tet};
    }

    double radius() const { return options_.settings.interaction_radius; }

    // What a share counts [m^2]; `kept`: shares of all rays that were deposited, `count` their
    // weights. What gets beyond the radius, and what little is left after many mirrors, counts as
    // if it were spread like the rest. Where nothing
    // is within the radius, or nothing where rays start, what is beyond is taken to shine as the
    // element itself.
    Values scales_of(std::size_t i, const Values& kept, const Values& count,
                     std::span<FinishedRows> rows) const {
        Values scale;
        for (std::size_t b = 0; b < Bands; ++b) {
            const double all = spread_ ? kept[b] : count[b];
            scale[b] = all > 0.0 ? capacity(i, b) / all : 0.0;
            if (scale[b] == 0.0 && capacity(i, b) > 0.0) add_itself(i, capacity(i, b), rows[b]);
        }
        return scale;
    }

    void add_itself(std::size_t i, double capacity, FinishedRows& rows) const {
        rows.columns.push_back(static_cast<std::uint32_t>(i));
        rows.values.push_back(capacity);
        if (options_.radiance == Radiance::linear) rows.moments.push_back(Direction(0.0));
    }

    RayStart<Bands> start_of(std::size_t i, Numbers u) const {
        const std::uint32_t member = d_.elements.pick_member(i, u[0]);
        return d_.elements.is_patch(i) ? on_patch(PatchId(member), u) : in_zone(ZoneId(member), u);
    }

    RayStart<Bands> on_patch(PatchId patch, const Numbers& u) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[patch].corners;
        const auto w = uniform_in_triangle(u[0], u[1]);
        mesh::Ray ray;
        ray.origin =
            w[0] * forest.point(c[0]) + w[1] * forest.point(c[1]) + w[2] * forest.point(c[2]);
        ray.direction = cosine_direction(normal_of(forest, patch), u[3], u[4]);
        return {ray,
                mesh::start_before(d_.enclosure.mesh, forest.base_facet_side(patch), ray.origin),
                all_alike()};
    }

    RayStart<Bands> in_zone(ZoneId zone, const Numbers& u) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[zone].corners;
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        mesh::Ray ray;
        ray.origin = Point(0.0);
        for (int k = 0; k < 4; ++k) ray.origin += w[k] * forest.point(c[k]);
        ray.direction = uniform_direction(u[3], u[4]);
        const TetId tet = forest.base_tet(zone);
        RayStart<Bands> start{ray, {tet}, all_alike()};
        if (!d_.enclosure.varying(tet, bands_[0])) return start;
        // Origins are uniform, and count as much as they are dense: as if distributed as κ.
        for (std::size_t b = 0; b < Bands; ++b)
            start.weight[b] = std::max(d_.enclosure.varying(tet, bands_[b])->at(ray.origin),
                                       least_density * d_.enclosure.extinction(tet, bands_[b]));
        return start;
    }

    static Values all_alike() {
        Values weights;
        weights.fill(1.0);
        return weights;
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    std::span<const std::size_t> bands_;
    const PointSet& points_;
    RowScene scene_;
    Point middle_;                // of the hull
    bool spread_;                 // rays may leave something undeposited
    std::vector<Point> centres_;  // of columns, for moments
};

}  // namespace tyndall::radiosity
