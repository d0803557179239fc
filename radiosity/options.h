// What a caller can choose about a solve; plain data with defaults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/types.h"

namespace tyndall::radiosity {

// Where light of emitting surfaces is counted.
enum class DirectLightMode {
    closed_form,  // split off and integrated over the visible part of each emitter
    // With all other light, through the exchange areas; sun, point and spot lights stay closed
    // form.
    rows,
};

enum class Refinement {
    none,      // the initial mesh
    uniform,   // every element down to `element_size`
    adaptive,  // where the recomputed radiance departs from what the element holds
    view,      // so, weighed by what that does to the camera's picture, if there is a camera
    aligned,   // so, and bisected along shadow boundaries that are sharper than the leaves
};

// The mesh that the coarse solution begins with.
enum class Start {
    single_zone,  // one zone a medium, the input surfaces as patches
    base,         // the base tetrahedra and facets
    uniform,      // these bisected down to `element_size`, or to what a room needs
    mesh,         // the user's own tetrahedra
};

// What an element holds.
enum class Radiance {
    constant,   // its mean
    linear,     // a linear function with that mean
    quadratic,  // leaves: a quadratic one, of direct light in zones and indirect light on patches
};

// An error of an element that is judged, see indicators.h [W/m^2/sr].
struct JudgedElement;
using Indicator = std::function<double(const JudgedElement&)>;

// How the places and directions of sampled methods are spread.
enum class PointSetKind {
    sobol,        // Sobol's points, scrambled after Owen
    independent,  // each for itself
    stratified,   // jittered: one in each cell of a grid as far as their number allows
};

// How the methods that project onto cubes find what a pixel sees.
enum class Projection {
    z_buffer,  // surfaces into an item buffer, zones into one with depths
    walked,    // a walk through the pixel's middle
};

// How reciprocity and closure are made to hold together after the rows are made.
enum class Smoothing {
    none,
    least_squares,  // the least change that does it, weighed by the entries
    scaling,        // symmetric factors of rows and columns
};

// Where progressive refinement takes the exchange areas of a shot from.
enum class Shots {
    rows,        // from the rows of all elements, made first and kept: their columns
    on_the_fly,  // the shooter's row is made when it shoots, used as its column, and forgotten
};

// What the methods for exchange areas can be told, beside rays and seed; each reads what it has a
// use for.
struct ExchangeSettings {
    PointSetKind point_set = PointSetKind::sobol;
    double tolerance = 1e-6;  // relative error of an exchange area, where a method can keep one [-]
    std::size_t resolution = 64;  // pixels along an edge of a cube, or of the single plane
    std::size_t centres = 1;      // cubes an element
    bool random_offsets = false;  // cubes stand and turn by chance, not all alike
    Projection projection = Projection::z_buffer;
    bool uniform_transmittance = false;  // one transmittance a pair, where a method needs that
    double interaction_radius = 0.0;     // pairs farther apart are left out; 0: none [m]
    Smoothing smoothing = Smoothing::none;

    bool operator==(const ExchangeSettings&) const = default;
};

struct SolveOptions {
    double error = 0.01;  // goal: estimated relative error of the picture, or of the solution [-]
    std::string exchange = "walked";  // method for exchange areas (exchange_methods.h)
    ExchangeSettings exchange_settings{};
    std::string solver = "gmres";  // method for the linear system (solvers.h)
    double over_relaxation = 1.0;  // of jacobi and gauss_seidel, 0 to 2 [-]
    Shots shots = Shots::rows;     // of progressive_refinement
    bool overshooting = false;     //   shoots what is foreseen to arrive as well
    bool ambient = false;          //   adds the ambient estimate where it ends before its tolerance
    Start start = Start::uniform;
    Refinement refinement = Refinement::aligned;
    // By which errors leaves are bisected, by name (indicators.h), from Refinement::adaptive on.
    std::vector<std::string> indicators{"direct", "shadow_boundary", "indirect"};
    // The caller's own, beside those; called in the order of leaves.
    std::shared_ptr<const Indicator> indicator{};
    double optical_thickness = 0.5;  // extinction × size: coarse zones below are thin enough [-]
    Radiance radiance = Radiance::linear;
    DirectLightMode direct_light = DirectLightMode::closed_form;
    double element_size = 0.0;  // longest edge of the first elements [m]; 0: chosen from the scene
    std::size_t max_elements = 150000;    // leaves, patches and zones together
    std::size_t max_memory = 2ull << 30;  // [byte]
    double max_time = 0.0;                // wall time; 0: no limit [s]
    std::size_t max_passes = 100;         // rounds of refinement, each of which may halve a leaf
    std::size_t rays = 256;               // walked from each element for its row
    // theta: rays deposit in ancestors of size ≤ theta t sqrt(4 pi / rays); 0: in the elements
    // alone [-]
    double row_detail = 0.0;
    std::size_t promotions = 0;  // times the fine mesh is promoted and solved anew
    // Of the last, fine gather: from a point of a surface; a quarter as many in zones.
    std::size_t gather_rays = 256;
    double solver_tolerance = 1e-6;  // relative residual [-]
    std::size_t solver_iterations = 200;
    std::uint64_t seed = 1;
    std::size_t threads = 0;  // 0: all

    bool operator==(const SolveOptions&) const = default;
};

}  // namespace tyndall::radiosity
