// What leaves send out, as far as it is known at each step of the loop.
#pragma once

#include "radiosity/coarse_solution.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {

// A mean over a leaf and what it counts in that of a coarser element: area, volume, or ∫ κ dV in
// place of volume where κ varies.
struct WeighedMean {
    double measure = 0.0;  // [m^2], [m^3] or [m^2]
    double mean = 0.0;
};

// Joins the direct light of the leaves with the indirect light of coarser elements. Keeps
// references to its arguments. Not thread-safe: samples are made on demand.
class LeafLight {
  public:
    LeafLight(const Enclosure& enclosure, ElementMesh& mesh, DirectRefiner& direct,
              Radiance radiance)
        : enclosure_(enclosure), mesh_(mesh), direct_(direct), radiance_(radiance) {}

    // H^A of a leaf, linear between its corners; and so with the leaf's mean kept, of thin zones
    // that have been sampled the function nearest to it, linear or quadratic [W/m^2/sr].
    template <class Node>
    Affine direct(Node leaf, std::size_t band);
    Affine direct_with_mean(PatchId leaf, std::size_t band) { return between_corners(leaf, band); }
    LeafFunction direct_with_mean(ZoneId leaf, std::size_t band);

    // The mean of H^A over a leaf as an element's capacity weighs it: with κ where that varies.
    WeighedMean weighed_direct(PatchId leaf, std::size_t band);
    WeighedMean weighed_direct(ZoneId leaf, std::size_t band);
    // The same of any function on leaves, of which `band` is to be weighed.
    WeighedMean weighed(PatchId leaf, std::size_t band, const Affine& function) const;
    WeighedMean weighed(ZoneId leaf, std::size_t band, const Affine& function) const;

    // The means of H^A of the leaves in each element above them ([element * bands + band])
    // [W/m^2/sr].
    std::vector<double> means_of_direct(const Elements& elements);

    // What patches reflect of direct light (LitPatches).
    Fields lit_patches();

    // What patches send that those who see them straight have from elsewhere: e^A, and with `lit`
    // what they reflect of direct light. Rays that mirrors have turned gather it
    // (GatherScene::set_in_mirrors) [node * bands + band]; empty where there are no mirrors.
    std::vector<Affine> in_mirrors(const CoarseSolution& coarse, bool lit);

    // r of the leaves as the coarse solution knows it: their own direct light with its mean kept,
    // the coarse element's indirect light with its gradient. With `lit`, without what
    // patches reflect of direct light: it is looked at apart. Coarsened, ready for gathers.
    Fields sources(const CoarseSolution& coarse, const LitPatches* lit = nullptr);

    // Indirect light of the leaves as the coarse solution knows it.
    Fields indirect(const CoarseSolution& coarse);

    // Gives the zones of such sources what has been gathered there since.
    void update_zones(const CoarseSolution& coarse, IndirectRefiner& indirect, Fields& sources);

    // What the elements above the leaves have settled to emit, and what else is emitted.
    Solution::SettledEmission settled(const CoarseSolution& coarse) const;

    // The element of the coarse solution that a leaf lies in.
    template <class Node>
    std::uint32_t element_above(Node leaf, const std::vector<std::uint32_t>& of_node) const {
        while (!(leaf.value < of_node.size() && of_node[leaf.value] != none))
            leaf = mesh_.forest()[leaf].parent;
        return of_node[leaf.value];
    }

  private:
    template <class Node>
    Affine between_corners(Node leaf, std::size_t band) {
        return with_mean(direct(leaf, band), mesh_.forest().centroid(leaf),
                         direct_.mean(leaf, band));
    }

    const Enclosure& enclosure_;
    ElementMesh& mesh_;
    DirectRefiner& direct_;
    Radiance radiance_;
};

}  // namespace tyndall::radiosity
