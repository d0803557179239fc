// Lights as paths look for them: one is chosen by its power, and a place on it at random.
#pragma once

#include <span>
#include <vector>

#include "radiosity/enclosure.h"
#include "render/random_numbers.h"

namespace tyndall::render {

using mesh::Direction;
using mesh::Point;
using radiosity::Spectrum;

// A place that light may come from, chosen once and looked at from any point.
struct LightPlace {
    std::uint32_t light = 0;
    Point at{0.0};           // of lights that have a place [m]
    Direction towards{0.0};  // of those at infinity
    bool infinite = false;
};

// What it sends to a point, if nothing is in between.
struct FromLight {
    Direction direction{0.0};  // to the light
    double distance = 0.0;     // infinite: sun, environment [m]
    // Per solid angle, of choosing this direction; 0: point, spot and parallel sun, which no other
    // way finds [1/sr].
    double density = 0.0;
    bool direct = true;   // what solutions call direct light: all but the environment
    bool facet = false;   // from an emitting surface
    Spectrum irradiance;  // across the direction, over the probability of the choice [W/m^2]
};

// Purpose: next-event estimation (Kajiya 1986; Shirley, Wang & Zimmerman 1996): emitting facets,
// sun
//   (parallel, or a disc of uniform radiance), point and spot lights, the environment.
// Probabilities go with power: π A I of a facet, 4π 𝓘 of a point, the hull's cross section times E
//   of a sun, π times the hull's area times the radiance of the environment.
class PathLights {
  public:
    // Keeps a reference to the enclosure.
    explicit PathLights(const radiosity::Enclosure& enclosure);

    bool empty() const { return lights_.empty(); }
    // A light and a place on it.
    LightPlace choose(RandomNumbers& random) const;
    // What arrives at x from there; false: nothing does.
    bool from(const LightPlace& place, Point x, FromLight& result) const;

    // The density, per solid angle, with which `choose` finds what a ray has met: a facet at a
    // distance under a cosine; 0 for what it never chooses [1/sr].
    double density(mesh::FacetId facet, mesh::Side side, double distance, double cosine) const;
    // The environment [1/sr].
    double environment_density() const;
    // A sun's disc in that direction: its density [1/sr]; radiance is added [W/m^2/sr].
    double sun_disc(Direction direction, std::size_t sun, std::span<double> radiance) const;
    std::size_t sun_count() const { return suns_.size(); }

  private:
    enum class Kind { facet, sun_parallel, sun_disc, point, spot, environment };
    struct OneLight {
        Kind kind;
        double probability = 0.0;
        std::uint32_t index = 0;  // facet × 2 + side; of Enclosure::lights
        double density = 0.0;     // per area of a facet [1/m^2], per solid angle of a disc [1/sr]
    };

    void add(Kind kind, std::uint32_t index, double power, double measure);

    const radiosity::Enclosure& e_;
    std::vector<OneLight> lights_;
    std::vector<double> cumulated_;
    std::vector<std::uint32_t> of_facet_;  // facet × 2 + side → light; none
    std::vector<std::uint32_t> suns_;      // discs: light
    double environment_ = 0.0;             // probability
};

}  // namespace tyndall::render
