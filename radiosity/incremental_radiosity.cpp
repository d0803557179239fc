#include "radiosity/incremental_radiosity.h"

#include <algorithm>
#include <cmath>

#include "radiosity/enclosure_emissions.h"
#include "radiosity/error_estimate.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t most_rounds = 1;  // of refinement for scenes that miss the goal

std::shared_ptr<const Enclosure> lit_by(const Scene& scene, const Enclosure& enclosure) {
    auto lit = std::make_shared<Enclosure>(enclosure);
    bind_emissions(scene, *lit);
    return lit;
}

std::size_t leaves_of(const Solution& solution) {
    return solution.report.patches + solution.report.zones;
}

// Direct light has used its share of the elements allowed: further rounds would gain little.
bool full(const Solution& solution, const SolveOptions& options) {
    return static_cast<double>(leaves_of(solution)) >=
           0.75 * static_cast<double>(options.max_elements);
}

double mean(const Spectrum& values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

double sum(const Spectrum& values) {
    return mean(values) * static_cast<double>(values.size());
}

double most(const Spectrum& values) {
    return *std::max_element(values.begin(), values.end());
}

// Σ c x x' over the leaves, a value a band; x without what direct light counts in closed form.
Spectrum product(const Solution& a, const Solution& b) {
    const Enclosure& enclosure = *a.enclosure;
    const Forest& forest = a.forest;
    const Fields x = reflected_sources(a), y = reflected_sources(b);
    Spectrum result(enclosure.bands, 0.0);
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const ZoneId zone(z);
        const auto medium = forest.is_leaf(zone) ? medium_of(enclosure, forest, zone) : none;
        if (medium == none) continue;
        const Point centre = forest.centroid(zone);
        for (std::size_t k = 0; k < enclosure.bands; ++k)
            result[k] += 4.0 * enclosure.media[medium].extinction[k] * forest.volume(zone) *
                         x.at(zone, k).at(centre) * y.at(zone, k).at(centre);
    }
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!forest.is_leaf(patch) || side_of(enclosure, forest, patch) == none) continue;
        const Point centre = forest.centroid(patch);
        for (std::size_t k = 0; k < enclosure.bands; ++k)
            result[k] += forest.area(patch) * x.at(patch, k).at(centre) * y.at(patch, k).at(centre);
    }
    return result;
}

// The units' magnitudes, which errors are weighed by.
void measure(const std::optional<View>& view, UnitShots& shots) {
    const std::size_t count = shots.units.size();
    shots.picture.clear();
    shots.products.assign(count, std::vector<Spectrum>(count));
    for (std::size_t k = 0; k < count; ++k) {
        if (view) shots.picture.push_back(picture_radiance(shots.units[k], *view));
        for (std::size_t l = 0; l <= k; ++l)
            shots.products[k][l] = shots.products[l][k] = product(shots.units[k], shots.units[l]);
    }
}

// What refinement can mend, of what it weighs errors by: the picture's where there is one.
double elements_error(const UnitShots& shots, const SolveOptions& options, std::size_t scene) {
    const bool for_picture = options.refinement >= Refinement::view && !shots.picture.empty();
    const ErrorParts picture = for_picture ? superposed_picture_error(shots, scene) : ErrorParts{};
    return picture.elements > 0.0 ? picture.elements
                                  : superposed_solution_error(shots, scene).elements;
}

// The scene with the largest error.
std::size_t worst_scene(const UnitShots& shots, const SolveOptions& options, std::size_t scenes) {
    std::size_t worst = 0;
    for (std::size_t s = 1; s < scenes; ++s)
        if (elements_error(shots, options, s) > elements_error(shots, options, worst)) worst = s;
    return worst;
}

// (47), given the units' own errors and magnitudes, and the scene's magnitude.
ErrorParts combine(const UnitShots& shots, std::size_t scene, const std::vector<ErrorParts>& errors,
                   const std::vector<double>& magnitudes, double whole) {
    ErrorParts result;
    for (std::size_t k = 0; k < errors.size() && whole > 0.0; ++k) {
        const double share = most(shots.groups.groups[k].weights[scene]) * magnitudes[k] / whole;
        result.elements = std::hypot(result.elements, share * errors[k].elements);
        result.gathers += share * errors[k].gathers;
        result.coarse += share * errors[k].coarse;
    }
    return result;
}

// What makes the shots of one group, or of all of them in turn.
class Shooter {
  public:
    Shooter(const Enclosure& enclosure, const SolveOptions& options,
            const std::optional<View>& view, const ProgressCallback& progress, UnitShots& shots)
        : enclosure_(enclosure),
          options_(options),
          view_(view),
          progress_(progress),
          shots_(shots) {}

