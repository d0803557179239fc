#include "radiosity/cube_rows.h"

#include <fmt/format.h>

#include <optional>

#include "mesh/input_error.h"
#include "radiosity/cube_centres.h"
#include "radiosity/item_buffer.h"
#include "radiosity/row_accumulator.h"
#include "radiosity/row_batches.h"
#include "radiosity/row_scene.h"

namespace tyndall::radiosity {
namespace {

class CubeRows {
  public:
    CubeRows(const Discretization& d, const ExchangeOptions& options, const CubeKinds& kinds)
        : d_(d), options_(options), kinds_(kinds), centres_(d, options.settings, options.seed) {
        if (options.settings.projection == Projection::walked)
            scene_.emplace(d, nullptr, std::span(&options.band, 1), 0.0);
        else
            drawn_.emplace(d, options.band);
    }

    struct Scratch {
        RowAccumulator<double> sums;
        std::optional<ItemBuffer> buffer;
    };
    Scratch scratch() const {
        Scratch result{RowAccumulator<double>(d_.elements.size() + 1), std::nullopt};
        if (drawn_) result.buffer.emplace(*drawn_);
        return result;
    }

    void row(ElementId id, Scratch& scratch, FinishedRows& rows) const {
        for (std::size_t k = 0; k < centres_.count(); ++k) {
            const CubeCentre centre = centres_(id.value, k);
            if (drawn_)
                look(id, centre, scratch);
            else
                walk(id, centre, scratch.sums);
        }
        const double scale = d_.elements.capacity[id.value * d_.elements.bands + options_.band] /
                             static_cast<double>(centres_.count());
        scratch.sums.take([&](std::uint32_t column, double sum) {
            if (!(sum > 0.0)) return;
            rows.columns.push_back(column);
            rows.values.push_back(scale * sum);
        });
        rows.ends.push_back(rows.columns.size());
    }

  private:
    const std::vector<CubeFace>& faces_of(ElementId id) const {
        return d_.elements.is_patch(id.value) ? kinds_.patches : kinds_.zones;
    }

    void look(ElementId id, const CubeCentre& centre, Scratch& scratch) const {
        scratch.buffer->look_from(centre.place, centre.axes);
        for (const CubeFace& face : faces_of(id))
            scratch.buffer->project(
                face, [&](std::uint32_t column, double share) { scratch.sums.add(column, share); });
    }

    void walk(ElementId id, const CubeCentre& centre, RowAccumulator<double>& sums) const {
        double weight = 0.0;
        const auto deposit = [&](const RowLeg&, std::uint32_t column,
                                 const std::array<double, 1>& share,
                                 const auto&) { sums.add(column, weight * share[0]); };
        RowWalk<1, decltype(deposit)> walk(*scene_, deposit);
        for (const CubeFace& face : faces_of(id))
            for (std::size_t j = 0; j < face.nv; ++j)
                for (std::size_t i = 0; i < face.nu; ++i) {
                    weight = face.weights[j * face.nu + i];
                    mesh::Ray ray;
                    ray.origin = centre.place;
                    ray.direction = glm::normalize(centre.axes * face.direction(i, j));
                    const auto arrival = walk.follow(ray, centre.at);
                    if (arrival == mesh::Arrival::lost && options_.lost_rays) ++*options_.lost_rays;
                }
    }

    const Discretization& d_;
    const ExchangeOptions& options_;
    const CubeKinds& kinds_;
    CubeCentres centres_;
    std::optional<RowScene> scene_;
    std::optional<DrawnElements> drawn_;
};

}  // namespace

void rows_by_cubes(const Discretization& discretization, std::span<const ElementId> rows,
                   const ExchangeOptions& options, const RowSink& sink, const CubeKinds& kinds) {
    const CubeRows cubes(discretization, options, kinds);
    // A row is work enough for a task.
    make_row_batches(discretization, rows, options, sink, 1, cubes.scratch(),
                     [&](ElementId id, CubeRows::Scratch& scratch, FinishedRows& finished) {
                         cubes.row(id, scratch, finished);
                     });
}

void require_patches(const Discretization& d, std::span<const ElementId> rows,
                     std::string_view method, std::string_view why) {
    for (const ElementId id : rows)
        if (!d.elements.is_patch(id.value))
            throw mesh::InputError(fmt::format(
                "the exchange method \"{}\" makes rows of surfaces only, not of the medium \"{}\": "
                "{}",
                method, name_of(d.enclosure, d.forest, d.elements, id), why));
}

}  // namespace tyndall::radiosity
