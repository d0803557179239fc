// Optical depth between two points that see each other.
#pragma once

#include <span>
#include <vector>

#include "mesh/convex_merge.h"
#include "mesh/walk.h"
#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// Adds the optical depth of the ray's segment within a base tet; one value a band [-].
inline void add_depth(const Enclosure& enclosure, TetId tet, const mesh::Ray& ray, double t_in,
                      double t_out, std::span<double> depth) {
    SegmentOfBands segment(ray.origin, ray.direction, t_in, t_out);
    for (std::size_t band = 0; band < depth.size(); ++band) {
        const ExtinctionBand* varying = enclosure.varying(tet, band);
        depth[band] +=
            varying ? segment.depth(*varying) : (t_out - t_in) * enclosure.extinction(tet, band);
    }
}

// Equation: ∫ κ_t ds = κ_x s + Σ_k (s − s_k) Δκ_k, over the interfaces k that the segment crosses
//   at distance s_k and where the extinction changes by Δκ_k: no order is needed. Where there are
//   many interfaces, the base tets are walked instead. Where κ_t varies: ∫_0^s κ_x ds' + Σ_k
//   ∫_{s_k}^s Δκ_k ds', of the media's grids, which go on beyond the interfaces.
// Cost: one plane test an interface polygon, the grid's cells on the way.
class OpticalDepth {
  public:
    // Keeps a reference to the enclosure. `tolerance` [m]: points nearer to a plane are on it.
    OpticalDepth(const Enclosure& enclosure, double tolerance);

    // Whether there is no medium at all.
    bool transparent() const { return transparent_; }

    // From x, in `tet`, to x + path: `depth` has one value a band [-].
    void operator()(Point x, TetId tet, Direction path, std::span<double> depth) const;

    // The same by walking the base tets, whatever the number of interfaces.
    void walked(Point x, TetId tet, Direction path, std::span<double> depth) const;

  private:
    struct Interface {
        mesh::ConvexPolygon polygon;
        double offset = 0.0;        // dot(normal, p) of its plane
        Point centre{};             // of a ball that holds it
        double reach2 = 0.0;        // the square of the ball's radius, rounded up [m^2]
        std::uint32_t front, back;  // media
    };

    double extinction(std::uint32_t medium, std::size_t band) const {
        return medium == none ? 0.0 : enclosure_->media[medium].extinction[band];
    }
    bool differ(std::uint32_t a, std::uint32_t b) const;
    // Adds `sign` times what a medium would make of the last part of a path.
    void add_varying(std::uint32_t medium, Point x, Direction path, double beyond, double sign,
                     std::span<double> depth) const;
    void find_interfaces();

    const Enclosure* enclosure_;
    double tolerance_;
    bool transparent_ = true, varies_ = false;
    std::vector<Interface> interfaces_;
};

}  // namespace tyndall::radiosity
