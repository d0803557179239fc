#include "radiosity/item_buffer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace tyndall::radiosity {
namespace {

// Rounding, relative: of edges seen from the eye, and of depths.
constexpr double rounding = 1e-12, depth_rounding = 1e-9;

// The box around a projection in a face's plane: of a hull of points, of which some may lie beside
// or behind the eye. Where an edge passes the plane through the eye that is parallel to the face,
// its projection goes on to infinity.
struct Bounds {
    double u_min = infinity, u_max = -infinity, v_min = infinity, v_max = -infinity;

    void add(double u, double v, double w) {
        // At infinity only the direction counts; along an axis nothing is added across it.
        if (u != 0.0 || w > 0.0) {
            const double at = w > 0.0 ? u / w : std::copysign(infinity, u);
            u_min = std::min(u_min, at);
            u_max = std::max(u_max, at);
        }
        if (v != 0.0 || w > 0.0) {
            const double at = w > 0.0 ? v / w : std::copysign(infinity, v);
            v_min = std::min(v_min, at);
            v_max = std::max(v_max, at);
        }
    }
};

template <std::size_t count>
Bounds bounds_of(const CubeFace& face, const std::array<Point, count>& corners) {
    Bounds bounds;
    std::array<double, count> w;
    bool before = false, behind = false;
    for (std::size_t k = 0; k < count; ++k) {
        w[k] = face.sign * corners[k][face.across];
        before = before || w[k] > 0.0;
        behind = behind || w[k] < 0.0;
    }
    if (!before) return bounds;
    for (std::size_t k = 0; k < count; ++k)
        if (w[k] >= 0.0) bounds.add(corners[k][face.along_u], corners[k][face.along_v], w[k]);
    if (!behind) return bounds;
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            if (w[a] > 0.0 && w[b] < 0.0) {
                const Point at = corners[a] * -w[b] + corners[b] * w[a];  // times w_a − w_b > 0
                bounds.add(at[face.along_u], at[face.along_v], 0.0);
            }
    return bounds;
}

// The pixels of [begin, end) whose middles lie between low and high, ends counted.
std::array<std::size_t, 2> pixels_between(double low, double high, double first, double step,
                                          std::size_t begin, std::size_t end) {
    constexpr double margin = 1e-9;  // of a pixel: far above rounding
    const double from = std::ceil((low - first) / step - 0.5 - margin);
    const double to = std::floor((high - first) / step - 0.5 + margin) + 1.0;
    const auto within = [&](double at) {
        return static_cast<std::size_t>(
            std::clamp(at, static_cast<double>(begin), static_cast<double>(end)));
    };
    if (!(low <= high)) return {begin, begin};
    return {within(from), within(to)};
}

// normal · d of the directions d through a face's pixels.
struct Rate {
    double across, along_u, along_v;

    Rate(const CubeFace& face, const Direction& normal)
        : across(face.sign * normal[face.across]),
          along_u(normal[face.along_u]),
          along_v(normal[face.along_v]) {}
    double operator()(double u, double v) const { return across + u * along_u + v * along_v; }
};

PixelBox pixels_within(const CubeFace& face, const PixelBox& tile, const Bounds& b) {
    const auto u =
        pixels_between(b.u_min, b.u_max, face.u_min, face.u_step(), tile.u_begin, tile.u_end);
    const auto v =
        pixels_between(b.v_min, b.v_max, face.v_min, face.v_step(), tile.v_begin, tile.v_end);
    return {u[0], u[1], v[0], v[1]};
}

}  // namespace

