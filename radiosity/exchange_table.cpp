#include "radiosity/exchange_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "radiosity/smoothing.h"
#include "radiosity/start_elements.h"

namespace tyndall::radiosity {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class Table {
  public:
    Table(const Enclosure& enclosure, const NamedExchangeMethod& method,
          const ExchangeOptions& options)
        : enclosure_(enclosure),
          forest_(enclosure.mesh),
          elements_(start_elements(enclosure, forest_, Start::single_zone)),
          method_(method),
          options_(options) {
        if (method.walks) options_.rays = rays_from_each(options.rays);
        for (std::size_t i = 0; i <= elements_.size(); ++i)
            members_[name_of(enclosure, forest_, elements_, ElementId(i))].push_back(ElementId(i));
    }

    ExchangeTable make(const std::vector<std::string>& from, const std::vector<std::string>& to) {
        options_.lost_rays = &lost_;
        ExchangeTable table;
        if (options_.settings.smoothing == Smoothing::none)
            make_pairs(from, to);
        else
            table.smoothing = make_smoothed();
        for (const auto& a : from)
            for (const auto& b : to)
                if (a != "outside" || b != "outside") table.entries.push_back({a, b, sum(a, b)});
        const bool all = table.smoothing.has_value();
        table.closure_error = all ? closure_error(names(), names()) : closure_error(from, to);
        table.reciprocity_error =
            all ? reciprocity_error(names(), names()) : reciprocity_error(from, to);
        table.lost_rays = lost_;
        return table;
    }

  private:
    using Pair = std::pair<std::string, std::string>;

