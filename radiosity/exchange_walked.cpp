#include "radiosity/exchange_walked.h"

#include <algorithm>
#include <array>
#include <glm/vec4.hpp>
#include <numbers>

#include "radiosity/point_set.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_batches.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {
namespace {

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
class Walker {
  public:
    using Values = std::array<double, Bands>;

    Walker(const Discretization& d, const ExchangeOptions& options,
           std::span<const std::size_t> bands, const PointSet& points)
        : d_(d),
          options_(options),
          bands_(bands),
          points_(points),
          scene_(d, options.levels, bands,
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

    void row(ElementId id, Shares<Bands>& sums, std::span<FinishedRows> rows) const {
        InBands<double, Bands> shares(0.0);
        Values kept{};
        const Values count =
            follow(id.value, [&](const RayStart<Bands>& start, std::uint32_t column,
                                 const Values& share, const Values&) {
                for (std::size_t b = 0; b < Bands; ++b) {
                    shares.of[b] = start.weight[b] * share[b];
                    kept[b] += shares.of[b];
                }
                sums.add(column, shares);
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
        const Values count =
            follow(id.value, [&](const RayStart<Bands>& start, std::uint32_t column,
                                 const Values& share, const Values& at) {
                for (std::size_t b = 0; b < Bands; ++b) {
                    const Point place = start.ray.origin - middle_ + at[b] * start.ray.direction;
                    const double counts = start.weight[b] * share[b];
                    shares.of[b] = counts * glm::dvec4(1.0, place);
                    kept[b] += counts;
                }
                sums.add(column, shares);
            });
        const Values scale = scales_of(id.value, kept, count, rows);
        sums.take([&](std::uint32_t column, const InBands<glm::dvec4, Bands>& sums_of) {
            for (std::size_t b = 0; b < Bands; ++b) {
                const glm::dvec4& sum = sums_of.of[b];
                if (!(sum.x > 0.0)) continue;
                rows[b].columns.push_back(column);
                rows[b].values.push_back(scale[b] * sum.x);
                const Point place(sum.y, sum.z, sum.w);
                rows[b].moments.push_back(scale[b] *
                                          (place - sum.x * (centres_[column] - middle_)));
            }
        });
        for (FinishedRows& of_band : rows) of_band.ends.push_back(of_band.columns.size());
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    // deposit(start, column, shares, distances) for all the rays of an element. Returns the sum of
    // their weights.
    template <class Deposit>
    Values follow(std::size_t i, Deposit&& deposit) const {
        const std::uint64_t seed = hash_seed(options_.seed, i);
        RayStart<Bands> start;
        Values count{};
        const auto pass_on = [&](std::uint32_t column, const Values& shares,
                                 const Values& distances) {
            deposit(start, column, shares, distances);
        };
        RowWalk<Bands, decltype(pass_on)> walk(scene_, pass_on);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            start = start_of(i, points_(k, seed));
            for (std::size_t b = 0; b < Bands; ++b) count[b] += start.weight[b];
            if (radius() > 0.0) start.ray.length = radius();
            const auto arrival = walk.follow(start.ray, start.at);
            if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
        }
        return count;
    }

    double radius() const { return options_.settings.interaction_radius; }

    // What a share counts [m^2]; `kept`: shares of all rays that were deposited, `count` their
    // weights. What gets beyond the radius counts as if it were spread like the rest. Where nothing
    // is within the radius, or nothing where rays start, what is beyond is taken to shine as the
    // element itself.
    Values scales_of(std::size_t i, const Values& kept, const Values& count,
                     std::span<FinishedRows> rows) const {
        Values scale;
        for (std::size_t b = 0; b < Bands; ++b) {
            const double capacity = d_.elements.capacity[i * d_.elements.bands + bands_[b]];
            const double all = radius() > 0.0 ? kept[b] : count[b];
            scale[b] = all > 0.0 ? capacity / all : 0.0;
            if (scale[b] == 0.0 && capacity > 0.0) add_itself(i, capacity, rows[b]);
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
        const std::uint32_t facet_side = forest.base_facet_side(patch);
        return {ray,
                mesh::start_on(d_.enclosure.mesh, FacetId(facet_side / 2),
                               facet_side % 2 ? Side::back : Side::front),
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
    std::vector<Point> centres_;  // of columns, for moments
};

template <class Accumulator, std::size_t Bands>
void make_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, std::span<const std::size_t> bands,
               std::span<const RowSink> sinks) {
    const PointSet points(options.rays, options.settings.point_set);
    const Walker<Bands> walker(discretization, options, bands, points);
    const std::size_t columns =
        options.levels ? options.levels->columns() : discretization.elements.size() + 1;
    // Neighbours walk through the same part of the trees: a task makes a run of rows, where there
    // are enough of them; fewer of several bands, which would take memory.
    const std::size_t run = std::clamp<std::size_t>(rows.size() / 64, 1, 32 / Bands);
    make_row_batches(discretization, rows, options, sinks, run, Accumulator(columns),
                     [&](ElementId id, Accumulator& sums, std::span<FinishedRows> finished) {
                         walker.row(id, sums, finished);
                     });
}

template <std::size_t Bands>
void make_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, std::span<const std::size_t> bands,
               std::span<const RowSink> sinks) {
    if (options.radiance == Radiance::linear)
        make_rows<PlacedShares<Bands>, Bands>(discretization, rows, options, bands, sinks);
    else
        make_rows<Shares<Bands>, Bands>(discretization, rows, options, bands, sinks);
}

}  // namespace

void exchange_walked(const Discretization& discretization, std::span<const ElementId> rows,
                     const ExchangeOptions& options, const RowSink& sink) {
    make_rows<1>(discretization, rows, options, std::span(&options.band, 1), std::span(&sink, 1));
}

void exchange_walked_bands(const Discretization& discretization, std::span<const ElementId> rows,
                           const ExchangeOptions& options, std::span<const std::size_t> bands,
                           std::span<const RowSink> sinks) {
    // A number of bands that the compiler knows keeps their sums in vectors.
    while (!bands.empty()) {
        const std::size_t together = bands.size() >= 8 ? 8 : std::min<std::size_t>(bands.size(), 4);
        const auto make = together == 8   ? make_rows<8>
                          : together == 4 ? make_rows<4>
                          : together == 3 ? make_rows<3>
                          : together == 2 ? make_rows<2>
                                          : make_rows<1>;
        make(discretization, rows, options, bands.first(together), sinks.first(together));
        bands = bands.subspan(together);
        sinks = sinks.subspan(together);
    }
}

}  // namespace tyndall::radiosity
