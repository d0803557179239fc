// The rows of a coarse solution: made and kept, corrected, or made again whenever they are needed.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "radiosity/coarse_solution.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/exchange_moved.h"

namespace tyndall::radiosity {

// What reaches patches by way of mirrors, of the same rays: e^A, and what patches reflect of direct
// light, are seen straight in closed form, but not so.
void CoarseSolution::make_in_mirrors(std::span<const std::size_t> bands, RowSet& rows) {
    ExchangeOptions chosen = exchange_options(bands.front());
    chosen.detail = on_the_fly() ? 0.0 : options_.row_detail;
    chosen.legs = RowLegs::in_mirrors;
    chosen.settings.smoothing = Smoothing::none;
    for (const std::size_t band : bands) {
        chosen.band = band;
        rows.in_mirrors.push_back(all_rows(exchange_method(options_.exchange).method,
                                           {enclosure_, forest_, elements_}, chosen));
        rays_ += elements_.size() * options_.rays;
    }
}

// Of bands with extinctions that differ; by one walk for all, where the method can.
void CoarseSolution::make_areas(std::span<const std::size_t> bands, const KeptRows* kept,
                                RowSet& rows) {
    auto& areas = rows.areas;
    const NamedExchangeMethod& method = exchange_method(options_.exchange);
    const Discretization d{enclosure_, forest_, elements_};
    ExchangeOptions chosen = exchange_options(bands.front());
    chosen.detail = options_.row_detail;
    chosen.radiance =
        method.moments ? std::min(options_.radiance, Radiance::linear) : Radiance::constant;
    chosen.progress = progress_;
    if (kept) {
        std::atomic<std::size_t> walked = 0;
        for (const std::size_t band : bands) {
            chosen.band = band;
            areas.push_back(moved_rows(
                d, {kept->discretization, kept->rows.areas[areas.size()], kept->directions}, chosen,
                walked));
        }
        rays_ += walked;
    } else if (method.of_bands && bands.size() > 1) {
        areas = all_rows(method.of_bands, d, chosen, bands);
        rays_ += elements_.size() * options_.rays;
    } else {
        for (const std::size_t band : bands) {
            chosen.band = band;
            areas.push_back(all_rows(method.method, d, chosen));
            rays_ += elements_.size() * options_.rays;
        }
    }
}

std::vector<glm::vec3> CoarseSolution::ray_directions() const {
    return radiosity::ray_directions({enclosure_, forest_, elements_}, exchange_options(0));
}

// Without detail and moments, whose rows are not of elements alone.
ExchangeOptions CoarseSolution::exchange_options(std::size_t band) const {
    return {.band = band,
            .rays = options_.rays,
            .seed = options_.seed,
            .settings = options_.exchange_settings,
            .progress = {},
            .lost_rays = &lost_rays_};
}

void CoarseSolution::make_rows(std::size_t band, std::span<const ElementId> rows,
                               const RowSink& sink) const {
    const auto check = [&](const Row& row) {
        const double capacity = elements_.capacity[row.receiver.value * elements_.bands + band];
        double sum = 0.0;
        for (const double area : row.exchange_areas) sum += area;
        double& worst = closure_[matrix_[band]];
        if (capacity > 0.0) worst = std::max(worst, std::abs(sum - capacity) / capacity);
        sink(row);
    };
    exchange_method(options_.exchange)
        .method({enclosure_, at_first_, elements_}, rows, exchange_options(band), check);
    rays_ += rows.size() * options_.rays;
}

// What goes out of every element: where something can, a pass over all rows that keeps nothing
// else.
void CoarseSolution::find_outside(std::size_t band) {
    std::vector<double>& outside = outside_.emplace_back();
    if (!enclosure_.open) return;
    std::vector<ElementId> rows(elements_.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = ElementId(i);
    outside.assign(rows.size(), 0.0);
    make_rows(band, rows, [&](const Row& row) {
        if (!row.columns.empty() && row.columns.back() == elements_.outside())
            outside[row.receiver.value] = row.exchange_areas.back();
    });
}

}  // namespace tyndall::radiosity
