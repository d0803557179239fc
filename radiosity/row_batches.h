// Rows made in parallel and handed over in order, a batch at a time: what the methods that make
// whole rows share.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// Rows that one task makes, one after the other.
struct FinishedRows {
    std::vector<std::size_t> ends;
    std::vector<std::uint32_t> columns;
    std::vector<double> values;      // [m^2]
    std::vector<Direction> moments;  // of the entries, or none [m^3]

    void clear() {
        ends.clear();
        columns.clear();
        values.clear();
        moments.clear();
    }
};

// make(element, scratch, finished) appends one row; scratch is a thread's own, copied from
// `scratch` when the thread first needs one. A task makes `run` rows, a batch is 128 tasks. A row
// must not depend on what its scratch was used for before: then rows are the same at any number of
// threads.
template <class Scratch, class Make>
void make_row_batches(const Discretization& discretization, std::span<const ElementId> rows,
                      const ExchangeOptions& options, const RowSink& sink, std::size_t run,
                      const Scratch& scratch, Make&& make) {
    tbb::enumerable_thread_specific<Scratch> scratches(scratch);
    const std::size_t batch = 128 * run;
    std::vector<FinishedRows> finished(128);
    for (std::size_t begin = 0; begin < rows.size(); begin += batch) {
        const std::size_t end = std::min(begin + batch, rows.size());
        const std::size_t runs = (end - begin + run - 1) / run;
        tbb::parallel_for(std::size_t(0), runs, [&](std::size_t r) {
            auto& local = scratches.local();
            finished[r].clear();
            for (std::size_t k = begin + r * run; k < std::min(end, begin + (r + 1) * run); ++k)
                make(rows[k], local, finished[r]);
        });
        for (std::size_t r = 0; r < runs; ++r) {
            std::size_t first = 0;
            for (std::size_t k = 0; k < finished[r].ends.size(); ++k) {
                const std::size_t count = finished[r].ends[k] - first;
                const auto of_row = [&](const auto& values) {
                    return std::span(values).subspan(std::min(first, values.size()),
                                                     values.empty() ? 0 : count);
                };
                sink({rows[begin + r * run + k], of_row(finished[r].columns),
                      of_row(finished[r].values), of_row(finished[r].moments)});
                first += count;
            }
        }
        if (options.progress)
            options.progress({"exchange areas", double(end) / double(rows.size()),
                              discretization.elements.size(), 0.0});
    }
}

}  // namespace tyndall::radiosity
