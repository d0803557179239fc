// Means of direct light over leaves that a fixed rule of few points does not do justice, and the
// linear or quadratic functions that fit it best.
//
// Purpose: the corners and the centroid of a leaf that straddles a shadow's edge may all lie in the
//   dark, and do so more often than not where light falls in thin strips: whole meshes then miss
//   light with the same sign. Points spread over the leaf have no such preference. Nor does a
//   function through a zone's corners follow what is between them: one that has the least squares
//   from it leaves less error along a ray (docs/theory.md, (67)).
// Equation: H̄ = Σ_k H(x_k) / N, x_k a scrambled net, uniform on the leaf, seeded by its node;
//   of zones Σ_k (Σ_i φ_i(x_k) h_i − H(x_k))² → min, then shifted to the mean H̄; φ the linear
//   (λ_i) or quadratic Lagrange functions of the tet.
// Cost: N = 32 evaluations of direct light a leaf, 64 of a zone with a quadratic function.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/direct_light.h"
#include "radiosity/fields.h"

namespace tyndall::radiosity {

// Keeps references to its arguments. The same at any number of threads.
class SampledMeans {
  public:
    SampledMeans(const Enclosure& enclosure, const Forest& forest, const DirectLight& light,
                 bool quadratic)
        : enclosure_(enclosure), forest_(forest), light_(light), quadratic_(quadratic) {}

    // Samples the leaves that have not been sampled yet, in parallel.
    void add(const std::vector<ZoneId>& zones) { add(zones, zones_); }
    void add(const std::vector<PatchId>& patches) { add(patches, patches_); }

    // One value a band; null if the node has not been sampled [W/m^2/sr].
    const double* of(ZoneId zone) const { return find(zones_, zone.value); }
    const double* of(PatchId patch) const { return find(patches_, patch.value); }
    // H^A of a zone, fitted, one function a band, without a bend where they are to be linear; null
    // likewise [W/m^2/sr]. It may be below zero in a corner.
    const LeafFunction* fit(ZoneId zone) const {
        const double* means = of(zone);
        return means ? &fits_[static_cast<std::size_t>(means - zones_.means.data())] : nullptr;
    }

  private:
    struct Sampled {
        std::vector<std::uint32_t> place;  // of a node's first value in `means`, or none
        std::vector<double> means;
    };
    template <class Node>
    void add(const std::vector<Node>& nodes, Sampled& sampled);
    static const double* find(const Sampled& sampled, std::uint32_t node) {
        if (node >= sampled.place.size() || sampled.place[node] == none) return nullptr;
        return &sampled.means[sampled.place[node]];
    }
    void evaluate(ZoneId zone, std::size_t place) {
        quadratic_ ? fit<10>(zone, place) : fit<4>(zone, place);
    }
    template <int functions>
    void fit(ZoneId zone, std::size_t place);
    void evaluate(PatchId patch, std::size_t place);

    const Enclosure& enclosure_;
    const Forest& forest_;
    const DirectLight& light_;
    Sampled zones_, patches_;
    bool quadratic_;
    std::vector<LeafFunction> fits_;  // as zones_.means
};

}  // namespace tyndall::radiosity
