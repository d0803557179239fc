#include "radiosity/exchange_moved.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/moving_bodies.h"
#include "radiosity/row_walker.h"

namespace tyndall::radiosity {
namespace {

// Of a squared sine, of directions in single precision.
constexpr double direction_rounding = 1e-6;

using PlacedShare = InBands<glm::dvec4, 1>;
using PlacedSums = PlacedShares<1>;

// What a row is now: kept entries, but for these; or these alone.
struct ChangedRow {
    FinishedRows entries;  // in the order of columns
    bool whole = false;
    std::size_t size = 0;  // of the row with those kept
};

class MovedRows {
  public:
    MovedRows(const Discretization& now, const RowsBefore& before, const ExchangeOptions& options,
              const PointSet& points, std::atomic<std::size_t>& walked)
        : now_(now),
          before_(before),
          options_(options),
          row_now_(now, options, std::span(&options.band, 1), points),
          row_before_(before.discretization, options, std::span(&options.band, 1), points),
          bodies_(bodies_of(before.discretization.enclosure, now.enclosure)),
          walked_(walked) {}

    ChangedRow changes(ElementId id, PlacedSums& sums) const {
        ChangedRow row;
        FinishedRows& entries = row.entries;
        if (!add_changes(id.value, sums)) {
            walked_ += options_.rays;
            row_now_.row(id, sums, std::span(&entries, 1));
            row.whole = true;
            row.size = entries.columns.size();
            return row;
        }
        const auto& columns = before_.areas.columns;
        std::size_t next = before_.areas.starts[id.value];
        const std::size_t end = before_.areas.starts[id.value + 1];
        row.size = end - next;
        sums.take([&](std::uint32_t column, const PlacedShare& of_band) {
            while (next < end && columns[next] < column) ++next;
            glm::dvec4 sum = of_band.of[0];
            const bool had = next < end && columns[next] == column;
            if (had) sum += kept(next);
            if (!(sum.x > 0.0) && !had) return;
            if (!had) ++row.size;
            // What rounding leaves below 0 is 0, and a part of the next entry.
            if (sum.x < 0.0) sum = glm::dvec4(sum.x, 0.0, 0.0, 0.0);
            entries.columns.push_back(column);
            entries.values.push_back(sum.x);
            if (!linear()) return;
            const Point place(sum.y, sum.z, sum.w);
            const Point centre = row_now_.centre(column) - row_now_.middle();
            entries.moments.push_back(sum.x > 0.0 ? place - sum.x * centre : Point(0.0));
        });
        return row;
    }

    // Into its place in the new rows. Columns that have moved are bodies', and what they have had
    // is among the changes: the moments of all that is kept are about the same points.
    void write(std::size_t i, const ChangedRow& row, ExchangeAreas& areas) const {
        const ExchangeAreas& before = before_.areas;
        const FinishedRows& entries = row.entries;
        std::size_t to = areas.starts[i], from = before.starts[i];
        const std::size_t end = row.whole ? from : before.starts[i + 1];
        const auto keep_before = [&](std::uint32_t column) {
            for (; from < end && before.columns[from] < column; ++from, ++to) {
                areas.columns[to] = before.columns[from];
                areas.values[to] = before.values[from];
                if (linear()) areas.moments[to] = before.moments[from];
            }
        };
        RowRounding rounded;
        for (std::size_t k = 0; k < entries.columns.size(); ++k, ++to) {
            const std::uint32_t column = entries.columns[k];
            keep_before(column);
            if (from < end && before.columns[from] == column) ++from;
            areas.columns[to] = column;
            areas.values[to] = rounded(entries.values[k]);
            if (linear()) areas.moments[to] = glm::vec3(entries.moments[k]);
        }
        keep_before(none);
    }

  private:
    bool linear() const { return options_.radiance == Radiance::linear; }

    // What the row changes by, with the places of the deposits; false where it is to be walked
    // anew.
    bool add_changes(std::size_t i, PlacedSums& sums) const {
        const Elements& e = now_.elements;
        if (e.is_patch(i) && mesh::on_body(now_.enclosure.mesh,
                                           FacetId(now_.forest.base_facet_side(e.patches[i]) / 2)))
            return false;
        if (row_now_.capacity(i, 0) != row_before_.capacity(i, 0)) return false;
        const Forest& forest = now_.forest;
        const auto targets =
            e.is_patch(i)
                ? targets_of(forest.centroid(e.patches[i]), forest[e.patches[i]].longest_edge)
                : targets_of(forest.centroid(e.zone(i)), forest[e.zone(i)].longest_edge);
        thread_local std::vector<std::size_t> met;
        met.clear();
        for (std::size_t k = 0; k < options_.rays; ++k) {
            if (!may_meet(targets, Direction(before_.directions[i * options_.rays + k]))) continue;
            const RayStart<1> at = row_now_.start(i, k);
            if (!meets(at.ray)) continue;
            if (!row_now_.open(i, at) || !row_before_.open(i, at)) return false;
            met.push_back(k);
        }
        const double count = weight_of_rays(i);
        if (!(count > 0.0)) return false;
        const double scale = row_now_.capacity(i, 0) / count;
        walked_ += met.size();
        for (const std::size_t k : met) {
            const RayStart<1> at = row_now_.start(i, k);
            add(row_before_, at, -scale, sums);
            add(row_now_, at, scale, sums);
        }
        return true;
    }

