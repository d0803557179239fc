// Extinction that varies in space: what every walk through such a medium asks.
//
// kappa_t of band b is factor[b] × a shape, a regular grid (regular_grid.h) that bands may share.
// Grids do not depend on the elements: whatever the mesh, all methods see the same medium.
#pragma once

#include <memory>

#include "radiosity/regular_grid.h"
#include "radiosity/scene.h"
#include "radiosity/segment.h"

namespace tyndall::radiosity {

// The extinction of one band.
struct ExtinctionBand {
    std::shared_ptr<const RegularGrid> shape;
    double factor = 1.0;

    // kappa_t [1/m].
    double at(Point x) const { return factor * shape->at(x); }
    // ∫ kappa_t ds along origin + s direction (unit), begin ≤ s ≤ end [-]. Exact.
    double depth(Point origin, Direction direction, double begin, double end) const {
        return factor * shape->integral(origin, direction, begin, end);
    }
    // Weights of the segment's ends, for J linear in s (45).
    SegmentWeights weights(Point origin, Direction direction, double begin, double end) const {
        const auto halves = shape->halves(origin, direction, begin, end);
        return segment_weights(factor * halves[0], factor * halves[1]);
    }
    // The same values at the same places.
    bool operator==(const ExtinctionBand& other) const {
        return factor == other.factor && (shape == other.shape || *shape == *other.shape);
    }
};

// One segment in several bands, one after the other: a shape that bands share is integrated once.
class SegmentOfBands {
  public:
    SegmentOfBands(Point origin, Direction direction, double begin, double end)
        : origin_(origin), direction_(direction), begin_(begin), end_(end) {}

    // As ExtinctionBand::weights.
    const SegmentWeights& weights(const ExtinctionBand& band) {
        if (band.shape.get() != shape_) {
            halves_ = band.shape->halves(origin_, direction_, begin_, end_);
            shape_ = band.shape.get();
        } else if (band.factor == factor_) {
            return weights_;
        }
        factor_ = band.factor;
        weights_ = segment_weights(factor_ * halves_[0], factor_ * halves_[1]);
        return weights_;
    }
    // As ExtinctionBand::depth [-].
    double depth(const ExtinctionBand& band) {
        if (band.shape.get() != whole_shape_) {
            whole_ = band.shape->integral(origin_, direction_, begin_, end_);
            whole_shape_ = band.shape.get();
        }
        return band.factor * whole_;
    }

  private:
    Point origin_;
    Direction direction_;
    double begin_, end_;  // [m]
    const RegularGrid *shape_ = nullptr, *whole_shape_ = nullptr;
    std::array<double, 2> halves_{};
    double whole_ = 0.0, factor_ = 0.0;
    SegmentWeights weights_{};
};

// Of a tet: the mean of kappa_t, and the centre of its distribution.
struct TetExtinction {
    double mean = 0.0;  // [1/m]
    Point centre{0.0};  // ∫ x κ dV / ∫ κ dV; the centroid where there is nothing [m]
};

// Purpose: ∫ κ dV and its centre.
// Method: a rule of degree 2 with four points, on halves of the tet until they say the same to
//   1e-3, and at least until they are about as small as the grid's grain, or 512.
// Cost: 12 values for a tet within a grain, some ten thousand at most.
TetExtinction over_tet(const ExtinctionBand& band, const std::array<Point, 4>& corners);
// The mean alone by four points, where a guess will do [1/m].
double rough_mean(const ExtinctionBand& band, const std::array<Point, 4>& corners);

struct SampleOptions {
    double tolerance = 3e-4;  // of the largest value: what interpolation may be wrong by [-]
    std::size_t most_points = std::size_t{1} << 22;  // of the grid
    std::size_t most_cells = 512;                    // along an axis
};

// A function on a grid, and how well it is resolved.
struct SampledFunction {
    std::shared_ptr<const RegularGrid> grid;
    bool uniform = false;  // every sample is `first`
    double first = 0.0;
    // The largest departure found halfway between points, of the largest value [-].
    double error = 0.0;
};

// Purpose: a function of space on a grid over a box, as fine along each axis as it asks for.
// Method: begins with 16 cells along each axis; halves the cells of an axis while the function
//   halfway between its points departs from the mean of its neighbours by more than the tolerance,
//   or until a limit; joins cells where nothing is lost by it (a function of z alone has one cell
//   along x and y). Beyond the box the grid goes on as at its edge.
// Errors: mesh::InputError where the function is negative or not finite: which value, and where.
// Cost: about four values a point of the grid. The function is called from this thread alone.
SampledFunction sample_function(const std::function<double(Point)>& function, Point low, Point high,
                                const SampleOptions& options = {});

}  // namespace tyndall::radiosity
