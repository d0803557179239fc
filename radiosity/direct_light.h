// Direct light at a point: closed forms over the part of each emitter that it sees.
//
// Purpose: H^A of the one equation, light that comes straight from emitting surfaces, sun, point
//   and spot lights, with no random rays and no noise.
// Equations (per band, V: visible, τ: transmittance)
//                      in a medium                      on a surface
//   emitter:           H = 1/(4π) Σ ∫_V I_e τ dω        H = 1/π Σ ∫_V I_e τ cosθ dω     (1)
//   parallel sun:      H = E τ V / (4π)                 H = E τ V cosθ / π              (2)
//   point, spot:       H = I τ V / (4π r²)              H = I τ V cosθ / (π r²)         (3)
//   The visible part of an emitter is a set of convex polygons (mesh::Occluders); each contributes
//   its solid angle or Lambert's projected solid angle (closed_forms.h) times the mean of τ over
//   it, by cubature with the integrand's own weights. A sun with a diameter is a polygon at
//   infinity. Suns, points and spots in mirrors: image sources (mirrored_lights.h).
// Symbols: E irradiance across the beam [W/m^2], I intensity [W/sr], r distance [m].
// Valid for: Lambertian emitters, media homogeneous in each region. Where more than
//   `exact_occluders` overlap an emitter, visibility is sampled: deterministic in the point.
// Not valid for: H of a point light right at its position (grows as 1/r²).
// Cost: 1–3 µs an emitter in a room with a few dozen merged occluders; O(log n) culling.
// Source: Rushmeier (1991), split of direct light; Nishita & Nakamae (1985); Lambert (1760).
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "radiosity/enclosure.h"
#include "radiosity/place_memory.h"
#include "radiosity/shining_lights.h"

namespace tyndall::radiosity {

struct DirectLightOptions {
    // That overlap an emitter as seen from a point; beyond: sampled.
    std::size_t exact_occluders = 48;
    double optical_step = 0.5;     // optical depth over which τ is integrated in one go [-]
    std::size_t shadow_rays = 64;  // where visibility is sampled
    bool emitters = true;          // emitting surfaces too; else only sun, point and spot lights
};

// A part of the light that arrives at a point: the unit direction that it comes from, and ∫ I τ dω
// over it, one value a band [W/m^2].
using ArrivingPart = std::function<void(Direction towards, std::span<const double> irradiance)>;

// Every call is thread-safe and depends on its arguments alone. Keeps a reference to the enclosure.
class DirectLight {
  public:
    explicit DirectLight(const Enclosure& enclosure, const DirectLightOptions& options = {});
    ~DirectLight();
    DirectLight(DirectLight&&) noexcept;
    DirectLight& operator=(DirectLight&&) noexcept;

    // Nothing shines.
    bool empty() const;

    // H^A at x in a medium, `tet` the base tet that holds x; `incident` has one value a band and is
    // overwritten [W/m^2/sr].
    void at_zone(Point x, TetId tet, std::span<double> incident) const;

    // The same light by where it comes from, for phase functions: all that at_zone sums, as parts
    // that are `widest` across at most, seen from x, visible throughout; 4π H^A is their sum.
    // Where visibility is sampled, parts are those of the whole emitter, each with its mean share.
    void visit_zone(Point x, TetId tet, double widest, const ArrivingPart& visit) const;  // [rad]

    // H^A (irradiance / π) at x on a surface whose lit side looks along the unit normal n; `tet`
    // the base tet on that side.
    void at_patch(Point x, Direction n, TetId tet, std::span<double> incident) const;

    // From now on every value is kept in `memory` as well; null: none is.
    void keep_in(PlaceMemory* memory) { keep_ = memory; }
    // From now on values of `known` are taken where no body's sphere, of those in `moved` or of the
    // enclosure's own, comes between the place and a light. `known` is of the same lights, past the
    // same occluders but for the bodies of `moved`. `known` and `moved` must outlive this.
    void take_from(const PlaceMemory& known, const std::vector<mesh::Body>& moved);

    // Mirrors make more images of sun, point and spot lights than are followed: light is missing.
    bool cut_images() const;

    // Emitting surface sides first, then the scene's lights in order.
    const std::vector<LightPower>& powers() const;

  private:
    struct Data;
    bool is_known(Point x, Direction normal, std::span<double> incident) const;

    std::unique_ptr<Data> data_;
    PlaceMemory* keep_ = nullptr;
    const PlaceMemory* known_ = nullptr;
    std::vector<mesh::Body> moved_;
};

}  // namespace tyndall::radiosity
