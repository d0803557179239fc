// Which elements a shadow's edge crosses, what that costs them, and cutting them along it.
#pragma once

#include "radiosity/element_mesh.h"
#include "radiosity/shadow_boundaries.h"

namespace tyndall::radiosity {

// The indicator "shadow boundary" of direct light. Samples at fixed points miss a thin shaft; here
// direct light is looked at on both sides of every sheet that crosses an element.
class ShadowCuts {
  public:
    ShadowCuts(const Enclosure& enclosure, const ShadowBoundaries& boundaries, ElementMesh& mesh,
               const DirectLight& light);

    // Finds the sheets at new leaves, marks the corners on them, and measures the jumps across
    // them. To be called before the leaves' samples are made.
    void update(const std::vector<ZoneId>& zones, const std::vector<PatchId>& patches);

    // Root of the mean square that a jump leaves in a leaf that is not cut; 0: no jump
    // [W/m^2/sr].
    double error(ZoneId zone) const { return zones_[zone.value].cut.error; }
    double error(PatchId patch) const { return patches_[patch.value].cut.error; }

    // Bisects a leaf with a jump, until no leaf below it has something on both sides of the jump's
    // sheet (both of a penumbra's sheets), or there are enough leaves. 4 to 6 zones or 3 patches a
    // sheet. False if there was nothing to cut.
    bool cut(ZoneId zone, std::size_t max_leaves);
    bool cut(PatchId patch, std::size_t max_leaves);

    std::size_t memory() const;  // [byte]

  private:
    struct Cut {
        float error = 0.0f;
        std::uint32_t sheet = none;
    };
    // What is known of a node.
    struct Known {
        bool looked_at = false;
        std::vector<std::uint32_t> sheets;  // that touch it
        Cut cut;
    };
    template <class Node>
    void look(const std::vector<Node>& nodes, std::vector<Known>& known);
    template <class Node>
    void find_sheets(Node node, std::vector<Known>& known) const;
    template <class Node>
    void mark_corners(Node node, const std::vector<std::uint32_t>& sheets);
    template <class Node>
    Cut measure(Node node, const std::vector<std::uint32_t>& sheets) const;
    template <class Node>
    double jump(Node node, const ShadowSheet& sheet, const ShadowSection& section) const;
    template <class Node>
    void cut_along(Node node, const ShadowSheet& sheet, double reach, std::size_t max_leaves);
    template <class Node>
    bool cut_leaf(Node node, const Cut& cut, std::size_t max_leaves);
    TetId tet_of(ZoneId zone) const;
    TetId tet_of(PatchId patch) const;
    void incident(ZoneId zone, Point x, std::vector<double>& value) const;
    void incident(PatchId patch, Point x, std::vector<double>& value) const;

    const Enclosure& enclosure_;
    const ShadowBoundaries& boundaries_;
    ElementMesh& mesh_;
    const DirectLight& light_;
    std::vector<Known> zones_, patches_;  // by node
};

}  // namespace tyndall::radiosity
