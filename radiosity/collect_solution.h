// What a solve leaves, of what it has in hand.
#pragma once

#include <memory>

#include "radiosity/coarse_solution.h"
#include "radiosity/element_mesh.h"
#include "radiosity/leaf_light.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {

// The leaves of a solve, and their direct light.
struct LitLeaves {
    std::shared_ptr<const Enclosure> enclosure;
    const SolveOptions& options;
    ElementMesh& mesh;
    DirectRefiner& direct;
    LeafLight& light;
};

// The leaves' fields: direct light, and indirect(leaf, band) of each; the coarse solution's values.
// Errors are those of direct light alone; the report is left empty.
// `incident_direct`: H^A of the coarse elements ([element * bands + band]) [W/m^2/sr].
// Cost: O(nodes).
template <class Indirect>
Solution collect_solution(const LitLeaves& of, const CoarseSolution& coarse,
                          const std::vector<double>& incident_direct, Indirect&& indirect) {
    const auto& [enclosure, options, mesh, direct, light] = of;
    const Forest& forest = mesh.forest();
    const std::size_t bands = enclosure->bands;
    Solution solution;
    solution.enclosure = enclosure;
    solution.direct_light = options.direct_light;
    solution.direct.resize(forest, bands);
    solution.indirect.resize(forest, bands);
    if (options.radiance == Radiance::quadratic) {
        solution.direct.zone_bend.resize(forest.zone_count() * bands);
        solution.indirect.patch_bend.resize(forest.patch_count() * bands);
    }
    solution.zone_error.resize(forest.zone_count());
    solution.patch_error.resize(forest.patch_count());
    const auto fill = [&](auto node, float& error) {
        for (std::size_t b = 0; b < bands; ++b) {
            // Zones are seen as integrals along rays, where the mean counts; patches are seen as
            // they are, where a jump from one to the next would show.
            if constexpr (std::is_same_v<decltype(node), ZoneId>)
                solution.direct.set(node, b, light.direct_with_mean(node, b));
            else
                solution.direct.set(node, b, light.direct(node, b));
            solution.indirect.set(node, b, indirect(node, b));
        }
        error = static_cast<float>(direct.error(node));
    };
    for (const ZoneId z : mesh.zones())
        if (forest.is_leaf(z)) fill(z, solution.zone_error[z.value]);
    for (const PatchId p : mesh.patches())
        if (forest.is_leaf(p)) fill(p, solution.patch_error[p.value]);
    solution.patch_direct_error = solution.patch_error;
    if (options.radiance == Radiance::constant) {
        flatten(forest, solution.direct);
        flatten(forest, solution.indirect);
    }
    if (!coarse.settled().empty()) solution.settled = light.settled(coarse);
    solution.forest = forest;
    solution.coarse = coarse.values(incident_direct);
    return solution;
}

}  // namespace tyndall::radiosity
