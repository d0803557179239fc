#include "radiosity/exchange_walked.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

struct Row {
    std::vector<std::uint32_t> columns;
    std::vector<double> values;
};

// A dense row with a list of what was touched: clearing it all for every receiver would be O(N²).
class Accumulator {
  public:
    explicit Accumulator(std::size_t size) : values_(size, 0.0) {}

    void add(std::uint32_t column, double value) {
        if (values_[column] == 0.0) touched_.push_back(column);
        values_[column] += value;
    }

    Row take(double scale) {
        std::sort(touched_.begin(), touched_.end());
        touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
        Row row;
        row.columns = touched_;
        for (const auto column : touched_) {
            row.values.push_back(scale * values_[column]);
            values_[column] = 0.0;
        }
        touched_.clear();
        return row;
    }

  private:
    std::vector<double> values_;
    std::vector<std::uint32_t> touched_;
};

class Walker {
  public:
    Walker(const Discretization& d, const ExchangeOptions& options, const PointSet& points)
        : d_(d), options_(options), points_(points) {}

    Row row(ElementId id, Accumulator& accumulator) const {
        const std::size_t i = id.value;
        const std::uint64_t seed = hash_seed(options_.seed, i);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            auto u = points_(k, seed);
            const std::uint32_t member = d_.elements.pick_member(i, u[0]);
            if (d_.elements.is_patch(i))
                walk_from_patch(PatchId(member), u, accumulator);
            else
                walk_from_zone(ZoneId(member), u, accumulator);
        }
        const double capacity = d_.elements.capacity[i * d_.elements.bands + options_.band];
        return accumulator.take(capacity / static_cast<double>(points_.size()));
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    void walk_from_patch(PatchId patch, const Numbers& u, Accumulator& accumulator) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[patch].corners;
        const auto w = uniform_in_triangle(u[0], u[1]);
        mesh::Ray ray;
        ray.origin =
            w[0] * forest.point(c[0]) + w[1] * forest.point(c[1]) + w[2] * forest.point(c[2]);
        ray.direction = cosine_direction(normal_of(forest, patch), u[3], u[4]);
        const std::uint32_t facet_side = forest.base_facet_side(patch);
        deposit(ray,
                mesh::start_on(d_.enclosure.mesh, FacetId(facet_side / 2),
                               facet_side % 2 ? Side::back : Side::front),
                accumulator);
    }

    void walk_from_zone(ZoneId zone, const Numbers& u, Accumulator& accumulator) const {
        const Forest& forest = d_.forest;
        const auto& c = forest[zone].corners;
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        mesh::Ray ray;
        ray.origin = Point(0.0);
        for (int k = 0; k < 4; ++k) ray.origin += w[k] * forest.point(c[k]);
        ray.direction = uniform_direction(u[3], u[4]);
        deposit(ray, {forest.base_tet(zone)}, accumulator);
    }

    void deposit(const mesh::Ray& ray, mesh::WalkStart start, Accumulator& accumulator) const {
        const Elements& elements = d_.elements;
        double transmittance = 1.0;
        const auto end =
            mesh::walk(d_.enclosure.mesh, ray, start, [&](TetId tet, double t_in, double t_out) {
                const double extinction = d_.enclosure.extinction(tet, options_.band);
                if (extinction == 0.0) return true;
                const auto at_element = [&](ZoneId zone, double) {
                    return elements.of_zone[zone.value] != none;
                };
                return mesh::descend(d_.forest, mesh::root_zone(tet), ray, t_in, t_out, at_element,
                                     [&](ZoneId zone, double s_in, double s_out) {
                                         // −expm1: the difference of two exponentials loses digits
                                         // when thin.
                                         const double share =
                                             -transmittance *
                                             std::expm1(-extinction * (s_out - s_in));
                                         accumulator.add(elements.of_zone[zone.value], share);
                                         transmittance -= share;
                                         return true;
                                     });
            });
        accumulator.add(arrival(end, ray), transmittance);
    }

    std::uint32_t arrival(const mesh::WalkEnd& end, const mesh::Ray& ray) const {
        const auto outside = static_cast<std::uint32_t>(d_.elements.outside());
        if (end.arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
        if (end.arrival != mesh::Arrival::struck) return outside;
        const PatchId root = mesh::root_patch(end.facet, end.side);
        if (const auto element = d_.elements.of_patch[root.value]; element != none) return element;
        const PatchId leaf = d_.forest.leaf_at(root, ray.origin + end.distance * ray.direction);
        return d_.elements.of_patch[leaf.value];
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    const PointSet& points_;
};

}  // namespace

void exchange_walked(const Discretization& discretization, std::span<const ElementId> rows,
                     const ExchangeOptions& options, const RowSink& sink) {
    const PointSet points(options.rays);
    const Walker walker(discretization, options, points);
    tbb::enumerable_thread_specific<Accumulator> accumulators(discretization.elements.size() + 1);
    // In batches, so that rows arrive in order and memory stays small.
    constexpr std::size_t batch = 2048;
    std::vector<Row> finished;
    for (std::size_t begin = 0; begin < rows.size(); begin += batch) {
        const std::size_t end = std::min(begin + batch, rows.size());
        finished.assign(end - begin, {});
        tbb::parallel_for(begin, end, [&](std::size_t k) {
            finished[k - begin] = walker.row(rows[k], accumulators.local());
        });
        for (std::size_t k = begin; k < end; ++k)
            sink(rows[k], finished[k - begin].columns, finished[k - begin].values);
        if (options.progress)
            options.progress({"exchange areas", double(end) / double(rows.size()),
                              discretization.elements.size(), 0.0});
    }
}

}  // namespace tyndall::radiosity
