// A solution as flat arrays of single precision, which a walk in a browser crosses leaf by leaf.
//
// Every face of a leaf lies on a plane that both its sides share to the last bit, but for the sign,
// and has a rope: the subtree across the split plane that it lies on, or the base tet or the wall
// behind it. Children inherit ropes at each bisection, so that hanging nodes need no search: a walk
// that leaves a leaf by a face takes the rope and descends, by split planes, to the leaf that holds
// the ray. A wall's rope leads to the tree of its patches. Source: Havran, Bittner & Zara (1998)
// for ropes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "view/pass_meshes.h"
#include "view/sharpened_patches.h"

namespace tyndall::view {

// What a rope or a child leads to: 4 × index + kind, or one of the two below 0.
enum class RopeKind : std::int32_t { zone = 0, node = 1, wall = 2, patch = 3 };
inline constexpr std::int32_t outside = -1;  // beyond the hull
inline constexpr std::int32_t dark = -2;     // a wall that no light reaches

inline std::int32_t rope_to(RopeKind kind, std::size_t index) {
    return static_cast<std::int32_t>(4 * index) + static_cast<std::int32_t>(kind);
}

// Rows of zones that hold no medium.
inline constexpr std::int32_t empty_space = -1, solid_inside = -2;

// Elements of the meshes of earlier passes that have been bisected since, zones or patches: what
// the leaves below them hold in the mean. `above`: the next coarser one, -1 none; `born`: the first
// mesh of PassMeshes that has it. Functions and rows as those of leaves.
struct CoarserElements {
    std::vector<std::int32_t> above, born, row, level;
    // How far the leaves are off it and off the truth, root mean square [W/m^2/sr].
    std::vector<float> error;
    std::vector<float> size;              // [m^3], [m^2]
    std::vector<float> direct, indirect;  // of patches indirect alone: direct light has its pieces
};

// Lengths are counted from `origin`, so that single precision serves far from the scene's own; all
// but that in [m]. Functions are (gradient, value at the origin): four numbers a band.
struct ViewerArrays {
    std::size_t bands = 1;
    mesh::Point origin{0};
    // Unit normal and offset, four a plane: dot(normal, x) + offset.
    std::vector<float> planes;

    // Leaves in empty space and in solids, too: a walk must cross them. Faces are those opposite
    // the corners.
    std::vector<std::int32_t> zone_planes;  // 4 a leaf: 2 × plane, + 1 where inside is negative
    std::vector<std::int32_t> zone_ropes;   // 4 a leaf
    std::vector<std::int32_t> zone_row;     // into `rows`, or one of the two above
    std::vector<std::int32_t> zone_medium;  // index; -1 none
    std::vector<std::int32_t> zone_level;
    std::vector<float> zone_error;     // of J [W/m^2/sr]
    std::vector<float> zone_volume;    // [m^3]
    std::vector<float> zone_direct;    // albedo × direct, [4 (leaf bands + band)] [W/m^2/sr]
    std::vector<float> zone_indirect;  // albedo × indirect, likewise
    // Extinction where it varies in space: likewise, the function through the mean and its corners'
    // slope; empty: it is that of the row [1/m].
    std::vector<float> zone_extinction;

    std::vector<std::int32_t> nodes;  // 3 an inner node: plane, first child (negative), second
    std::vector<std::int32_t> walls;  // 2 a facet side: its patches, the zones behind it

    // Patches of the solution, and those that their direct light is drawn with.
    std::vector<std::int32_t> patch_row;
    std::vector<std::int32_t> patch_side;  // index of the surface side
    std::vector<std::int32_t> patch_level;
    std::vector<float> patch_error;     // of I [W/m^2/sr]
    std::vector<float> patch_area;      // [m^2]
    std::vector<float> patch_indirect;  // reflectance × indirect [W/m^2/sr]
    std::vector<std::int32_t> piece_patch;
    std::vector<float> piece_direct;  // reflectance × direct [W/m^2/sr]

    // What led to them: of each leaf and patch, likewise.
    std::vector<PassMesh> meshes;
    std::vector<std::int32_t> zone_above, zone_born, patch_above, patch_born;
    CoarserElements coarser_zones, coarser_patches;

    // Of media, sides, and elements that settle their own emission: 2 a band: extinction [1/m],
    // emission [W/m^2/sr].
    std::vector<float> rows;
    // Faces of the base tets on the hull: 3 corners each, and the tet's rope.
    std::vector<float> hull_corners;
    std::vector<std::int32_t> hull_zones;

    std::size_t zone_count() const { return zone_row.size(); }
    std::size_t patch_count() const { return patch_row.size(); }
};

// Purpose: the arrays of a solution, its patches sharpened.
// Cost: linear in the nodes of the forest.
ViewerArrays viewer_arrays(const radiosity::Solution& solution, const SharpenedPatches& patches);

}  // namespace tyndall::view
