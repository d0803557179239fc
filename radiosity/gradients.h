// Gradients of what elements hold, from the means of the elements around them.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "radiosity/elements.h"

namespace tyndall::radiosity {

// A sparse linear operator: g_i = Σ_n w_in (x_n − x_i), the gradient of the linear function through
// x_i that fits the means of i's neighbours best (least squares, weights 1/distance²). Exact for a
// linear x.
//
// Neighbours meet at a corner with no wall between, in one medium or on one flat side of a surface:
// x may jump anywhere else. Directions that they do not tell (too few, or all in a plane) have no
// gradient.
//
// Source: least-squares reconstruction as in finite volumes, Barth & Jespersen (1989).
class ElementGradients {
  public:
    ElementGradients() = default;
    // Elements that are leaves of the forest; clusters have no corners, and no gradients.
    // Cost: O(elements × neighbours).
    ElementGradients(const Enclosure& enclosure, const Forest& forest, const Elements& elements);

    bool empty() const { return starts_.empty(); }
    std::size_t memory() const;

    // g of every element, given x of every element [x per m]. Cost: one pass over the neighbours,
    // in parallel.
    std::vector<glm::vec3> of(std::span<const double> x) const;
    // The same without rounding to single precision: as exactly linear in x as doubles are, which
    // solutions to more than nine digits need.
    std::vector<Direction> unrounded(std::span<const double> x) const;

    // The neighbours n of an element and their weights w [1/m].
    std::span<const std::uint32_t> neighbours_of(std::size_t element) const {
        return std::span(neighbours_).subspan(starts_[element], count(element));
    }
    std::span<const glm::vec3> weights_of(std::size_t element) const {
        return std::span(weights_).subspan(starts_[element], count(element));
    }

  private:
    std::size_t count(std::size_t element) const { return starts_[element + 1] - starts_[element]; }
    template <class Vector>
    std::vector<Vector> gradients(std::span<const double> x) const;

    std::vector<std::size_t> starts_;  // of every element, into the arrays below
    std::vector<std::uint32_t> neighbours_;
    std::vector<glm::vec3> weights_;  // [1/m]
};

}  // namespace tyndall::radiosity
