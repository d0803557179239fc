#include "radiosity/exchange_walked.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>

#include "radiosity/point_set.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {
namespace {

// Rows that one task makes, one after the other.
struct Rows {
    std::vector<std::size_t> ends;
    std::vector<std::uint32_t> columns;
    std::vector<double> values;

    void clear() {
        ends.clear();
        columns.clear();
        values.clear();
    }
};

struct RayStart {
    mesh::Ray ray;
    mesh::WalkStart at;
};

class Walker {
  public:
    Walker(const Discretization& d, const ExchangeOptions& options, const PointSet& points)
        : d_(d),
          options_(options),
          points_(points),
          scene_(d, options.levels, options.band,
                 options.detail *
                     std::sqrt(4.0 * std::numbers::pi / static_cast<double>(points.size()))) {}

    void row(ElementId id, RowAccumulator& accumulator, Rows& rows) const {
        const std::size_t i = id.value;
        const std::uint64_t seed = hash_seed(options_.seed, i);
        RowWalk walk(scene_,
                     [&](std::uint32_t column, double share) { accumulator.add(column, share); });
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const RayStart start = start_of(i, points_(k, seed));
            const auto arrival = walk.follow(start.ray, start.at);
            if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
        }
        const double capacity = d_.elements.capacity[i * d_.elements.bands + options_.band];
        const double scale = capacity / static_cast<double>(points_.size());
        accumulator.take([&](std::uint32_t column, double sum) {
            if (!(sum > 0.0)) return;  // nothing was left when the ray came there
            rows.columns.push_back(column);
            rows.values.push_back(scale * sum);
        });
        rows.ends.push_back(rows.columns.size());
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

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
        return {ray, {forest.base_tet(zone)}};
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    const PointSet& points_;
    RowScene scene_;
};

}  // namespace

void exchange_walked(const Discretization& discretization, std::span<const ElementId> rows,
                     const ExchangeOptions& options, const RowSink& sink) {
    const PointSet points(options.rays);
    const Walker walker(discretization, options, points);
    const std::size_t columns =
        options.levels ? options.levels->columns() : discretization.elements.size() + 1;
    tbb::enumerable_thread_specific<RowAccumulator> accumulators(columns);
    // In batches, so that rows arrive in order and memory stays small; a task makes a run of rows,
    // which are neighbours and walk through the same part of the trees.
    constexpr std::size_t run = 32, batch = 128 * run;
    std::vector<Rows> finished(batch / run);
    for (std::size_t begin = 0; begin < rows.size(); begin += batch) {
        const std::size_t end = std::min(begin + batch, rows.size());
        const std::size_t runs = (end - begin + run - 1) / run;
        tbb::parallel_for(std::size_t(0), runs, [&](std::size_t r) {
            auto& accumulator = accumulators.local();
            finished[r].clear();
            for (std::size_t k = begin + r * run; k < std::min(end, begin + (r + 1) * run); ++k)
                walker.row(rows[k], accumulator, finished[r]);
        });
        for (std::size_t r = 0; r < runs; ++r) {
            std::size_t first = 0;
            for (std::size_t k = 0; k < finished[r].ends.size(); ++k) {
                const std::size_t count = finished[r].ends[k] - first;
                sink(rows[begin + r * run + k],
                     std::span(finished[r].columns).subspan(first, count),
                     std::span(finished[r].values).subspan(first, count));
                first += count;
            }
        }
        if (options.progress)
            options.progress({"exchange areas", double(end) / double(rows.size()),
                              discretization.elements.size(), 0.0});
    }
}

}  // namespace tyndall::radiosity