    Solution solve(const Scene& scene, Passes passes = {}) {
        passes.rows = rows_;
        ++shots_.solves;
        return solve_adaptively(
            lit_by(scene, enclosure_), options_, view_,
            [this](const Progress& now) {
                stopped_ = !report(progress_, now) || stopped_;
                return !stopped_;
            },
            passes);
    }
    // All groups on the mesh of a solution, which goes.
    void shoot(Solution mesh) {
        const auto& groups = shots_.groups.groups;
        shots_.units.clear();
        if (groups.size() <= 1) {
            shots_.units.push_back(std::move(mesh));  // every source at its largest
        } else {
            Passes frozen;
            frozen.begin_with = std::make_shared<const KeptMesh>(
                KeptMesh{mesh.enclosure->mesh, std::move(mesh.forest)});
            frozen.frozen = true;
            for (const SourceGroup& group : groups)
                shots_.units.push_back(solve(group.scene, frozen));
        }
        measure(view_, shots_);
    }
    bool stopped() const { return stopped_; }

  private:
    const Enclosure& enclosure_;
    const SolveOptions& options_;
    const std::optional<View>& view_;
    const ProgressCallback& progress_;
    UnitShots& shots_;
    bool stopped_ = false;
    // Sources differ, the rows do not.
    std::shared_ptr<SharedRows> rows_ = std::make_shared<SharedRows>();
};

void add(double weight, const Affine& function, Affine& sum) {
    sum.gradient += weight * function.gradient;
    sum.constant += weight * function.constant;
}

void add(const Spectrum& weights, const std::vector<Bend>& bends, std::vector<Bend>& sum) {
    sum.resize(bends.size());
    for (std::size_t k = 0; k < bends.size(); ++k) {
        const double weight = weights[k % weights.size()];
        if (bends[k].second == std::array<double, 6>{}) continue;  // it has no centre either
        for (std::size_t n = 0; n < 6; ++n) sum[k].second[n] += weight * bends[k].second[n];
        sum[k].centre = bends[k].centre;
        sum[k].mean += weight * bends[k].mean;
    }
}

void add(const Spectrum& weights, const LeafFields& fields, LeafFields& sum) {
    add(weights, fields.zone_bend, sum.zone_bend);
    add(weights, fields.patch_bend, sum.patch_bend);
    for (std::size_t k = 0; k < fields.zone.size(); ++k)
        add(weights[k % fields.bands], fields.zone[k], sum.zone[k]);
    for (std::size_t k = 0; k < fields.patch.size(); ++k)
        add(weights[k % fields.bands], fields.patch[k], sum.patch[k]);
}

void add(const Spectrum& weights, const std::vector<double>& values, std::vector<double>& sum) {
    sum.resize(values.size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k)
        sum[k] += weights[k % weights.size()] * values[k];
}

void add(double weight, const std::vector<float>& values, std::vector<float>& sum) {
    sum.resize(values.size(), 0.0f);
    for (std::size_t k = 0; k < values.size(); ++k)
        sum[k] += static_cast<float>(weight) * values[k];
}

void add(const Spectrum& weights, const Solution& unit, Solution& sum) {
    add(weights, unit.direct, sum.direct);
    add(weights, unit.indirect, sum.indirect);
    add(weights, unit.coarse.elements.emission, sum.coarse.elements.emission);
    add(weights, unit.coarse.radiance, sum.coarse.radiance);
    add(weights, unit.coarse.incident, sum.coarse.incident);
    add(weights, unit.coarse.incident_direct, sum.coarse.incident_direct);
    add(most(weights), unit.patch_error, sum.patch_error);
    add(most(weights), unit.zone_error, sum.zone_error);
    add(most(weights), unit.patch_direct_error, sum.patch_direct_error);
    for (const auto& [name, power] : unit.report.net_power)
        add(weights, power, sum.report.net_power[name]);
    for (const auto& [name, flux] : unit.report.net_flux)
        add(weights, flux, sum.report.net_flux[name]);
    for (const auto& [name, divergence] : unit.report.flux_divergence)
        add(weights, divergence, sum.report.flux_divergence[name]);
}

double larger(double a, double b) {
    return std::abs(b) > std::abs(a) ? b : a;
}

// The worst of the units, and every warning once.
void join_report(const Report& unit, Report& report) {
    report.closure_error = larger(report.closure_error, unit.closure_error);
    report.energy_balance = larger(report.energy_balance, unit.energy_balance);
    report.direct_power_check = larger(report.direct_power_check, unit.direct_power_check);
    report.solver.residual = larger(report.solver.residual, unit.solver.residual);
    report.solver.iterations = std::max(report.solver.iterations, unit.solver.iterations);
    report.solver.converged = report.solver.converged && unit.solver.converged;
    report.stopped = report.stopped || unit.stopped;
    for (const auto& warning : unit.warnings)
        if (std::find(report.warnings.begin(), report.warnings.end(), warning) ==
            report.warnings.end())
            report.warnings.push_back(warning);
}

}  // namespace