    // As many as the mean element's facets or tetrahedra would send in a solve on the base mesh.
    std::size_t rays_from_each(std::size_t rays) const {
        constexpr std::size_t most = 1u << 20;
        const std::size_t members =
            elements_.member_patches().size() + elements_.member_zones().size();
        const std::size_t mean = members / std::max<std::size_t>(1, elements_.size());
        return std::max(rays, std::min(most, rays * std::max<std::size_t>(1, mean)));
    }

    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& [name, members] : members_) result.push_back(name);
        return result;
    }

    void make_pairs(const std::vector<std::string>& from, const std::vector<std::string>& to) {
        const bool from_outside = std::ranges::find(from, "outside") != from.end();
        auto rows = elements_of(from);
        std::erase(rows, ElementId(elements_.outside()));
        const auto columns = elements_of(to);
        for (std::size_t band = 0; band < enclosure_.bands; ++band) {
            if (first_of_extinction(enclosure_, band) < band) continue;
            add_rows(rows, columns, band, false);
            // Outside has no row: what the others send there comes back.
            auto others = columns;
            std::erase(others, ElementId(elements_.outside()));
            if (from_outside) add_rows(others, {ElementId(elements_.outside())}, band, true);
        }
        for (auto& [pair, areas] : sums_)
            for (std::size_t band = 0; band < enclosure_.bands; ++band)
                areas[band] = areas[first_of_extinction(enclosure_, band)];
    }

    // Smoothing needs every row whole. Leaves the smoothed sums.
    SmoothingReport make_smoothed() {
        std::vector<ElementId> rows(elements_.size());
        for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = ElementId(i);
        std::vector<ExchangeAreas> bands(enclosure_.bands);
        for (std::size_t band = 0; band < bands.size(); ++band) {
            if (const auto first = first_of_extinction(enclosure_, band); first < band) {
                bands[band] = bands[first];
                continue;
            }
            options_.band = band;
            method_.method({enclosure_, forest_, elements_}, rows, options_,
                           [&](const Row& row) { append(bands[band], row, Precision::doubled); });
        }
        set_sums(bands);
        const double raw_closure = closure_error(names(), names());
        const double raw_reciprocity = reciprocity_error(names(), names());
        std::optional<SmoothingReport> report;
        for (std::size_t band = 0; band < bands.size(); ++band) {
            bands[band] =
                smooth(std::move(bands[band]), elements_, band, options_.settings.smoothing);
            const SmoothingReport& one = *bands[band].smoothing;
            report = report ? worse_of(*report, one) : one;
        }
        report->raw_closure_error = raw_closure;
        report->raw_reciprocity_error = raw_reciprocity;
        set_sums(bands);
        return *report;
    }

    void set_sums(const std::vector<ExchangeAreas>& bands) {
        sums_.clear();
        for (std::size_t band = 0; band < bands.size(); ++band)
            for (std::size_t i = 0; i < bands[band].rows(); ++i)
                for (std::size_t k = bands[band].starts[i]; k < bands[band].starts[i + 1]; ++k) {
                    const auto there = name(ElementId(bands[band].columns[k]));
                    add(name(ElementId(i)), there, band, bands[band].value(k));
                    if (there == "outside")
                        add(there, name(ElementId(i)), band, bands[band].value(k));
                }
    }

    std::vector<ElementId> elements_of(const std::vector<std::string>& names) const {
        std::vector<ElementId> result;
        for (const auto& name : names) {
            const auto& members = members_.at(name);
            result.insert(result.end(), members.begin(), members.end());
        }
        std::ranges::sort(result);
        return result;
    }

    std::string name(ElementId element) const {
        return name_of(enclosure_, forest_, elements_, element);
    }

    void add_rows(const std::vector<ElementId>& rows, const std::vector<ElementId>& columns,
                  std::size_t band, bool turned) {
        options_.band = band;
        options_.columns =
            columns.size() <= elements_.size() ? std::span(columns) : std::span<const ElementId>();
        method_.method({enclosure_, forest_, elements_}, rows, options_, [&](const Row& row) {
            for (std::size_t k = 0; k < row.columns.size(); ++k) {
                const ElementId column(row.columns[k]);
                if (!std::ranges::binary_search(columns, column)) continue;
                Pair pair{name(row.receiver), name(column)};
                if (turned) std::swap(pair.first, pair.second);
                add(pair.first, pair.second, band, row.exchange_areas[k]);
            }
        });
    }

    void add(const std::string& from, const std::string& to, std::size_t band, double area) {
        Spectrum& sums = sums_[{from, to}];
        sums.resize(enclosure_.bands);
        sums[band] += area;
    }

    Spectrum sum(const std::string& from, const std::string& to) const {
        const auto found = sums_.find({from, to});
        return found == sums_.end() ? Spectrum(enclosure_.bands, 0.0) : found->second;
    }

    double closure_error(const std::vector<std::string>& from,
                         const std::vector<std::string>& to) const {
        if (to.size() < members_.size()) return unknown;
        double worst = 0.0;
        for (const auto& a : from) {
            if (a == "outside") continue;
            Spectrum left(enclosure_.bands);
            for (const ElementId i : members_.at(a))
                for (std::size_t b = 0; b < enclosure_.bands; ++b)
                    left[b] += elements_.capacity[i.value * enclosure_.bands + b];
            const Spectrum capacity = left;
            for (const auto& c : to) {
                const Spectrum area = sum(a, c);
                for (std::size_t b = 0; b < enclosure_.bands; ++b) left[b] -= area[b];
            }
            for (std::size_t b = 0; b < enclosure_.bands; ++b)
                if (capacity[b] > 0.0) worst = std::max(worst, std::abs(left[b]) / capacity[b]);
        }
        return worst;
    }

    double reciprocity_error(const std::vector<std::string>& from,
                             const std::vector<std::string>& to) const {
        double difference = 0.0, total = 0.0;
        for (const auto& a : from)
            for (const auto& c : to) {
                if (a == c || a == "outside" || c == "outside") continue;
                const auto back = sums_.find({c, a});
                if (back == sums_.end()) continue;
                const Spectrum forth = sum(a, c);
                for (std::size_t b = 0; b < enclosure_.bands; ++b) {
                    difference += std::abs(forth[b] - back->second[b]);
                    total += forth[b];
                }
            }
        return total > 0.0 ? difference / total : unknown;
    }

    const Enclosure& enclosure_;
    Forest forest_;
    Elements elements_;
    const NamedExchangeMethod& method_;
    ExchangeOptions options_;
    std::map<std::string, std::vector<ElementId>> members_;  // elements of each name
    std::map<Pair, Spectrum> sums_;
    std::atomic<std::size_t> lost_ = 0;
};

}  // namespace

std::vector<std::string> exchange_names(const Enclosure& enclosure) {
    const Forest forest(enclosure.mesh);
    const Elements elements = start_elements(enclosure, forest, Start::single_zone);
    std::vector<std::string> names;
    for (std::size_t i = 0; i <= elements.size(); ++i) {
        const auto name = name_of(enclosure, forest, elements, ElementId(i));
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    return names;
}

ExchangeTable exchange_table(const Enclosure& enclosure, const NamedExchangeMethod& method,
                             const ExchangeOptions& options, const std::vector<std::string>& from,
                             const std::vector<std::string>& to) {
    require_settings(method, options.settings);
    require_media(method, enclosure);
    return Table(enclosure, method, options).make(from, to);
}

}  // namespace tyndall::radiosity