DrawnElements::DrawnElements(const Discretization& d, std::size_t band)
    : outside(static_cast<std::uint32_t>(d.elements.outside())) {
    for (std::size_t k = 0; k < d.forest.vertex_count(); ++k)
        points.push_back(d.forest.point(VertexId(k)));
    for (std::size_t i = 0; i < d.elements.size(); ++i)
        for (const std::uint32_t member : d.elements.members_of(i)) {
            const auto column = static_cast<std::uint32_t>(i);
            if (d.elements.is_patch(i)) {
                const auto& c = d.forest[PatchId(member)].corners;
                patches.push_back({{c[0].value, c[1].value, c[2].value}, column});
            } else {
                const auto& c = d.forest[ZoneId(member)].corners;
                const TetId tet = d.forest.base_tet(ZoneId(member));
                zones.push_back({{c[0].value, c[1].value, c[2].value, c[3].value},
                                 column,
                                 d.enclosure.extinction(tet, band)});
            }
        }
}

DrawnElements::DrawnElements(const Enclosure& enclosure, const Forest& forest) : outside(none) {
    for (std::size_t k = 0; k < forest.vertex_count(); ++k)
        points.push_back(forest.point(VertexId(k)));
    for (std::size_t p = 0; p < forest.patch_count(); ++p) {
        const PatchId patch(p);
        const auto& facet = enclosure.mesh.facets[forest.base_facet_side(patch) / 2];
        if (!forest.is_leaf(patch) || facet.opacity != mesh::Opacity::opaque) continue;
        const auto& c = forest[patch].corners;
        patches.push_back({{c[0].value, c[1].value, c[2].value}, patch.value});
    }
    for (std::size_t z = 0; z < forest.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!forest.is_leaf(zone) || medium_of(enclosure, forest, zone) == none) continue;
        const auto& c = forest[zone].corners;
        zones.push_back({{c[0].value, c[1].value, c[2].value, c[3].value}, zone.value, 0.0});
    }
}

void ItemBuffer::look_from(Point eye, const glm::dmat3& axes) {
    const glm::dmat3 turn = glm::transpose(axes);
    points_.clear();
    reach_ = 0.0;
    for (const Point& p : elements_->points) {
        points_.push_back(turn * (p - eye));
        reach_ = std::max(reach_, glm::length(points_.back()));
    }
    patches_.clear();
    for (const auto& patch : elements_->patches) add_patch(patch);
    zones_.clear();
    for (const auto& zone : elements_->zones) add_zone(zone);
}

void ItemBuffer::add_patch(const DrawnElements::Patch& patch) {
    FacingPatch facing;
    facing.column = patch.column;
    for (int k = 0; k < 3; ++k) facing.corners[k] = points_[patch.corners[k]];
    const auto& [a, b, c] = facing.corners;
    facing.normal = glm::cross(b - a, c - a);
    facing.offset = glm::dot(facing.normal, a);
    // The eye is on the patch's front, and not in its plane.
    if (!(facing.offset < -rounding * glm::length(facing.normal) * reach_)) return;
    for (int k = 0; k < 3; ++k) {
        const Point &from = facing.corners[k], &to = facing.corners[(k + 1) % 3];
        facing.edges[k] = {glm::cross(from, to), rounding * glm::length(from) * glm::length(to)};
    }
    patches_.push_back(facing);
}

void ItemBuffer::add_zone(const DrawnElements::Zone& zone) {
    SeenZone seen;
    seen.column = zone.column;
    seen.extinction = zone.extinction;
    for (int k = 0; k < 4; ++k) seen.corners[k] = points_[zone.corners[k]];
    for (int k = 0; k < 4; ++k) {
        const auto& f = mesh::face_corners[k];
        const Point &a = seen.corners[f[0]], &b = seen.corners[f[1]], &c = seen.corners[f[2]];
        const Direction normal = glm::cross(b - a, c - a);
        const double offset = glm::dot(normal, a), size = glm::length(normal);
        seen.planes[k] = {normal, offset, rounding * size, offset >= -rounding * size * reach_};
    }
    zones_.push_back(seen);
}

