#include "radiosity/shared_rows.h"

#include <algorithm>

namespace tyndall::radiosity {

std::size_t RowSet::memory() const {
    std::size_t bytes = 0;
    for (const auto* of : {&areas, &in_mirrors})
        for (const ExchangeAreas& one : *of) bytes += one.memory();
    return bytes;
}

bool same_for_rays(const Enclosure& a, const Enclosure& b) {
    const auto same_mirror = [](const SurfaceSide& p, const SurfaceSide& q) {
        return p.mirror == q.mirror;
    };
    const auto same_extinction = [](const MediumOptics& p, const MediumOptics& q) {
        return p.extinction == q.extinction && p.varying == q.varying;
    };
    return a.bands == b.bands && a.mirrors == b.mirrors && a.mesh == b.mesh &&
           a.facet_sides == b.facet_sides && a.region_medium == b.region_medium &&
           a.region_solid == b.region_solid && std::ranges::equal(a.sides, b.sides, same_mirror) &&
           std::ranges::equal(a.media, b.media, same_extinction);
}

std::shared_ptr<const RowSet> SharedRows::of(std::shared_ptr<const Enclosure> enclosure,
                                             const SolveOptions& options) {
    if (rows_ && !(options_ == options && same_for_rays(*enclosure_, *enclosure))) rows_.reset();
    if (!rows_) {
        enclosure_ = std::move(enclosure);
        options_ = options;
    }
    return rows_;
}

}  // namespace tyndall::radiosity
