#include "radiosity/final_gather.h"

#include "mesh/body.h"

namespace tyndall::radiosity {
namespace {

// Zones that are no longer than this share of their distance may stand for their leaves: as long
// as the spacing of some hundred rays [-].
constexpr double detail = 0.2;

// What patches reflect of direct light.
Fields lit_fields(const Solution& s) {
    Fields lit;
    lit.resize(s.forest, s.enclosure->bands);
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!s.forest.is_leaf(patch)) continue;
        for (std::size_t b = 0; b < lit.bands; ++b) {
            const double a = scattered_of(s, patch, b);
            const Affine direct = s.direct.at(patch, b);
            lit.at(patch, b) = {a * direct.gradient, a * direct.constant};
        }
    }
    return lit;
}

// All that is sent out besides, and besides direct emission.
Fields other_fields(const Solution& s, const Fields& lit) {
    Fields rest = reflected_sources(s);
    for (std::size_t k = 0; k < rest.patch.size(); ++k) {
        rest.patch[k].gradient -= lit.patch[k].gradient;
        rest.patch[k].constant -= lit.patch[k].constant;
    }
    return rest;
}

}  // namespace

FinalGather::FinalGather(const Solution& solution) : FinalGather(solution, lit_fields(solution)) {}

FinalGather::FinalGather(const Solution& solution, const Fields& lit)
    : s_(solution),
      lit_(*solution.enclosure, solution.forest, lit),
      rest_(*solution.enclosure, solution.forest, other_fields(solution, lit), detail) {
    std::vector<Affine> in_mirrors = sources_in_mirrors(solution);
    for (std::size_t k = 0; k < in_mirrors.size(); ++k) {
        in_mirrors[k].gradient += lit.patch[k].gradient;
        in_mirrors[k].constant += lit.patch[k].constant;
    }
    rest_.set_in_mirrors(std::move(in_mirrors));
    rest_.set_lit(lit.patch);
    bright_.emplace(*solution.enclosure, rest_, OnPurpose{.lit = &lit_}, 0);
}

void FinalGather::on_surface(PatchId leaf, Point x, const PointSet& points, std::uint64_t seed,
                             std::span<double> incident) const {
    const std::uint32_t root = s_.forest.base_facet_side(leaf);
    thread_local std::vector<Gathered> gathered;
    gathered.resize(incident.size());
    const GatherPoint point{x, mesh::start_before(s_.enclosure->mesh, root, x),
                            normal_of(s_.forest, leaf)};
    gather(rest_, {&lit_, &*bright_}, point, points, seed, gathered);
    for (std::size_t b = 0; b < incident.size(); ++b) incident[b] = gathered[b].mean;
}

}  // namespace tyndall::radiosity
