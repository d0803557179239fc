// The sources of scenes that differ in emissions alone, in groups that keep step with each other.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace tyndall::radiosity {

// Sources whose emissions are the same multiples of their largest in every scene.
struct SourceGroup {
    std::vector<std::string> sources;  // "material \"lamp\""
    Scene scene;                       // these at their largest, all others dark
    std::vector<Spectrum> weights;     // of each scene: a value a band, 0 to 1 [-]
};

struct SourceGroups {
    Scene largest;                    // every source at its largest over the scenes, band by band
    std::vector<SourceGroup> groups;  // in the order of their first sources; dark ones left out
};

// Purpose: scene s is Σ over groups of weights[s] times the group's scene, in every band (46). What
//   does not change is one group, of weight 1.
// Requires: at least one scene; scenes that differ in emission alone (compare_scenes.h).
// Cost: O(scenes × sources).
SourceGroups group_sources(std::span<const Scene> scenes);

}  // namespace tyndall::radiosity
