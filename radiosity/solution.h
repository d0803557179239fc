// What a solve returns: the mesh, what its elements hold, and how good it is.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/exchange.h"
#include "radiosity/fields.h"
#include "radiosity/options.h"
#include "radiosity/solver_history.h"

namespace tyndall::radiosity {

// One turn of the loop: what was made, what it cost and gained.
struct PassReport {
    std::string stage;
    std::size_t patches = 0, zones = 0;  // leaves
    std::size_t rays = 0;                // walked in this pass
    double cpu_seconds = 0.0, wall_seconds = 0.0;
    std::size_t memory_bytes = 0;  // held by mesh, samples and rows
    double estimated_error = 0.0;  // [-]
};

// Of the last solve of the coarse solution: the worst of bands, their sums in shots and power.
struct SolverReport {
    std::string method;
    std::size_t iterations = 0;
    double residual = 0.0;
    bool converged = false;
    std::size_t shots = 0;            // of progressive refinement
    double unshot_power = 0.0;        // [W]
    std::vector<SolverStep> history;  // band after band
};

// Estimated relative errors, root mean squares, by their causes [-]. They do not know of each
// other, so their squares add up.
struct ErrorParts {
    double elements = 0.0;  // leaves too coarse for what they hold
    double gathers = 0.0;   // noise of the last gathers (gather_rays)
    double coarse = 0.0;    // noise and coarseness of the solution gathered from (rays, start)

    double total() const {
        return std::sqrt(elements * elements + gathers * gathers + coarse * coarse);
    }
};

// Of the leaves of a surface side or a medium, the mean by area or volume [K].
struct TemperatureRange {
    double mean = 0.0, lowest = 0.0, highest = 0.0;
};

struct Report {
    std::size_t patches = 0, zones = 0;  // leaves
    std::size_t solved_elements = 0;     // elements of the coarse solution
    std::vector<PassReport> passes;
    SolverReport solver;
    double closure_error = 0.0;                // max over rows [-]
    double reciprocity_error = 0.0;            // of the rows [-]
    std::optional<SmoothingReport> smoothing;  // of rows that were smoothed; the worst of bands
    double energy_balance = 0.0;               // imbalance over power brought in [-]
    double direct_power_check = 0.0;           // (received + escaped − emitted) / emitted [-]
    // Out of each surface side, medium; into outside [W].
    std::map<std::string, Spectrum> net_power;
    // The same over the area of each side, the volume of each medium.
    std::map<std::string, Spectrum> net_flux;         // [W/m^2]
    std::map<std::string, Spectrum> flux_divergence;  // [W/m^3]
    // Where temperatures have a meaning: of sides and media that can emit.
    std::map<std::string, TemperatureRange> temperature;
    // Of what refinement weighs errors by: the picture, or the solution where there is no view or
    // refinement does not ask for it [-].
    double estimated_error = 0.0;
    std::optional<ErrorParts> picture_error;  // where there is a view
    ErrorParts solution_error;
    std::size_t lost_rays = 0;
    bool stopped = false;  // by the caller, or at a limit
    std::vector<std::string> warnings;
};

// What elements hold, per element of the coarse solution and band, for files and balances.
struct ElementValues {
    Elements elements;
    std::vector<double> radiance;         // x [W/m^2/sr]
    std::vector<double> incident;         // H, direct light included [W/m^2/sr]
    std::vector<double> incident_direct;  // H^A [W/m^2/sr]
};

// The leaves' fields hold the incident radiance H (docs/theory.md), direct and indirect apart:
//   patch: I = e + rho (direct + indirect),  zone: J = e + Omega (direct + indirect).
struct Solution {
    std::shared_ptr<const Enclosure> enclosure;
    Forest forest;
    LeafFields direct, indirect;  // of every leaf [W/m^2/sr]
    // e of every leaf, where some side or medium settles its temperature in several bands
    // ([node * bands + band]); empty: that of the sides and media [W/m^2/sr].
    struct SettledEmission {
        std::vector<double> zone, patch;
    };
    SettledEmission settled;
    ElementValues coarse;
    DirectLightMode direct_light = DirectLightMode::closed_form;
    // Estimated error of each leaf's x, by node, all causes joined [W/m^2/sr].
    std::vector<float> patch_error, zone_error;
    std::vector<float> patch_direct_error;  // of H^A alone, by node: pictures compute it anew
    Report report;
};

// Whether any of its leaves' functions are quadratic.
inline bool is_quadratic(const Solution& solution) {
    return !solution.direct.zone_bend.empty() || !solution.indirect.patch_bend.empty();
}

// e of a leaf's one equation, and a: (1−Omega) J_e and Omega, or I_e and rho. Zero where nothing
// is.
double emission_of(const Solution& solution, ZoneId zone, std::size_t band);
double scatter_of(const Solution& solution, ZoneId zone, std::size_t band);
double emission_of(const Solution& solution, PatchId patch, std::size_t band);
double scatter_of(const Solution& solution, PatchId patch, std::size_t band);
// Of a, what walks that go on at mirrors find scattered evenly: all where they do not.
double scattered_of(const Solution& solution, PatchId patch, std::size_t band);

// e^A: emission of a patch that direct light counts in closed form; 0 else.
double split_emission_of(const Solution& solution, PatchId patch, std::size_t band);

// r of every leaf for gathers, coarsened: all it sends out but for the emission of surfaces that
// direct light counts in closed form, and for what mirrors reflect.
Fields reflected_sources(const Solution& solution);
// That emission, of every leaf on patches, for rays that mirrors have turned
// (GatherScene::set_in_mirrors) [node * bands + band]; empty where there are no mirrors.
std::vector<Affine> sources_in_mirrors(const Solution& solution);

}  // namespace tyndall::radiosity
