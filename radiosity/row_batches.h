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

// To the sink, in order; the first is that of rows[0].
inline void hand_over(const FinishedRows& finished, std::span<const ElementId> rows,
                      const RowSink& sink) {
    std::size_t first = 0;
    for (std::size_t k = 0; k < finished.ends.size(); ++k) {
        const std::size_t count = finished.ends[k] - first;
        const auto of_row = [&](const auto& values) {
            return std::span(values).subspan(std::min(first, values.size()),
                                             values.empty() ? 0 : count);
        };
        sink(
            {rows[k], of_row(finished.columns), of_row(finished.values), of_row(finished.moments)});
        first += count;
    }
}

// make(element, scratch, finished) appends one row to each of `finished`, one a sink, of which
// there may be several where rows of several bands are made at once; scratch is a thread's own,
// copied from `scratch` when the thread first needs one. A task makes `run` rows, a batch is 128
// tasks. A row must not depend on what its scratch was used for before: then rows are the same at
// any number of threads.
template <class Scratch, class Make>
void make_row_batches(const Discretization& discretization, std::span<const ElementId> rows,
                      const ExchangeOptions& options, std::span<const RowSink> sinks,
                      std::size_t run, const Scratch& scratch, Make&& make) {
    tbb::enumerable_thread_specific<Scratch> scratches(scratch);
    const std::size_t batch = 128 * run;
    std::vector<std::vector<FinishedRows>> finished(128, std::vector<FinishedRows>(sinks.size()));
    for (std::size_t begin = 0; begin < rows.size(); begin += batch) {
        const std::size_t end = std::min(begin + batch, rows.size());
        const std::size_t runs = (end - begin + run - 1) / run;
        tbb::parallel_for(std::size_t(0), runs, [&](std::size_t r) {
            auto& local = scratches.local();
            for (FinishedRows& of_sink : finished[r]) of_sink.clear();
            for (std::size_t k = begin + r * run; k < std::min(end, begin + (r + 1) * run); ++k)
                make(rows[k], local, std::span<FinishedRows>(finished[r]));
        });
        for (std::size_t r = 0; r < runs; ++r)
            for (std::size_t s = 0; s < sinks.size(); ++s)
                hand_over(finished[r][s], rows.subspan(begin + r * run), sinks[s]);
        if (options.progress)
            options.progress({"exchange areas", double(end) / double(rows.size()),
                              discretization.elements.size(), 0.0});
    }
}

// The same with one sink; make(element, scratch, finished) appends one row to what a task makes.
template <class Scratch, class Make>
void make_row_batches(const Discretization& discretization, std::span<const ElementId> rows,
                      const ExchangeOptions& options, const RowSink& sink, std::size_t run,
                      const Scratch& scratch, Make&& make) {
    make_row_batches(discretization, rows, options, std::span(&sink, 1), run, scratch,
                     [&](ElementId id, Scratch& local, std::span<FinishedRows> finished) {
                         make(id, local, finished[0]);
                     });
}

}  // namespace tyndall::radiosity
