// What a solution's media send towards an eye, packed for walks along many rays.
#pragma once

#include <vector>

#include "radiosity/packed_zones.h"
#include "radiosity/solution.h"
#include "render/picture_parts.h"
#include "render/single_scattering.h"

namespace tyndall::render {

// A ray in both precisions.
struct SightRay {
    mesh::Ray ray;
    radiosity::PackedRay packed;

    explicit SightRay(const mesh::Ray& r) : ray(r), packed(r) {}
};

class SightZones {
  public:
    // Keeps a reference to the solution's enclosure. Cost: O(nodes); memory: 24 bytes a node and 36
    // a node and band, 76 with quadratic functions, in whole cache lines.
    explicit SightZones(const radiosity::Solution& solution);

    // Purpose: adds what a ray gains between two distances in a base tet of a medium, and takes the
    //   tet's transmittance. False where so little is left that the rest does not show.
    // Equation: ∫ T κ J ds of every leaf that is crossed, J linear or quadratic in it, in closed
    //   form (4), (68); as SeenSolution::cross, in single precision: 1e-5 of a leaf's J.
    // `scattered`: looks at single scattering anew where it would show, and what a leaf's direct
    //   light leaves out is added `anew` times: by one ray for several [-]; null: not at all.
    bool cross(const SightRay& ray, mesh::TetId tet, double t_in, double t_out, Seen& seen,
               const SingleScattering* scattered = nullptr, double anew = 1.0) const;

  private:
    struct alignas(64) Line {
        float values[16];
    };
    const float* leaf(std::uint32_t zone) const { return lines_[zone * stride_].values; }
    // `scattered`: null, or ∫ κ T H^A dt over the leaf, one value a band.
    bool gain(const SightRay& ray, std::uint32_t zone, mesh::TetId tet, float t_in, float t_out,
              const double* scattered, double anew, Seen& seen) const;

    const radiosity::Enclosure& e_;
    std::size_t bands_;
    bool bent_;                     // direct light is quadratic
    std::size_t numbers_, stride_;  // of a band; lines a node
    std::vector<radiosity::PackedZone> zones_;
    std::vector<Line> lines_;
};

}  // namespace tyndall::render
