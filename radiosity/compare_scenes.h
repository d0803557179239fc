// What has changed from one scene to the next, and with it what must be computed anew.
#pragma once

#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace tyndall::radiosity {

// By what it costs: each kind may hold the ones before it as well.
enum class SceneChange {
    nothing,   // the solution is the same
    emission,  // sources are brighter or darker: the one equation is linear in them (46)
    lights,    // where they stand, how they are turned, what shape their light has
    optics,    // extinction, albedo, reflectance: exchange areas, or the equation itself
    geometry,  // surfaces, what they are made of, which regions media fill
};

struct SceneDifference {
    SceneChange change = SceneChange::nothing;
    std::vector<std::string> what;  // "emission of material \"lamp\"", in the scene's order
};

// Purpose: the difference of two scenes that are given in the same order: the n-th material, say,
//   is compared with the n-th. Whatever messages alone speak of (title, places) does not count. A
//   source that is there in one scene alone counts as optics, even where it is dark: heat = 0 is
//   radiative equilibrium. Where temperatures are found (a flux or heat is given, or asked for),
//   how they share out power over bands is not linear: a changed emission counts as optics. Shapes
//   of extinction are compared by their places alone. Viewpoints tell solid regions from others:
//   other viewpoints are another geometry.
// Cost: O(corners of all polygons).
SceneDifference compare_scenes(const Scene& before, const Scene& after);

}  // namespace tyndall::radiosity