void ItemBuffer::draw(const CubeFace& face, const PixelBox& tile) {
    tile_ = tile;
    const std::size_t pixels = (tile.u_end - tile.u_begin) * (tile.v_end - tile.v_begin);
    depth_.assign(pixels, infinity);
    items_.assign(pixels, elements_->outside);
    u_.clear();
    v_.clear();
    lengths_.clear();
    for (std::size_t i = tile.u_begin; i < tile.u_end; ++i) u_.push_back(face.u(i));
    for (std::size_t j = tile.v_begin; j < tile.v_end; ++j) v_.push_back(face.v(j));
    for (const double v : v_)
        for (const double u : u_) lengths_.push_back(std::sqrt(1.0 + u * u + v * v));
    drawn_.clear();
    for (const auto& patch : patches_) draw_patch(face, patch);
    for (const auto& zone : zones_) draw_zone(face, zone);
    sort_fragments();
}

void ItemBuffer::draw_patch(const CubeFace& face, const FacingPatch& patch) {
    const PixelBox box = pixels_within(face, tile_, bounds_of(face, patch.corners));
    if (box.empty()) return;
    const Rate slope_of(face, patch.normal);
    const std::array beyond{Rate(face, patch.edges[0].normal), Rate(face, patch.edges[1].normal),
                            Rate(face, patch.edges[2].normal)};
    each_pixel(box, [&](double u, double v, double length, std::size_t p) {
        const double slope = slope_of(u, v);
        if (!(slope < 0.0)) return;
        for (int k = 0; k < 3; ++k)
            if (!(beyond[k](u, v) <= patch.edges[k].tolerance * length)) return;
        const double at = patch.offset / slope;
        if (!(at < depth_[p] * (1.0 - depth_rounding))) return;
        depth_[p] = at;
        items_[p] = patch.column;
    });
}

void ItemBuffer::draw_zone(const CubeFace& face, const SeenZone& zone) {
    const PixelBox box = pixels_within(face, tile_, bounds_of(face, zone.corners));
    if (box.empty()) return;
    const auto& planes = zone.planes;
    const std::array slopes{Rate(face, planes[0].normal), Rate(face, planes[1].normal),
                            Rate(face, planes[2].normal), Rate(face, planes[3].normal)};
    each_pixel(box, [&](double u, double v, double length, std::size_t p) {
        double near = 0.0, far = depth_[p];
        for (int k = 0; k < 4; ++k) {
            const double slope = slopes[k](u, v);
            if (planes[k].touches && std::abs(slope) <= planes[k].nothing * length) continue;
            const double at = planes[k].offset / slope;
            if (slope > 0.0)
                far = std::min(far, at);
            else if (slope < 0.0)
                near = std::max(near, at);
            else
                far = -infinity;
            if (!(far > near)) return;
        }
        // Not what rounding leaves behind a wall, or of a zone that the eye only touches.
        if (near >= depth_[p] * (1.0 - depth_rounding) || !(far - near > rounding * reach_)) return;
        drawn_.push_back({static_cast<std::uint32_t>(p), zone.column, zone.extinction, near, far});
    });
}

// By pixel (counted), then by nearness.
void ItemBuffer::sort_fragments() {
    ends_.assign(depth_.size() + 1, 0);
    for (const auto& f : drawn_) ++ends_[f.pixel + 1];
    for (std::size_t p = 1; p < ends_.size(); ++p) ends_[p] += ends_[p - 1];
    fragments_.resize(drawn_.size());
    // ends_[p] is where pixel p begins, and moves to its end.
    for (const auto& f : drawn_) fragments_[ends_[f.pixel]++] = f;
    std::size_t begin = 0;
    for (std::size_t p = 0; p < depth_.size(); ++p) {
        std::sort(fragments_.begin() + static_cast<std::ptrdiff_t>(begin),
                  fragments_.begin() + static_cast<std::ptrdiff_t>(ends_[p]),
                  [](const Fragment& a, const Fragment& b) {
                      return a.near != b.near ? a.near < b.near : a.column < b.column;
                  });
        begin = ends_[p];
    }
}

}  // namespace tyndall::radiosity
