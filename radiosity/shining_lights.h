// The lights of an enclosure as direct light takes them: polygons that shine evenly, beams, points,
// spots; what each sends out, and where it is.
#pragma once

#include <string>
#include <vector>

#include "mesh/visible_polygon.h"
#include "radiosity/enclosure.h"
#include "radiosity/light_cone.h"

namespace tyndall::radiosity {

// A convex polygon of constant radiance, at its place or (the sun) at infinity.
struct AreaLight {
    std::vector<Point> corners;  // counter-clockwise seen from where it shines to
    Direction normal{0};         // to where it shines
    mesh::Reach reach = mesh::Reach::finite;
    Spectrum radiance;  // [W/m^2/sr]
};

// What a light sends out; of a sun, what enters the enclosure through its hull.
struct LightPower {
    std::string name;  // of the surface side or the light
    Spectrum power;    // [W]
};

struct ShiningLights {
    std::vector<AreaLight> areas;  // emitters, and suns with a diameter
    std::vector<Sun> beams;        // without one; directions are unit
    std::vector<PointLight> points;
    std::vector<SpotLight> spots;
    std::vector<LightCone> cones;    // of all these, in their order
    std::vector<LightPower> powers;  // of emitters and of lights, dark ones too

    bool empty() const { return areas.empty() && beams.empty() && points.empty() && spots.empty(); }
};

// Whether anything in it is not 0.
bool shines(const Spectrum& spectrum);

// Corners that are nearer to each other than this share of the mesh's diagonal are one [-].
inline constexpr double merge_tolerance = 1e-11;

// Purpose: what shines. `emitters`: sides that emit are lights, too; their facets are merged to
//   convex polygons, corners within `tolerance` of the mesh's diagonal being one.
// Cost: O(tets + facets).
ShiningLights shining_lights(const Enclosure& enclosure, bool emitters, double tolerance);

}  // namespace tyndall::radiosity
