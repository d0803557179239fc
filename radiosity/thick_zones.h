// The indicator "optical_thickness": zones of the coarse solution that are too thick for one J.
#pragma once

#include "radiosity/importance.h"
#include "radiosity/indicators.h"

namespace tyndall::radiosity {

// Whether a zone is a leaf of more than `thickness` optical depths, V^{1/3} κ, in some band.
bool is_thick(const Enclosure& enclosure, const Forest& forest, ZoneId zone, double thickness);
bool any_thick(const Enclosure& enclosure, const ElementMesh& mesh, double thickness);

struct ThicknessGoal {
    double thickness = 0.5;      // zones below are left alone [-]
    double squared_error = 0.0;  // that may remain: Σ weight thickness_error² [-]
    std::size_t max_elements = 0;
};

// Purpose: bisects thick zones, longest edge first, those of the largest shares first, until the
//   goal is met, no thick zone has more than its part of it, or there are enough leaves.
// `radiance`: r of the leaves; new ones take over their parents' functions.
void bisect_thick_zones(const Enclosure& enclosure, ElementMesh& mesh, const Importance& importance,
                        Fields radiance, const ThicknessGoal& goal);

}  // namespace tyndall::radiosity
