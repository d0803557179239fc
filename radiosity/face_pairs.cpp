#include "radiosity/face_pairs.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "mesh/shaft.h"

namespace tyndall::radiosity {
namespace {

// The part of a face on one side of another's plane.
std::vector<Point> part(const ElementFace& face, const ElementFace& plane, bool in_front) {
    const Direction n = in_front ? plane.polygon.normal : -plane.polygon.normal;
    std::vector<Point> result;
    mesh::clip(face.polygon.corners, n, glm::dot(n, plane.polygon.corners[0]), result);
    return result;
}

// As a ray's start: +1 where it leaves the element to the face's front (a zone's normal looks out,
// so that leaving is to the front), −1 where it enters; 0 where no ray starts. As its end, coming
// from there, the same: a patch is met from its front, a zone entered from there and left from the
// back.
int weight(const Shape& shape, const ElementFace& face, bool to_front) {
    if (!shape.zone) return to_front ? 1 : 0;
    if (to_front) return face.open ? 1 : 0;
    return -1;
}

// Between the bounding boxes [m].
double distance(const Shape& a, const Shape& b) {
    const auto box = [](const Shape& shape) {
        std::pair<Point, Point> box{Point(std::numeric_limits<double>::max()),
                                    Point(std::numeric_limits<double>::lowest())};
        for (const ElementFace& face : shape.faces)
            for (const Point& corner : face.polygon.corners) {
                box.first = glm::min(box.first, corner);
                box.second = glm::max(box.second, corner);
            }
        return box;
    };
    const auto [a_low, a_high] = box(a);
    const auto [b_low, b_high] = box(b);
    return glm::length(glm::max(glm::max(a_low - b_high, b_low - a_high), Point(0.0)));
}

}  // namespace

void each_facing(const Shape& a, const Shape& b,
                 const std::function<void(const FacingParts&)>& take) {
    for (const ElementFace& f : a.faces)
        for (const ElementFace& g : b.faces)
            for (const bool to_front : {true, false})
                for (const bool from_front : {true, false}) {
                    const int sign = weight(a, f, to_front) * weight(b, g, from_front);
                    if (sign == 0) continue;
                    // g in front of f means the ray goes to f's front, and f in front of g that it
                    // comes from g's.
                    FacingParts parts{part(f, g, from_front),
                                      part(g, f, to_front),
                                      f.polygon.normal,
                                      g.polygon.normal,
                                      sign,
                                      to_front ? f.front : f.back};
                    if (parts.p.size() >= 3 && parts.q.size() >= 3) take(parts);
                }
}

FacePairs::FacePairs(const Discretization& d)
    : enclosure_(d.enclosure),
      tolerance_(plane_tolerance(d.enclosure)),
      walls_(occluding_polygons(d.enclosure, tolerance_)),
      interfaces_(media_interfaces(d.enclosure)),
      occluders_(walls_, tolerance_),
      depth_(d.enclosure, tolerance_) {
    for (std::size_t i = 0; i <= d.elements.size(); ++i)
        shapes_.push_back(
            {i < d.elements.outside() && !d.elements.is_patch(i), faces_of(d, ElementId(i))});
}

DepthKernel FacePairs::kernel(const Shape& a, const Shape& b, std::size_t band) const {
    if (!a.zone && !b.zone) return DepthKernel::transmittance;
    double thinnest = std::numeric_limits<double>::max();
    for (std::size_t r = 0; r < enclosure_.mesh.region_count; ++r) {
        if (enclosure_.region_solid[r]) continue;
        const auto medium = enclosure_.region_medium[r];
        thinnest =
            std::min(thinnest, medium == none ? 0.0 : enclosure_.media[medium].extinction[band]);
    }
    if (thinnest * distance(a, b) > 1.0) return DepthKernel::transmittance;
    return a.zone && b.zone ? DepthKernel::second : DepthKernel::first;
}

bool FacePairs::any_between(const FacingParts& parts,
                            const std::vector<mesh::ConvexPolygon>& polygons) const {
    const mesh::Shaft shaft(parts.p, parts.q, tolerance_);
    return std::ranges::any_of(
        polygons, [&](const mesh::ConvexPolygon& polygon) { return shaft.meets(polygon.corners); });
}

bool FacePairs::blocked(const FacingParts& parts) const {
    return any_between(parts, walls_);
}

std::optional<double> FacePairs::extinction(const FacingParts& parts, std::size_t band) const {
    if (any_between(parts, interfaces_)) return {};
    return enclosure_.extinction(parts.tet, band);
}

}  // namespace tyndall::radiosity
