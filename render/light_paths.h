// Paths from the camera to lights, through media and over surfaces.
#pragma once

#include <functional>

#include "mesh/walk.h"
#include "render/path_lights.h"
#include "render/path_media.h"
#include "render/picture_parts.h"
#include "render/surface_scattering.h"

namespace tyndall::render {

// Where a path is handed over to a solution.
struct PathEnd {
    Point x{0.0};
    mesh::FacetId facet{};  // of a surface; none: in a medium
    mesh::Side side = mesh::Side::front;
    Direction normal{0.0};
};

// What stands in for all that a path would find beyond a number of bounces.
struct PathEnding {
    // Scatterings by media that are followed; the last of them is the ending's, as is any
    // reflection by a Lambertian surface. At least 1.
    std::size_t scatterings = 1;
    // Incident radiance straight from lights on a surface, cosine-weighted [W/m²/sr].
    std::function<void(const PathEnd&, Coefficients, std::span<double>)> direct;
    // Radiance from a direction, lights that count as direct apart [W/m²/sr].
    std::function<void(const PathEnd&, Direction, std::span<double>)> gather;
    bool emitters_are_direct = true;
    // The path goes on from the first Lambertian surface that it meets without a scattering, as far
    // as `scatterings` of it, to the next surface: for media that do not scatter evenly.
    bool through_media = false;
    // All that arrives on that surface, as the solution's elements hold it, cosine-weighted
    // [W/m²/sr].
    std::function<void(const PathEnd&, std::span<double>)> incident;
};

// Purpose: an unbiased sample of the radiance along a ray, by its parts.
// Method: the path goes from the eye; collisions in media are drawn by transmittance, of bands by
//   their share in what the path still carries; Russian roulette from the third bounce. At every
//   vertex one light is looked for (next-event estimation), and once more from a place along the
//   ray that is drawn equiangularly about it. What two or three of these ways find is weighed by
//   the power heuristic of their densities:
//     surface:  light | lobe;    medium: distance × light | light × equiangular | distance × phase
//     (54)
//   Emission of media is added along every ray in closed form.
// Not found: what a mirror throws of point lights and of suns without a diameter (no path meets
//   them); a rough one does.
// With an ending, paths stop at the first Lambertian surface (or the second, see `through_media`),
// or
//   at its last scattering: surfaces take direct light and one ray of the rest from it; media look
//   for lights through reduced extinction, as it does.
// Source: Kajiya (1986); Veach & Guibas (1995); Kulla & Fajardo (2012).
class LightPaths {
  public:
    // Keeps references to both; `ending` may be null.
    explicit LightPaths(const radiosity::Enclosure& enclosure, const PathEnding* ending = nullptr);

    // Adds what is seen along a ray from the camera. Thread-safe.
    void sample(const mesh::Ray& ray, RandomNumbers& random, Seen& seen) const;

    bool specular() const { return scattering_.specular(); }

  private:
    class Walk;

    const radiosity::Enclosure& e_;
    radiosity::FacetHits hits_;
    PathMedia media_;
    PathLights lights_;
    SurfaceScattering scattering_;
    const PathEnding* ending_;
};

}  // namespace tyndall::render
