// Quantities at points that a caller chooses.
#pragma once

#include <limits>

#include "radiosity/direct_light.h"
#include "radiosity/gather.h"
#include "radiosity/solution.h"

namespace tyndall::radiosity {

struct ProbeOptions {
    std::size_t rays = 4096;  // gathered along at each point; a power of two is best
    std::uint64_t seed = 1;
};

// One value a band each.
struct ZoneValues {
    Spectrum source, source_direct;      // J and the part a H^A of it; 0 in empty space [W/m^2/sr]
    Spectrum incident, incident_direct;  // G = 4 pi (H^A + H^I), and 4 pi H^A [W/m^2]
    // Of the medium, where the scene has temperatures; NaN else, and where nothing emits [K].
    double temperature = std::numeric_limits<double>::quiet_NaN();
};
struct PatchValues {
    Spectrum irradiance, irradiance_direct;  // E = pi (H^A + H^I), and pi H^A [W/m^2]
    // Of the wall's side, likewise; NaN also of a plane that is no wall [K].
    double temperature = std::numeric_limits<double>::quiet_NaN();
};

// Purpose: J, G and E right at a point, finer than the elements: direct light by its closed forms
//   there, indirect light gathered there from what the solution's elements send out.
// Equations: (1) of direct_light.h for H^A, (4) of gather.h for H^I; J = e + a (H^A + H^I);
//   temperatures (43) of what the element there emits and of H at the point.
// Every call is thread-safe and depends on its arguments alone; two points never share their
// noise's seed with their place in a list. Keeps a reference to the solution. Cost: the fields
// once, O(nodes); then `rays` walks a point.
class Probe {
  public:
    explicit Probe(const Solution& solution, const ProbeOptions& options = {});

    // At a point in a medium or in empty space.
    // Errors: mesh::InputError for a point outside the hull or in a solid.
    ZoneValues in_space(Point x) const;

    // On the side that `normal` (of any length) looks to, of a wall or of a plane thought at x.
    // Errors: the same, and a normal without length.
    PatchValues on_surface(Point x, Direction normal) const;

  private:
    struct Place {
        Point x;
        TetId tet;
    };
    Place place(Point x, Direction normal) const;
    Point off_faces(Point x, TetId tet) const;
    FacetId wall_at(Point x, Direction normal, TetId tet) const;
    std::vector<Gathered> gathered(const Place& place, Direction normal) const;

    const Solution& solution_;
    ProbeOptions options_;
    GatherScene scene_;
    std::optional<BrightPlaces> bright_;
    DirectLight light_;
    PointSet points_;
    double step_;  // off a wall [m]
};

}  // namespace tyndall::radiosity
