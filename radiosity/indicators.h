// Error indicators of surface and volume elements, by name.
//
// What is looked at                                        name, and where it acts
//   direct light at points of a leaf against its linear    "direct": leaves (refine.h)
//   function
//   the jump of direct light where a shadow's edge         "shadow_boundary": leaves, with
//   crosses a leaf                                         Refinement::aligned (shadow_cuts.h)
//   light gathered from the coarse solution at points of   "indirect": leaves (refine.h)
//   an element, beyond the gather's noise, against its
//   linear function
//   what a leaf and its neighbours hold on both sides of   "jump": leaves
//   their faces
//   J that changes over a zone of many optical depths      "optical_thickness": zones of the coarse
//                                                          solution, before it is made
// An error [W/m^2/sr] is weighed by power, or by what it does to the camera's picture
// (importance.h). Of several indicators of one leaf the largest share counts.
#pragma once

#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "radiosity/element_mesh.h"
#include "radiosity/fields.h"
#include "radiosity/options.h"

namespace tyndall::radiosity {

// A leaf, and what is known when it is judged.
struct JudgedElement {
    const Enclosure& enclosure;
    const ElementMesh& mesh;
    const Forest& forest;
    const Fields& radiance;  // r of all leaves: direct light, and indirect of the coarse solution
    std::variant<ZoneId, PatchId> node;
};

struct NamedIndicator {
    std::string_view name;
    Indicator error;  // empty: measured at the refiners' own samples
};

// All there are, in the order of the table above.
const std::vector<NamedIndicator>& indicators();
// Purpose: whether `options` asks for one of them.
bool asks_for(const SolveOptions& options, std::string_view name);
// Errors: mesh::InputError for a name that there is not, optical_thickness that is not above 0.
void check_indicators(const SolveOptions& options);

// Purpose: what an element's function departs by from its neighbours' where they meet, beside the
//   true jumps of sharp shadows and of surfaces that bend.
// Equation: δ = ½ √(Σ_f (x(c_f) − x_f(c_f))² / n), over the n faces f (edges of a patch) that have
// a
//   neighbour in the same medium (of the same surface side), c_f the face's centroid, x_f the
//   function of the leaf beyond it. Mean over bands [W/m^2/sr].
// Cost: O(depth of the forest) a face.
double jump_error(const JudgedElement& element);

// Purpose: what one J a zone does to light that crosses an optically thick zone; 0 for patches.
// Equation: δJ = (1 − e^{−0.29 κ h}) h |∇J|, h = V^{1/3}. Mean over bands [W/m^2/sr]. (28)
//   Fitted to what is measured of slabs (docs/limits.md): of the flux q/π = 4/(3κ) |∇J| it is 5 %
//   at κh = 0.5, 19 % at 1, and 3κh/4 in the thick limit.
double thickness_error(const JudgedElement& element);

// By node: the largest of the errors that indicators find, on leaves [W/m^2/sr].
struct IndicatedErrors {
    std::vector<float> zone, patch;
};

// Purpose: the errors of all leaves by `asked`, one after the other, in the caller's thread.
// Errors: mesh::InputError if an error is negative or not finite.
IndicatedErrors indicated_errors(const std::vector<Indicator>& asked, const Enclosure& enclosure,
                                 const ElementMesh& mesh, const Fields& radiance);

}  // namespace tyndall::radiosity
