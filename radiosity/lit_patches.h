// Light that directly lit patches reflect, gathered at a point without random directions.
//
// Purpose: where a beam meets a wall it makes a small bright source. Rays of a gather find it by
//   luck; here it is looked at on purpose, so that the rays carry only what is smooth.
// Equation: H = Σ_nodes r̄ F(x, node) τ V, over nodes of the patches' bisection trees that are small
//   as seen from x; F in closed form (closed_forms.h), r̄ the mean of r^A = ρ H^A over the node, τ
//   and V towards one point of the node, chosen at random but the same for every x, so that H is
//   smooth where nothing is in the way.
// Valid for: Lambertian patches, any occlusion. Unbiased in V; r̄ and τ vary little over a node that
//   is accepted.
// Cost: O(log patches) nodes a point, one shadow ray each.
// Source: hierarchical radiosity (Hanrahan, Salzman & Aupperle 1991), the light trees of Walter et
//   al. (2005).
#pragma once

#include <span>
#include <vector>

#include "mesh/tet_planes.h"
#include "radiosity/bright_cones.h"
#include "radiosity/fields.h"
#include "radiosity/mean_transmittance.h"
#include "radiosity/occlusion.h"

namespace tyndall::radiosity {

class LitPatches {
  public:
    // `lit`: r^A of the leaves on patches [W/m^2/sr]. Copies what it needs of the forest; keeps a
    // reference to the enclosure. Cost: O(patch nodes).
    LitPatches(const Enclosure& enclosure, const Forest& forest, const Fields& lit);

    bool empty() const { return roots_.empty(); }

    // Adds H from lit patches at a receiver, one value a band [W/m^2/sr]; without what the rays
    // aimed along `cones` bring. Thread-safe; depends on its arguments alone.
    void gather(const Receiver& receiver, std::span<double> incident,
                const BrightCones* cones = nullptr) const;

  private:
    struct Node {
        std::array<Point, 3> corners;
        Point centroid;
        double longest_edge, area;  // [m], [m^2]
        std::array<std::uint32_t, 2> children{none, none};
    };
    struct Triangle;
    class Visit;

    std::uint32_t add(const Forest& forest, const Fields& lit, PatchId patch);

    const Enclosure& enclosure_;
    std::size_t bands_;
    std::vector<Node> nodes_;
    std::vector<Affine> radiance_;  // [node * bands + band]; constant on inner nodes
    std::vector<std::uint32_t> roots_;
    std::vector<Direction> normals_;  // of each root
    // The tet that the front of a root looks into: where walks to its points end.
    struct Front {
        mesh::WalkStart start;
        mesh::TetPlanes planes;
        std::uint32_t facet_side = none;  // of a body, which stands in many tets; else none
    };
    std::vector<Front> fronts_;  // of each root
    double typical_ = 0.0;       // Σ r̄ A over the area of all surfaces [W/m^2/sr]
    OpticalDepth depth_;
    Occlusion occlusion_;
};

}  // namespace tyndall::radiosity
