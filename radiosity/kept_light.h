// What a solve keeps for scenes in which bodies have moved, and what these make of it.
#pragma once

#include <memory>
#include <string>

#include "radiosity/coarse_solution.h"
#include "radiosity/gather.h"
#include "radiosity/importance.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {

// What gathers find in the coarse elements, by which changes of light are told
// ([element * bands + band]) [W/m^2/sr].
struct GatheredFrom {
    std::vector<double> sent;     // r, of patches less what they reflect of direct light
    std::vector<double> by_lit;   // H from what patches reflect of it
    std::vector<double> by_rows;  // H that rows bring
};

// Filled by a solve (Passes::keep); the same for all scenes that begin with it (Passes::moved).
struct KeptLight {
    explicit KeptLight(std::size_t bands) : direct(bands), gathers(2 * bands + 1) {}

    bool empty() const { return !enclosure; }
    // What is kept of the coarse solution, given H^A of its elements and H from lit patches.
    void take(const CoarseSolution& coarse, const std::vector<double>& incident_direct,
              const std::vector<double>& incident_lit);
    // The last of what is kept: r of the leaves that was gathered from, and the places' values.
    void finish(std::shared_ptr<const Enclosure> of, const Forest& leaves, Fields zone_sources,
                Fields patch_sources, double detail);
    std::size_t memory() const;

    std::shared_ptr<const Enclosure> enclosure;
    Forest coarse_forest;  // whose leaves are the coarse solution's elements
    Elements elements;
    std::shared_ptr<const RowSet> rows;  // null until taken
    std::vector<glm::vec3> directions;   // of their rays (exchange_moved.h)
    GatheredFrom gathered_from;
    std::vector<double> lit_in_middles;  // incident_lit.h
    std::vector<double> coarse_errors;   // error_estimate.h
    IndirectRefiner::Ends settled;
    Importance::Scale scale;
    std::shared_ptr<const BrightPlaces> bright;  // that gathers' rays were aimed at
    PlaceMemory direct;                          // H^A at every place it was asked for
    PlaceMemory gathers;  // mean and half difference a band, the seed's number
    Forest forest;        // in the end
    // What was gathered from in zones, and on patches.
    std::unique_ptr<const GatherScene> in_zones, on_patches;
};

// Why a solve by these options keeps no light for bodies that move, as the end of a sentence that
// begins with "it"; empty: it does.
std::string why_nothing_kept(const SolveOptions& options);

// Whether a solve of this enclosure can begin with it: the same mesh, bodies of the same triangles.
bool fits(const KeptLight& kept, const Enclosure& enclosure);

// Of a solution, given H^A of its elements and H from lit patches ([element * bands + band])
// [W/m^2/sr].
GatheredFrom gathered_from(const CoarseSolution& coarse, const std::vector<double>& incident_direct,
                           const std::vector<double>& incident_lit);

// H from lit patches of each element after bodies have moved (incident_lit.h).
std::vector<double> moved_incident_lit(const KeptLight& before, const Enclosure& enclosure,
                                       const Forest& forest, const Elements& elements,
                                       const LitPatches& lit);

// Gathers in a scene after its bodies have moved, from those before.
//
// Equation: with D rays, of which `m` meet a body's sphere before or now,
//     H = H⁰ + (1 − m/D) ΔH + P − P⁰ + (1/D) Σ_m (L − L⁰)                              (49)
//     ΔH_i = Σ_j S_ij⁰ (r_j − r_j⁰) / c_i                                               (50)
//   and far from all bodies
//     H_i = H_i⁰ + Σ_j (S_ij r_j − S_ij⁰ r_j⁰) / c_i + P − P⁰                           (66)
//   whose sums the solutions have: H by rows.
// Symbols: L⁰ what a ray found before, L what it finds now.
//   The sum over rays is exact. ΔH, what other rays find more or less since all light has changed a
//   little, and P, what lit patches bring, are the coarse solution's, linear in its elements.
//   Far: where a body hides the share f of all directions, at a distance d from an element of size
//   h, what is linear over the element misses about f (h/d)²/8; it may miss a tenth of the goal.
class GatherChange {
  public:
    // The scene now.
    struct Now {
        const Enclosure& enclosure;
        GatheredFrom gathered_from;
    };
    // `error`: the solve's goal. Keeps `before`.
    GatherChange(const KeptLight& before, const Now& now, double error);

    // H at a point, one value a band; false where it is to be gathered anew: nothing was kept, or a
    // body is within a quarter of an element's size, or met by more than two fifths of the rays, or
    // by one that is aimed at an opening.
    // Thread-safe; `walked` rays are counted, two for each that meets.
    bool gather(const GatherScene& now, const GatherPoint& point, const PointSet& points,
                std::uint64_t seed, std::span<Gathered> incident, std::size_t& walked) const;

  private:
    bool meets(const mesh::Ray& ray) const;
    bool inside(Point x) const;
    bool far(Point x, double size) const;
    // The element that a gather's point lies in.
    std::uint32_t element_at(const GatherPoint& point) const;

    const KeptLight& before_;
    std::vector<mesh::Body> bodies_;  // before and now
    // ΔH, P − P⁰ and the whole change far from bodies [element * bands + band].
    std::vector<Affine> of_sources_, of_lit_, far_;
    std::size_t bands_;
    double may_miss_;  // far from bodies, relative
};

}  // namespace tyndall::radiosity
