#include "radiosity/first_look.h"

#include <algorithm>

#include "radiosity/direct_light.h"
#include "radiosity/leaf_light.h"

namespace tyndall::radiosity {
namespace {

// (36)
Spectrum ambient(const Enclosure& e, const Forest& forest, const ElementMesh& mesh,
                 DirectRefiner& direct) {
    Spectrum result(e.bands);
    for (std::size_t b = 0; b < e.bands; ++b) {
        double area = 0.0, reflecting = 0.0, reflected = 0.0;
        for (const PatchId p : mesh.patches()) {
            if (!forest.is_leaf(p)) continue;
            const double reflectance = e.sides[side_of(e, forest, p)].reflectance[b];
            const double a = forest.area(p);
            area += a;
            reflecting += a * reflectance;
            reflected += a * reflectance * direct.mean(p, b);
        }
        // Of a room that loses nothing there is no estimate: one reflection is shown.
        const double lost = area - reflecting;
        if (area > 0.0) result[b] = reflected / (lost > 1e-6 * area ? lost : area);
    }
    return result;
}

}  // namespace

Solution first_look(const Enclosure& enclosure, const SolveOptions& options) {
    auto emptied = std::make_shared<Enclosure>(enclosure);
    std::ranges::fill(emptied->region_medium, none);
    const DirectLight light(*emptied);
    ElementMesh mesh(*emptied);
    mesh.refine_to({options.element_size, options.max_elements,
                    options.element_size > 0.0 ? options.max_elements : 1500});
    DirectRefiner direct(*emptied, mesh, light);
    direct.update();
    LeafLight leaf_light(*emptied, mesh, direct, options.radiance);

    const Forest& forest = mesh.forest();
    const Spectrum everywhere = ambient(*emptied, forest, mesh, direct);
    Solution solution;
    solution.direct.resize(forest, emptied->bands);
    solution.indirect.resize(forest, emptied->bands);
    solution.zone_error.resize(forest.zone_count());
    solution.patch_error.resize(forest.patch_count());
    for (const PatchId p : mesh.patches()) {
        if (!forest.is_leaf(p)) continue;
        for (std::size_t b = 0; b < emptied->bands; ++b) {
            solution.direct.set(p, b, leaf_light.direct(p, b));
            solution.indirect.set(p, b, Affine{Direction(0.0), everywhere[b]});
        }
        solution.patch_error[p.value] = static_cast<float>(direct.error(p));
    }
    solution.patch_direct_error = solution.patch_error;
    solution.forest = forest;
    solution.enclosure = std::move(emptied);
    return solution;
}

}  // namespace tyndall::radiosity
