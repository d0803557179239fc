// A lamp is switched on in a foggy room. Its light goes round, shot by shot: what is left to send?
//
//   Run:       build/release/bin/05_progressive_refinement
//   Shows:     the linear system by hand: elements, rows of exchange areas, a solver and its
//   history;
//              progressive refinement, shots on the fly, overshooting
//   Builds on: 03_foggy_room
#include <cmath>
#include <cstdio>

#include "mesh/shapes.h"
#include "radiosity/element_mesh.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/scene_builder.h"
#include "radiosity/solver_progressive_refinement.h"

using namespace tyndall;
using namespace tyndall::radiosity;

int main() {
    Scene scene;
    add_surface(scene, "room", mesh::room({0, 0, 0}, {4, 3, 3}), {.reflectance = {0.7}});
    add_surface(scene, "panel", mesh::rectangle({1.5, 1, 3}, {0, 1, 0}, {1, 0, 0}),
                {.reflectance = {0.0}, .power = {100.0}});                  // [W]
    scene.media = {{.name = "fog", .extinction = {0.5}, .albedo = {0.9}}};  // [1/m], [-]
    const Enclosure enclosure = make_enclosure(scene);

    // Elements of at most 1.2 m, and a row of exchange areas for each, from 128 rays.
    ElementMesh mesh(enclosure);
    mesh.refine_to({1.2, 100'000, 100'000});
    const Elements elements = elements_of_leaves(enclosure, mesh.forest());
    const Discretization room{enclosure, mesh.forest(), elements};
    const ExchangeAreas areas = all_rows(exchange_walked, room, {.rays = 128, .progress = {}});
    std::printf("%zu patches, %zu zones, %zu exchange areas\n\n", elements.patches.size(),
                elements.zones.size(), areas.columns.size());

    // Every element holds what it has yet to send. The one with most shoots, and what others
    // reflect or scatter of that they have yet to send in turn: the panel first, the fog below it
    // next.
    const LinearProblem problem{elements, areas, 0, elements.emission};
    const SolverResult kept = solve_progressive_refinement(problem, {.tolerance = 1e-4});
    std::printf("  shots   unshot [W]   residual   ambient [W/m^2/sr]\n");
    double next = 100.0;
    for (const SolverStep& step : kept.history) {
        if (step.unshot_power > next) continue;
        next = 0.5 * step.unshot_power;
        std::printf("%7zu %12.4f   %8.1e   %10.5f\n", step.shots, step.unshot_power, step.residual,
                    step.ambient);
    }

    // Overshooting sends along what the shooter is about to receive: fewer shots for the same.
    const SolverResult over =
        solve_progressive_refinement(problem, {.tolerance = 1e-4, .overshooting = true});

    // On the fly no row is kept: the shooter's own is walked when it shoots, and what it says of
    // S_ij is taken for S_ji. The two agree as far as rows are reciprocal.
    const ExchangeAreas none;
    LinearProblem without{elements, none, 0, elements.emission};
    without.rows = [&](std::span<const ElementId> rows, const RowSink& sink) {
        exchange_walked(room, rows, {.rays = 128, .progress = {}}, sink);
    };
    const SolverResult fly = solve_progressive_refinement(without, {.tolerance = 1e-2});

    double mean_kept = 0.0, mean_fly = 0.0, difference = 0.0;
    for (std::size_t i = elements.patches.size(); i < elements.size(); ++i) {
        mean_kept += elements.capacity[i] * kept.radiance[i];
        mean_fly += elements.capacity[i] * fly.radiance[i];
        difference += elements.capacity[i] * std::abs(kept.radiance[i] - fly.radiance[i]);
    }
    std::printf("\nshots to a residual of 1e-4: %zu, overshooting %zu\n", kept.shots, over.shots);
    std::printf(
        "power scattered by the fog: %.2f W; with %zu shots on the fly, to 1e-2: %.2f W, "
        "zones apart by %.1f %%\n",
        M_PI * mean_kept, fly.shots, M_PI * mean_fly, 100.0 * difference / mean_kept);
    return kept.converged && over.converged && fly.converged ? 0 : 1;
}
