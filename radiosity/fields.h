// Linear and quadratic functions on the nodes of the forest: what an element holds beyond its mean.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "radiosity/elements.h"

namespace tyndall::radiosity {

// f(x) = constant + gradient · x.
struct Affine {
    Direction gradient{0.0};  // [per m]
    double constant = 0.0;

    double at(Point x) const { return constant + glm::dot(gradient, x); }
};

// The linear function with the given values at a tet's four corners; the least-norm gradient in the
// plane for a triangle's three. Constant (the mean) where the corners are too flat to tell.
Affine interpolate(const std::array<Point, 4>& corners, const std::array<double, 4>& values);
Affine interpolate(const std::array<Point, 3>& corners, const std::array<double, 3>& values);

// The function scaled to a mean over the element whose centroid is given: a scaled one stays ≥ 0
// where it was, a shifted one does not. Constant where there is nothing to scale.
Affine with_mean(const Affine& function, Point centroid, double mean);

// What a quadratic function on a leaf has beyond a linear one:
//   f(x) = ½ ((x − c)ᵀ H (x − c) − m),  c the leaf's centroid, m such that its mean there is zero,
//   m = Σ_k (v_k − c)ᵀ H (v_k − c) / (n (n + 1)),  v_k the n corners.
struct Bend {
    std::array<double, 6> second{};  // H: xx, yy, zz, xy, xz, yz [per m^2]
    Point centre{0.0};               // c [m]
    double mean = 0.0;               // m

    // dᵀ H d.
    double along(Direction d) const {
        return second[0] * d.x * d.x + second[1] * d.y * d.y + second[2] * d.z * d.z +
               2.0 * (second[3] * d.x * d.y + second[4] * d.x * d.z + second[5] * d.y * d.z);
    }
    double at(Point x) const { return 0.5 * (along(x - centre) - mean); }
};

// The bend with the given H over the element with these corners.
Bend bend_with(const std::array<double, 6>& second, const std::array<Point, 4>& corners);
Bend bend_with(const std::array<double, 6>& second, const std::array<Point, 3>& corners);

// That of the function which departs by so much from linear in the middle of each edge (i, j), in
// the order (0, 1), (0, 2), …; of triangles in their plane. None where the corners are too flat to
// tell.
//   H = 4 Σ_{i<j} f_ij (∇λ_i ∇λ_jᵀ + ∇λ_j ∇λ_iᵀ)
Bend bend_of(const std::array<Point, 4>& corners, const std::array<double, 6>& departures);
Bend bend_of(const std::array<Point, 3>& corners, const std::array<double, 3>& departures);

// A function on a leaf: its linear part, which has its mean, and its bend.
struct LeafFunction : Affine {
    Bend bend;

    double at(Point x) const { return Affine::at(x) + bend.at(x); }
    // Half way between two points less the mean of what it is there.
    double between(Point a, Point b) const { return -0.125 * bend.along(b - a); }
};

// The quadratic function with these values at the corners, and so much above the mean of two in the
// middle of the edge between them, in the order (0, 1), (0, 2), ….
LeafFunction interpolate(const std::array<Point, 4>& corners, const std::array<double, 4>& values,
                         const std::array<double, 6>& departures);
LeafFunction interpolate(const std::array<Point, 3>& corners, const std::array<double, 3>& values,
                         const std::array<double, 3>& departures);

// One linear function a node and band ([node * bands + band]), meaningful on leaves (and, after
// `coarsen`, on inner nodes), linear and discontinuous from leaf to leaf.
struct Fields {
    std::size_t bands = 1;
    std::vector<Affine> zone, patch;

    void resize(const Forest& forest, std::size_t band_count) {
        bands = band_count;
        zone.resize(forest.zone_count() * bands);
        patch.resize(forest.patch_count() * bands);
    }
    const Affine& at(ZoneId id, std::size_t band) const { return zone[id.value * bands + band]; }
    const Affine& at(PatchId id, std::size_t band) const { return patch[id.value * bands + band]; }
    Affine& at(ZoneId id, std::size_t band) { return zone[id.value * bands + band]; }
    Affine& at(PatchId id, std::size_t band) { return patch[id.value * bands + band]; }
};

// Functions on leaves that may be quadratic.
struct LeafFields : Fields {
    std::vector<Bend> zone_bend, patch_bend;  // [node * bands + band]; empty: linear

    LeafFunction at(ZoneId id, std::size_t band) const { return get(zone, zone_bend, id, band); }
    LeafFunction at(PatchId id, std::size_t band) const { return get(patch, patch_bend, id, band); }
    // Linear functions, and the bends of those that have one where there is room for bends.
    void set(ZoneId id, std::size_t band, const Affine& f) { Fields::at(id, band) = f; }
    void set(PatchId id, std::size_t band, const Affine& f) { Fields::at(id, band) = f; }
    void set(ZoneId id, std::size_t band, const LeafFunction& f) {
        Fields::at(id, band) = f;
        if (!zone_bend.empty()) zone_bend[id.value * bands + band] = f.bend;
    }
    void set(PatchId id, std::size_t band, const LeafFunction& f) {
        Fields::at(id, band) = f;
        if (!patch_bend.empty()) patch_bend[id.value * bands + band] = f.bend;
    }

  private:
    template <class Node>
    LeafFunction get(const std::vector<Affine>& functions, const std::vector<Bend>& bends, Node id,
                     std::size_t band) const {
        const std::size_t k = id.value * bands + band;
        return {functions[k], bends.empty() ? Bend{} : bends[k]};
    }
};

// Gives nodes that are new in the forest the functions of their parents.
void extend(const Forest& forest, Fields& fields);

// Gives leaves their functions' values at their centroids, without gradient.
void flatten(const Forest& forest, Fields& fields);

// Gives inner zones the mean of their children, and the gradient that their means and gradients
// say.
void coarsen(const Forest& forest, Fields& fields);

}  // namespace tyndall::radiosity
