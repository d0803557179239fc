// Rows of exchange areas that solves share: those of one mesh do not change with its lights.
#pragma once

#include <memory>

#include "radiosity/enclosure.h"
#include "radiosity/exchange.h"
#include "radiosity/options.h"

namespace tyndall::radiosity {

// Rows of a solution's elements, of each distinct extinction.
struct RowSet {
    std::vector<ExchangeAreas> areas;
    std::vector<ExchangeAreas> in_mirrors;  // the same, RowLegs::in_mirrors; none without mirrors
    std::size_t lost_rays = 0;              // of those walked for them, by the walk's step cap

    std::size_t memory() const;
};

// What solves leave for each other (Passes::rows): the rows of the elements that they begin with,
// before any is bisected.
class SharedRows {
  public:
    // The rows that are here, if a solve of this enclosure would make the same: the mesh, the
    // extinctions, the mirrors and the options are those they were made of. Others are let go, and
    // null is returned.
    std::shared_ptr<const RowSet> of(std::shared_ptr<const Enclosure> enclosure,
                                     const SolveOptions& options);
    // Those of the enclosure and options last asked for.
    void leave(std::shared_ptr<const RowSet> rows) { rows_ = std::move(rows); }
    bool empty() const { return !rows_; }

  private:
    std::shared_ptr<const Enclosure> enclosure_;
    SolveOptions options_;
    std::shared_ptr<const RowSet> rows_;
};

// Whether all that rays meet in two enclosures is the same: the mesh, κ of its media, what is
// solid, what is a mirror. Lights, and what emits, reflects evenly or scatters, may differ. Cost:
// that of comparing all corners.
bool same_for_rays(const Enclosure& a, const Enclosure& b);

}  // namespace tyndall::radiosity
