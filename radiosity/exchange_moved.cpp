#include "radiosity/exchange_moved.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/row_walker.h"

namespace tyndall::radiosity {
namespace {

// Rows that a task makes. Much is copied and little computed: what a batch of tasks makes should
// fit into a cache, or nearly.
constexpr std::size_t longest_run = 4;

// Of a squared sine, of directions in single precision.
constexpr double direction_rounding = 1e-6;

using PlacedShare = InBands<glm::dvec4, 1>;
using PlacedSums = PlacedShares<1>;

class MovedRows {
  public:
    MovedRows(const Discretization& now, const RowsBefore& before, const ExchangeOptions& options,
              const PointSet& points, std::atomic<std::size_t>& walked)
        : now_(now),
          before_(before),
          options_(options),
          row_now_(now, options, std::span(&options.band, 1), points),
          row_before_(before.discretization, options, std::span(&options.band, 1), points),
          walked_(walked) {
        for (const Enclosure* e : {&before.discretization.enclosure, &now.enclosure})
            bodies_.insert(bodies_.end(), e->mesh.bodies.begin(), e->mesh.bodies.end());
        for (std::uint32_t c = 0; linear() && c <= now.elements.size(); ++c)
            moves_.push_back(row_before_.centre(c) != row_now_.centre(c));
    }

    void row(ElementId id, PlacedSums& sums, FinishedRows& rows) const {
        if (!add_changes(id.value, sums)) {
            walked_ += options_.rays;
            row_now_.row(id, sums, std::span(&rows, 1));
            return;
        }
        // Kept entries and changes are both in the order of columns.
        const auto& columns = before_.areas.columns;
        std::size_t next = before_.areas.starts[id.value];
        const std::size_t end = before_.areas.starts[id.value + 1];
        sums.take([&](std::uint32_t column, const PlacedShare& of_band) {
            std::size_t first = next;
            while (next < end && columns[next] < column) ++next;
            copy(first, next, rows);
            glm::dvec4 sum = of_band.of[0];
            if (next < end && columns[next] == column) sum += kept(next++);
            if (!(sum.x > 0.0)) return;
            rows.columns.push_back(column);
            rows.values.push_back(sum.x);
            if (!linear()) return;
            const Point place(sum.y, sum.z, sum.w);
            rows.moments.push_back(place - sum.x * (row_now_.centre(column) - row_now_.middle()));
        });
        copy(next, end, rows);
        rows.ends.push_back(rows.columns.size());
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

    // Entries of the row before.
    void copy(std::size_t first, std::size_t end, FinishedRows& rows) const {
        const ExchangeAreas& areas = before_.areas;
        const auto part = [&](const auto& all) {
            return std::span(all).subspan(first, end - first);
        };
        const auto columns = part(areas.columns);
        const auto values = part(areas.values);
        rows.columns.insert(rows.columns.end(), columns.begin(), columns.end());
        rows.values.insert(rows.values.end(), values.begin(), values.end());
        if (!linear()) return;
        const auto moments = part(areas.moments);
        rows.moments.insert(rows.moments.end(), moments.begin(), moments.end());
        Direction* const copied = rows.moments.data() + (rows.moments.size() - moments.size());
        for (std::size_t k = 0; k < columns.size(); ++k)
            if (const auto column = columns[k]; moves_[column])
                copied[k] += static_cast<double>(values[k]) *
                             (row_before_.centre(column) - row_now_.centre(column));
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
    std::vector<bool> moves_;         // columns' centres do; where there are moments
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
    ExchangeAreas areas;
    areas.starts.reserve(before.areas.starts.size());
    areas.columns.reserve(before.areas.columns.size() + before.areas.columns.size() / 10);
    areas.values.reserve(areas.columns.capacity());
    areas.moments.reserve(before.areas.moments.empty() ? 0 : areas.columns.capacity());
    if (options.radiance == Radiance::linear)
        areas.gradients =
            std::make_shared<const ElementGradients>(now.enclosure, now.forest, now.elements);
    std::vector<ElementId> rows;
    for (std::size_t i = 0; i < now.elements.size(); ++i) rows.push_back(ElementId(i));
    const PointSet points(options.rays, options.settings.point_set);
    const MovedRows moved(now, before, options, points, walked);
    const std::size_t run = std::clamp<std::size_t>(rows.size() / 64, 1, longest_run);
    make_row_batches(
        now, rows, options, [&](const Row& row) { append(areas, row, Precision::single_sums); },
        run, PlacedSums(now.elements.size() + 1),
        [&](ElementId id, PlacedSums& sums, FinishedRows& finished) {
            moved.row(id, sums, finished);
        });
    return areas;
}

}  // namespace tyndall::radiosity