UnitShots shoot_units(std::span<const Scene> scenes, const Enclosure& enclosure,
                      const SolveOptions& options, const std::optional<View>& view,
                      const ProgressCallback& progress) {
    UnitShots shots;
    shots.groups = group_sources(scenes);
    Shooter shooter(enclosure, options, view, progress, shots);
    shooter.shoot(shooter.solve(shots.groups.largest));
    for (std::size_t round = 0; round < most_rounds && !shooter.stopped(); ++round) {
        if (shots.groups.groups.size() <= 1 || full(shots.units.front(), options)) break;
        const std::size_t worst = worst_scene(shots, options, scenes.size());
        if (elements_error(shots, options, worst) <= options.error) break;
        Passes passes;
        passes.begin_with =
            std::make_shared<const KeptMesh>(KeptMesh{enclosure.mesh, shots.units.front().forest});
        Solution finer = shooter.solve(scenes[worst], passes);
        if (shooter.stopped() || leaves_of(finer) <= leaves_of(shots.units.front())) break;
        shooter.shoot(std::move(finer));
    }
    return shots;
}

ErrorParts superposed_picture_error(const UnitShots& shots, std::size_t scene) {
    std::vector<ErrorParts> errors;
    std::vector<double> magnitudes;
    double whole = 0.0;
    if (shots.picture.empty()) return {};
    for (std::size_t k = 0; k < shots.groups.groups.size(); ++k) {
        const auto& own = shots.units[k].report.picture_error;
        errors.push_back(own ? *own : ErrorParts{});
        magnitudes.push_back(mean(shots.picture[k]));
        const Spectrum& weights = shots.groups.groups[k].weights[scene];
        for (std::size_t b = 0; b < weights.size(); ++b)
            whole += weights[b] * shots.picture[k][b] / static_cast<double>(weights.size());
    }
    return combine(shots, scene, errors, magnitudes, whole);
}

ErrorParts superposed_solution_error(const UnitShots& shots, std::size_t scene) {
    const auto& groups = shots.groups.groups;
    std::vector<ErrorParts> errors;
    std::vector<double> magnitudes;
    double square = 0.0;
    for (std::size_t k = 0; k < groups.size(); ++k) {
        errors.push_back(shots.units[k].report.solution_error);
        magnitudes.push_back(std::sqrt(sum(shots.products[k][k])));
        for (std::size_t l = 0; l < groups.size(); ++l)
            for (std::size_t b = 0; b < shots.products[k][l].size(); ++b)
                square += groups[k].weights[scene][b] * groups[l].weights[scene][b] *
                          shots.products[k][l][b];
    }
    return combine(shots, scene, errors, magnitudes, std::sqrt(std::max(0.0, square)));
}

Solution superposed(const UnitShots& shots, std::size_t index, const Scene& scene) {
    const Solution& first = shots.units.front();
    const std::size_t bands = first.enclosure->bands;
    Solution result;
    result.enclosure = lit_by(scene, *first.enclosure);
    result.forest = first.forest;
    result.direct_light = first.direct_light;
    result.direct.resize(result.forest, bands);
    result.indirect.resize(result.forest, bands);
    result.coarse.elements = first.coarse.elements;
    result.coarse.elements.emission.assign(first.coarse.elements.emission.size(), 0.0);
    result.report.patches = first.report.patches;
    result.report.zones = first.report.zones;
    result.report.solved_elements = first.report.solved_elements;
    result.report.reciprocity_error = first.report.reciprocity_error;
    result.report.smoothing = first.report.smoothing;
    result.report.solver.method = first.report.solver.method;
    result.report.solver.converged = true;
    const auto& groups = shots.groups.groups;
    for (std::size_t k = 0; k < shots.units.size(); ++k) {
        const Spectrum weights =
            k < groups.size() ? groups[k].weights[index] : Spectrum(bands, 0.0);
        add(weights, shots.units[k], result);
        join_report(shots.units[k].report, result.report);
    }
    Report& report = result.report;
    report.solution_error = superposed_solution_error(shots, index);
    if (!shots.picture.empty()) report.picture_error = superposed_picture_error(shots, index);
    report.estimated_error =
        report.picture_error ? report.picture_error->total() : report.solution_error.total();
    return result;
}

}  // namespace tyndall::radiosity
