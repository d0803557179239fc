// Exchange areas between whole sides, media and outside: what a scene's surfaces and volumes
// exchange as they are, before any mesh.
#pragma once

#include <string>

#include "radiosity/exchange_methods.h"

namespace tyndall::radiosity {

struct ExchangeTable {
    struct Entry {
        std::string from, to;
        Spectrum exchange_area;  // one value a band [m^2]
    };
    std::vector<Entry> entries;
    // max |Σ_to S − c| / c over whole sides and media, and Σ|S_ij − S_ji| / Σ S_ij; NaN where the
    // pairs asked for do not tell [-].
    double closure_error, reciprocity_error;
    // With settings.smoothing: raw errors are those two before, of whole sides and media.
    std::optional<SmoothingReport> smoothing;
    std::size_t lost_rays = 0;
};

// The names that take part: sides that light can reach, media that are somewhere, "outside".
std::vector<std::string> exchange_names(const Enclosure& enclosure);

// Purpose: the exchange area of every ordered pair of `from` and `to` (exchange_names), sums over
//   the flat pieces of a side and the connected parts of a medium (Start::single_zone). That from
//   outside is that to outside, by reciprocity; outside to outside is left out. With
//   settings.smoothing all rows are made and smoothed (smoothing.h), whatever is asked for, and
//   both errors are known.
// Rays of the methods that walk: `options.rays` times the facets or tetrahedra of the mean side or
//   medium, up to 2^20, unless they are more to begin with: what a solve on the base mesh has.
// Errors: what the method throws for a pair that it cannot do; settings that it does not know.
// Cost: the method's, of the rows of `from` alone, and the columns of `to` where it can leave out
//   others; of all pairs with smoothing.
ExchangeTable exchange_table(const Enclosure& enclosure, const NamedExchangeMethod& method,
                             const ExchangeOptions& options, const std::vector<std::string>& from,
                             const std::vector<std::string>& to);

}  // namespace tyndall::radiosity
