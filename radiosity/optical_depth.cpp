#include "radiosity/optical_depth.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/walk.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t most_interfaces = 32;  // beyond, a walk is cheaper

// Whether the line from x along `path` passes through the polygon; its plane is known to be
// crossed.
bool passes(Point x, Direction path, const mesh::ConvexPolygon& polygon) {
    const double turn = glm::dot(polygon.normal, path) > 0.0 ? 1.0 : -1.0;
    const auto& c = polygon.corners;
    for (std::size_t k = 0, n = c.size(); k < n; ++k) {
        const Direction m = glm::cross(c[k] - x, c[k + 1 == n ? 0 : k + 1] - c[k]);
        if (turn * glm::dot(m, path) < 0.0) return false;
    }
    return true;
}

// A ball that holds the corners: its centre, and the square of its radius with room for rounding.
std::pair<Point, double> ball_around(const std::vector<Point>& corners) {
    Point low = corners[0], high = corners[0];
    for (const Point& corner : corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const Point centre = 0.5 * (low + high);
    double reach2 = 0.0;
    for (const Point& corner : corners)
        reach2 = std::max(reach2, glm::dot(corner - centre, corner - centre));
    return {centre, reach2 * (1.0 + 1e-6)};
}

}  // namespace

OpticalDepth::OpticalDepth(const Enclosure& enclosure, double tolerance)
    : enclosure_(&enclosure), tolerance_(tolerance), varies_(enclosure.varies()) {
    for (std::size_t r = 0; r < enclosure.mesh.region_count; ++r)
        if (!enclosure.region_solid[r] && differ(enclosure.region_medium[r], none))
            transparent_ = false;
    if (!transparent_) find_interfaces();
}

bool OpticalDepth::differ(std::uint32_t a, std::uint32_t b) const {
    const auto varies = [&](std::uint32_t m) {
        return m != none && !enclosure_->media[m].varying.empty();
    };
    if (a != b && (varies(a) || varies(b))) return true;
    for (std::size_t band = 0; band < enclosure_->bands; ++band)
        if (extinction(a, band) != extinction(b, band)) return true;
    return false;
}

void OpticalDepth::find_interfaces() {
    const auto& mesh = enclosure_->mesh;
    // Triangles by the pair of media; the front is the lower one's.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::array<mesh::VertexId, 3>>>
        between;
    for (const auto& facet : mesh.facets) {
        if (facet.opacity != mesh::Opacity::interface) continue;
        if (!facet.tets[0].valid() || !facet.tets[1].valid()) continue;
        auto front = enclosure_->medium_of(facet.tets[0]);
        auto back = enclosure_->medium_of(facet.tets[1]);
        if (!differ(front, back)) continue;
        auto corners = facet.corners;
        if (front > back) {
            std::swap(front, back);
            std::swap(corners[1], corners[2]);
        }
        between[{front, back}].push_back(corners);
    }
    for (const auto& [media, triangles] : between)
        for (auto& polygon :
             mesh::convex_merge(mesh.points, triangles, mesh::Facing::kept, tolerance_)) {
            const double offset = glm::dot(polygon.normal, polygon.corners[0]);
            const auto [centre, reach2] = ball_around(polygon.corners);
            interfaces_.push_back(
                {std::move(polygon), offset, centre, reach2, media.first, media.second});
        }
}

void OpticalDepth::add_varying(std::uint32_t medium, Point x, Direction path, double beyond,
                               double sign, std::span<double> depth) const {
    if (medium == none) return;
    const MediumOptics& optics = enclosure_->media[medium];
    const double s = glm::length(path);
    SegmentOfBands segment(x, path / s, s - beyond, s);
    for (std::size_t band = 0; band < depth.size(); ++band)
        depth[band] += sign * (optics.varying.empty() ? beyond * optics.extinction[band]
                                                      : segment.depth(optics.varying[band]));
}

void OpticalDepth::operator()(Point x, TetId tet, Direction path, std::span<double> depth) const {
    if (interfaces_.size() > most_interfaces) return walked(x, tet, path, depth);
    const double s = glm::length(path);
    const auto here = enclosure_->medium_of(tet);
    std::fill(depth.begin(), depth.end(), 0.0);
    if (s == 0.0) return;
    if (varies_)
        add_varying(here, x, path, s, 1.0, depth);
    else
        for (std::size_t band = 0; band < depth.size(); ++band)
            depth[band] = s * extinction(here, band);
    for (const Interface& face : interfaces_) {
        const double start = glm::dot(face.polygon.normal, x) - face.offset;
        const double end = start + glm::dot(face.polygon.normal, path);
        // On the plane itself the tet tells which side x is on.
        const bool from_front = std::abs(start) > tolerance_ ? start > 0.0 : here == face.front;
        const bool to_front = end > 0.0;
        // A path along the plane crosses it nowhere.
        if (from_front == to_front || start == end) continue;
        const double share = std::clamp(start / (start - end), 0.0, 1.0);
        const Direction off = x + share * path - face.centre;
        if (glm::dot(off, off) > face.reach2 || !passes(x, path, face.polygon)) continue;
        const double beyond = s * (1.0 - share);
        const auto before = from_front ? face.front : face.back;
        const auto after = from_front ? face.back : face.front;
        if (varies_) {
            add_varying(after, x, path, beyond, 1.0, depth);
            add_varying(before, x, path, beyond, -1.0, depth);
            continue;
        }
        for (std::size_t band = 0; band < depth.size(); ++band)
            depth[band] += beyond * (extinction(after, band) - extinction(before, band));
    }
    // Rounding, or a segment through the very edge of an interface, must not make light.
    for (double& d : depth) d = std::max(d, 0.0);
}

void OpticalDepth::walked(Point x, TetId tet, Direction path, std::span<double> depth) const {
    std::fill(depth.begin(), depth.end(), 0.0);
    const double s = glm::length(path);
    if (s == 0.0) return;
    const mesh::Ray ray{x, path / s, s};
    mesh::walk(enclosure_->mesh, ray, {tet}, [&](TetId at, double in, double out) {
        add_depth(*enclosure_, at, ray, in, out, depth);
        return true;
    });
}

}  // namespace tyndall::radiosity
