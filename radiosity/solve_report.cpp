#include "radiosity/solve_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "radiosity/mirrored_lights.h"
#include "radiosity/smoothing.h"

namespace tyndall::radiosity {
namespace {

// Optical depths of a zone in the coarse solution above which fluxes through it are off: with
// constant J by 5 % at 0.5, with linear J by some per cent above 2 (docs/limits.md).
double thin_enough(const CoarseSolution& coarse) {
    return coarse.areas(0).moments.empty() ? 0.5 : 2.0;
}

// The zone of the coarse solution with most optical depth across.
struct ThickestZone {
    double depth = 0.0, extinction = 0.0;  // [-], [1/m]
    std::uint32_t medium = 0;
};

ThickestZone thickest_zone(const Enclosure& enclosure, const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    ThickestZone thickest;
    for (std::size_t i = e.patches.size(); i < e.size(); ++i) {
        const auto m = medium_of(enclosure, coarse.forest(), e.zone(i));
        double volume = 0.0;
        for (const auto member : e.members_of(i)) volume += coarse.forest().volume(ZoneId(member));
        const double size = std::cbrt(volume);
        const MediumOptics& optics = enclosure.media[m];
        for (std::size_t b = 0; b < e.bands; ++b) {
            // J is known, and constant, where a medium only emits.
            if (optics.albedo[b] == 0.0 && !optics.settled_heat) continue;
            const double extinction = optics.varying.empty()
                                          ? optics.extinction[b]
                                          : e.capacity[i * e.bands + b] / (4.0 * volume);
            if (extinction * size > thickest.depth) thickest = {extinction * size, extinction, m};
        }
    }
    return thickest;
}

void warn_of_thick_zones(const Enclosure& enclosure, const CoarseSolution& coarse, Report& report) {
    const ThickestZone thickest = thickest_zone(enclosure, coarse);
    const double thin = thin_enough(coarse);
    if (!(thickest.depth > thin)) return;
    const MediumOptics& optics = enclosure.media[thickest.medium];
    const double most = optics.varying.empty()
                            ? *std::max_element(optics.extinction.begin(), optics.extinction.end())
                            : thickest.extinction;
    report.warnings.push_back(fmt::format(
        "zones of medium \"{}\" in the coarse solution are up to {:.2g} optical depths thick: "
        "fluxes through them are uncertain. Set solve.element_size to {:.2g} m or less.",
        optics.name, thickest.depth, thin / most));
}

// Refinement makes elements smaller; it cannot mend what rays leave.
void warn_of_noise(const ErrorParts& error, const SolveOptions& options, Report& report) {
    if (options.refinement < Refinement::adaptive || error.total() <= options.error) return;
    const double noise = std::hypot(error.gathers, error.coarse);
    if (noise < error.elements) return;
    report.warnings.push_back(fmt::format(
        "the error goal of {} is not met, and smaller elements would not help: the last gathers' "
        "noise is {:.2g} % (raise solve.gather_rays), the coarse solution's error {:.2g} % (raise "
        "solve.rays, or lower solve.element_size).",
        options.error, 100.0 * error.gathers, 100.0 * error.coarse));
}

void warn_of_smoothing(Report& report) {
    if (report.smoothing && !report.smoothing->converged)
        report.warnings.push_back(fmt::format(
            "smoothing did not make rows close: closure error {:.2g} after {} passes. Rows of few "
            "rays may have no matrix near them that is symmetric and closes: raise solve.rays.",
            report.closure_error, report.smoothing->iterations));
}

}  // namespace

Report solve_report(const Enclosure& enclosure, const CoarseSolution& coarse,
                    const std::vector<double>& incident_direct, const DirectLight& light,
                    const SolveOptions& options, const Ending& ending) {
    Report report;
    report.solved_elements = coarse.elements().size();
    report.solver = coarse.report();
    report.stopped = ending.stopped;
    report.lost_rays = coarse.lost_rays();
    report.picture_error = ending.picture_error;
    report.solution_error = ending.solution_error;
    const ErrorParts goal =
        ending.for_picture && ending.picture_error ? *ending.picture_error : ending.solution_error;
    report.estimated_error = goal.total();
    for (std::size_t b = 0; b < enclosure.bands; ++b) {
        report.closure_error = std::max(report.closure_error, coarse.closure_error(b));
        if (b > 0 && &coarse.areas(b) == &coarse.areas(0)) continue;  // the same rows
        // The other way round a NaN, "not known", would be lost.
        report.reciprocity_error = std::max(coarse.reciprocity_error(b), report.reciprocity_error);
        if (const auto& one = coarse.areas(b).smoothing)
            report.smoothing = report.smoothing ? worse_of(*report.smoothing, *one) : *one;
    }
    const Balance power = balance(enclosure, coarse, incident_direct, light, ending.escaped_direct);
    report.net_power = power.net_power;
    report.net_flux = power.net_flux;
    report.flux_divergence = power.flux_divergence;
    report.energy_balance = power.energy_balance;
    report.direct_power_check = ending.direct_power_check;
    report.warnings = enclosure.warnings;
    warn_of_thick_zones(enclosure, coarse, report);
    if (std::abs(report.direct_power_check) > 0.005)
        report.warnings.push_back(fmt::format(
            "{:.2g} % of the direct light {}: elements straddle shadows. Allow more of them "
            "(solve.max_elements), or set solve.refinement to \"view\".",
            100.0 * std::abs(report.direct_power_check),
            report.direct_power_check < 0.0 ? "is missing" : "is too much"));
    if (light.cut_images())
        report.warnings.push_back(fmt::format(
            "sun, point and spot lights have more than {} images in the scene's mirrors: the light "
            "of the others is missing. Set solve.mirrors to \"scattered\", or give the lights a "
            "surface.",
            MirroredLights::most_images));
    if (ending.out_of_time)
        report.warnings.push_back(
            fmt::format("refinement ended at max_time = {} s; the estimated error is {:.3g}.",
                        options.max_time, report.estimated_error));
    warn_of_noise(goal, options, report);
    warn_of_smoothing(report);
    if (ending.limited && std::max(ending.refined_to, goal.elements) > options.error)
        report.warnings.push_back(fmt::format(
            "refinement ended at a limit (max_elements = {}, max_memory = {} bytes, "
            "max_passes = {}) before the error goal of {}.",
            options.max_elements, options.max_memory, options.max_passes, options.error));
    if (!report.solver.converged)
        report.warnings.push_back(
            fmt::format("the solver ({}) did not converge: residual {:.2e} after {} iterations, "
                        "{:.3g} W unshot. Raise solve.solver_iterations, loosen "
                        "solve.solver_tolerance, or set solve.solver to \"gmres\".",
                        report.solver.method, report.solver.residual, report.solver.iterations,
                        report.solver.unshot_power));
    return report;
}

}  // namespace tyndall::radiosity
