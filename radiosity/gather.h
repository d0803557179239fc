// Incident radiance at a point, gathered by walking through the linear fields of a solution.
#pragma once

#include <span>

#include "radiosity/fields.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {

// Where light is gathered: in a zone (no normal), or on the side of a surface that `normal` looks
// from.
struct GatherPoint {
    Point x{0.0};
    mesh::WalkStart start;
    Direction normal{0.0};  // unit; zero in a zone

    bool on_surface() const { return normal != Direction(0.0); }
};

struct Gathered {
    double mean = 0.0;    // H: mean radiance, cosine-weighted on a surface [W/m^2/sr]
    double spread = 0.0;  // half the difference of the two halves of the rays: its noise [W/m^2/sr]
};

// The fields a gather reads, with the detail it needs: zones whose longest edge is below
// `detail` × distance stand for their leaves (0: always the leaves).
struct GatherScene {
    const Enclosure& enclosure;
    const Forest& forest;
    const Fields& sources;  // r of every leaf, coarsened: what it sends out besides direct emission
    double detail = 0.0;    // [-]
};

// Radiance that arrives at the ray's origin from its direction, one value a band:
//   L = Σ_segments T ∫ κ e^{−κs} J ds + T I   with J, I linear in their elements            (4)
// Cost: the zones crossed.
void radiance_along(const GatherScene& scene, const mesh::Ray& ray, mesh::WalkStart start,
                    std::span<double> radiance);

// H at a point from the points of the set, scrambled by `seed`: one value a band.
// Cost: points.size() walks. Error: see `spread`.
void gather(const GatherScene& scene, const GatherPoint& point, const PointSet& points,
            std::uint64_t seed, std::span<Gathered> incident);

}  // namespace tyndall::radiosity
