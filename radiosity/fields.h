// Linear functions on the nodes of the forest: what an element holds beyond its mean.
#pragma once

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

// Gives nodes that are new in the forest the functions of their parents.
void extend(const Forest& forest, Fields& fields);

// Gives leaves their functions' values at their centroids, without gradient.
void flatten(const Forest& forest, Fields& fields);

// Gives inner zones the mean of their children, and the gradient that their means and gradients
// say.
void coarsen(const Forest& forest, Fields& fields);

}  // namespace tyndall::radiosity