    // A body as an element may meet it: from the element's middle, a sphere grown by its size.
    struct Target {
        Direction to;  // the sphere's centre
        double square, radius_square;
    };

    std::vector<Target> targets_of(Point middle, double size) const {
        std::vector<Target> targets;
        for (const mesh::Body& body : bodies_) {
            const Direction to = body.centre - middle;
            const double radius = body.radius + size;
            targets.push_back({to, glm::dot(to, to), radius * radius});
        }
        return targets;
    }

    // Whether a ray meets any of them from anywhere in its element. Where rays start takes most of
    // what they cost, and most meet none.
    static bool may_meet(std::span<const Target> targets, Direction direction) {
        return std::ranges::any_of(targets, [&](const Target& target) {
            const double along = glm::dot(target.to, direction);
            const double beside = target.square * (1.0 - direction_rounding) - along * along;
            return target.square <= target.radius_square ||
                   (along > 0.0 && beside <= target.radius_square);
        });
    }

    bool meets(const mesh::Ray& ray) const {
        return std::ranges::any_of(
            bodies_, [&](const mesh::Body& body) { return mesh::meets_sphere(body, ray); });
    }

    // Of all the element's rays; each counts 1, but in media that vary.
    double weight_of_rays(std::size_t i) const {
        const Elements& e = now_.elements;
        double count = static_cast<double>(options_.rays);
        if (e.is_patch(i) ||
            !now_.enclosure.varying(now_.forest.base_tet(e.zone(i)), options_.band))
            return count;
        count = 0.0;
        for (std::size_t k = 0; k < options_.rays; ++k) count += row_now_.start(i, k).weight[0];
        return count;
    }

    // An entry of the row before, and the sum of its deposits' places.
    glm::dvec4 kept(std::size_t k) const {
        const ExchangeAreas& areas = before_.areas;
        const double value = areas.value(k);
        if (areas.moments.empty()) return {value, 0.0, 0.0, 0.0};
        const Point centre = row_before_.centre(areas.columns[k]) - row_before_.middle();
        return {value, Point(areas.moments[k]) + value * centre};
    }

    static PlacedShare placed(const glm::dvec4& share) {
        PlacedShare result(0.0);
        result.of[0] = share;
        return result;
    }

    static void add(const RowWalker<1>& rows, const RayStart<1>& at, double scale,
                    PlacedSums& sums) {
        using Values = RowWalker<1>::Values;
        const auto deposit = [&](const RowLeg& leg, std::uint32_t column, const Values& share,
                                 const Values& distance) {
            const Point place = leg.ray->origin - rows.middle() + distance[0] * leg.ray->direction;
            sums.add(column, placed(scale * at.weight[0] * share[0] * glm::dvec4(1.0, place)));
        };
        RowWalk<1, decltype(deposit)> walk(rows.scene(), deposit);
        walk.follow(at.ray, at.at);
    }

    const Discretization& now_;
    const RowsBefore& before_;
    const ExchangeOptions& options_;
    RowWalker<1> row_now_, row_before_;
    std::vector<mesh::Body> bodies_;  // before and now
    std::atomic<std::size_t>& walked_;
};

}  // namespace

std::vector<glm::vec3> ray_directions(const Discretization& d, const ExchangeOptions& options) {
    const PointSet points(options.rays, options.settings.point_set);
    const RowWalker<1> walker(d, options, std::span(&options.band, 1), points);
    std::vector<glm::vec3> directions(d.elements.size() * options.rays);
    tbb::parallel_for(std::size_t(0), d.elements.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < options.rays; ++k)
            directions[i * options.rays + k] = glm::vec3(walker.start(i, k).ray.direction);
    });
    return directions;
}

ExchangeAreas moved_rows(const Discretization& now, const RowsBefore& before,
                         const ExchangeOptions& options, std::atomic<std::size_t>& walked) {
    const std::size_t n = now.elements.size();
    const PointSet points(options.rays, options.settings.point_set);
    const MovedRows moved(now, before, options, points, walked);
    tbb::enumerable_thread_specific<PlacedSums> sums(PlacedSums(n + 1));
    std::vector<ChangedRow> rows(n);
    tbb::parallel_for(std::size_t(0), n,
                      [&](std::size_t i) { rows[i] = moved.changes(ElementId(i), sums.local()); });
    ExchangeAreas areas;
    for (const ChangedRow& row : rows) areas.starts.push_back(areas.starts.back() + row.size);
    areas.columns.resize(areas.starts.back());
    areas.values.resize(areas.starts.back());
    if (options.radiance == Radiance::linear) {
        areas.moments.resize(areas.starts.back());
        areas.gradients =
            std::make_shared<const ElementGradients>(now.enclosure, now.forest, now.elements);
    }
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        moved.write(i, rows[i], areas);
        rows[i] = {};
    });
    report(options.progress, {"exchange areas", 1.0, n, 0.0});
    return areas;
}

}  // namespace tyndall::radiosity
