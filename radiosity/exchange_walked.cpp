#include "radiosity/exchange_walked.h"

#include "radiosity/row_walker.h"

namespace tyndall::radiosity {
namespace {

template <class Accumulator>
void make_rows(const Discretization& discretization, std::span<const ElementId> rows,
               const ExchangeOptions& options, const RowSink& sink) {
    const PointSet points(options.rays, options.settings.point_set);
    const RowWalker walker(discretization, options, points);
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
