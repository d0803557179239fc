// What two elements exchange, as a sum over their faces.
#pragma once

#include <functional>
#include <optional>

#include "radiosity/element_faces.h"
#include "radiosity/polygon_exchange.h"

namespace tyndall::radiosity {

// The faces of an element and what they mean.
struct Shape {
    bool zone = false;  // its faces enclose it; a patch, or the hull: each face for itself
    std::vector<ElementFace> faces;
};

// Parts of two faces that face each other, cut where the plane of one crosses the other.
struct FacingParts {
    std::vector<Point> p, q;       // convex [m]
    Direction p_normal, q_normal;  // of the faces
    int sign;                      // how they count: +1, −1
    TetId tet;                     // beside p, on q's side
};

// Purpose: the exchange area of two elements is a signed sum over pairs of their faces,
//     S = Σ_f Σ_g w_f w_g ∫∫ K(u) |cosθ_f cosθ_g| V / (π s²) dA_f dA_g,                  (35)
//   w = 1 where a ray leaves the first or enters the second element, −1 where it enters the first
//   or leaves the second; a patch is only left, and only met, on its own side; a zone's wall only
//   from inside. K by the number of zones (DepthKernel). Along every ray that is the difference of
//   transmittances that the element's depth makes; constants, and for two zones what is linear in
//   the depth, cancel along every ray and are left out.
// Valid for: zones with no opaque facet inside that is not among their faces; any occlusion.
void each_facing(const Shape& a, const Shape& b,
                 const std::function<void(const FacingParts&)>& take);

// The shapes of a discretization's elements, then outside's, and what may come between them.
class FacePairs {
  public:
    explicit FacePairs(const Discretization& discretization);

    const Shape& shape(ElementId element) const { return shapes_[element.value]; }
    // The kernel that loses least to cancellation: that of the number of zones; for zones that lie
    // far apart in a thick medium the transmittance itself, which is right where they do not touch.
    DepthKernel kernel(const Shape& a, const Shape& b, std::size_t band) const;
    // Whether some opaque facet has a part between the two.
    bool blocked(const FacingParts& parts) const;
    // The extinction between them [1/m]; none where media that differ lie there.
    std::optional<double> extinction(const FacingParts& parts, std::size_t band) const;
    const mesh::Occluders& occluders() const { return occluders_; }
    const OpticalDepth& depth() const { return depth_; }

  private:
    bool any_between(const FacingParts& parts,
                     const std::vector<mesh::ConvexPolygon>& polygons) const;

    const Enclosure& enclosure_;
    double tolerance_;
    std::vector<mesh::ConvexPolygon> walls_, interfaces_;
    mesh::Occluders occluders_;
    OpticalDepth depth_;
    std::vector<Shape> shapes_;
};

}  // namespace tyndall::radiosity
