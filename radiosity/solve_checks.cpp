#include "radiosity/solve_checks.h"

#include <fmt/format.h>

#include "mesh/input_error.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/indicators.h"
#include "radiosity/smoothing.h"
#include "radiosity/solvers.h"

namespace tyndall::radiosity {
namespace {

void check_base(const Enclosure& enclosure, const mesh::BaseMesh& kept) {
    if (enclosure.mesh == kept) return;
    throw mesh::InputError(fmt::format(
        "the mesh to go on with has another base mesh ({} tetrahedra; here {}, or other corners): "
        "the geometry has changed, or a file that the scene names. Give the same scene and files, "
        "or begin anew.",
        kept.tets.size(), enclosure.mesh.tets.size()));
}

}  // namespace

void check_solve(const Enclosure& enclosure, const SolveOptions& options, const Passes& passes) {
    if (!exchange_method(options.exchange).detail && options.row_detail > 0.0)
        throw mesh::InputError(
            fmt::format("level of detail in rows (row_detail) is made by walking, not by \"{}\". "
                        "Set row_detail to 0, or exchange to \"walked\".",
                        options.exchange));
    check_smoothing(options.exchange_settings.smoothing, options.row_detail);
    require_settings(exchange_method(options.exchange), options.exchange_settings);
    check_solver(options);
    require_media(exchange_method(options.exchange), enclosure);
    check_indicators(options);
    if (passes.begin_with) check_base(enclosure, passes.begin_with->base);
}

}  // namespace tyndall::radiosity
