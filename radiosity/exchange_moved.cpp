#include "radiosity/exchange_moved.h"

#include <algorithm>

#include "radiosity/row_walker.h"

namespace tyndall::radiosity {
namespace {

// Rows that a task makes. Much is copied and little computed: what a batch of tasks makes should
// fit into a cache, or nearly.
constexpr std::size_t longest_run = 4;

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
          walked_(walked) {}

    void row(ElementId id, PlacedSums& sums, FinishedRows& rows) const {
        if (!add_changes(id.value, sums)) {
            walked_ += options_.rays;
            row_now_.row(id, sums, std::span(&rows, 1));
            return;
        }
        // Kept entries and changes are both in the order of columns.
        std::size_t next = before_.areas.starts[id.value];
        const std::size_t end = before_.areas.starts[id.value + 1];
        sums.take([&](std::uint32_t column, const PlacedShare& of_band) {
            for (; next < end && before_.areas.columns[next] < column; ++next) copy(next, rows);
            glm::dvec4 sum = of_band.of[0];
            if (next < end && before_.areas.columns[next] == column) sum += kept(next++);
            if (!(sum.x > 0.0)) return;
            rows.columns.push_back(column);
            rows.values.push_back(sum.x);
            if (!linear()) return;
            const Point place(sum.y, sum.z, sum.w);
            rows.moments.push_back(place - sum.x * (row_now_.centre(column) - row_now_.middle()));
        });
        for (; next < end; ++next) copy(next, rows);
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
        thread_local std::vector<std::size_t> met;
        met.clear();
        double count = 0.0;
        for (std::size_t k = 0; k < options_.rays; ++k) {
            const RayStart<1> at = row_now_.start(i, k);
            count += at.weight[0];
            if (!meets(now_.enclosure, at.ray) && !meets(before_.discretization.enclosure, at.ray))
                continue;
            if (!row_now_.open(i, at) || !row_before_.open(i, at)) return false;
            met.push_back(k);
        }
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

    static bool meets(const Enclosure& enclosure, const mesh::Ray& ray) {
        return std::ranges::any_of(enclosure.mesh.bodies, [&](const mesh::Body& body) {
            return mesh::meets_sphere(body, ray);
        });
    }

    // An entry of the row before, and the sum of its deposits' places.
    glm::dvec4 kept(std::size_t k) const {
        const ExchangeAreas& areas = before_.areas;
        const double value = areas.value(k);
        if (areas.moments.empty()) return {value, 0.0, 0.0, 0.0};
        const Point centre = row_before_.centre(areas.columns[k]) - row_before_.middle();
        return {value, Point(areas.moments[k]) + value * centre};
    }

    void copy(std::size_t k, FinishedRows& rows) const {
        const ExchangeAreas& areas = before_.areas;
        const auto column = areas.columns[k];
        const double value = areas.value(k);
        if (!(value > 0.0)) return;
        rows.columns.push_back(column);
        rows.values.push_back(value);
        if (linear())
            rows.moments.push_back(Direction(areas.moments[k]) +
                                   value * (row_before_.centre(column) - row_now_.centre(column)));
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
    std::atomic<std::size_t>& walked_;
};

}  // namespace

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
