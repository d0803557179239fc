#include "radiosity/exchange_walked.h"

#include "radiosity/row_walker.h"

namespace tyndall::radiosity {
namespace {

template <class Accumulator, std::size_t Bands>
void make_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, std::span<const std::size_t> bands,
               std::span<const RowSink> sinks) {
    const PointSet points(options.rays, options.settings.point_set);
    const RowWalker<Bands> walker(discretization, options, bands, points);
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
