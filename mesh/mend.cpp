#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <set>
#include <unordered_map>

#include "mesh/face_soup.h"

namespace tyndall::mesh {
namespace {

using Corners = std::vector<std::uint32_t>;

// Of the points that faces use.
double size_of(const FaceSoup& soup) {
    Point low(1e300), high(-1e300);
    for (const SoupFace& face : soup.faces) {
        for (const auto corner : face.corners) {
            low = glm::min(low, soup.points[corner]);
            high = glm::max(high, soup.points[corner]);
        }
    }
    return glm::length(high - low);
}

struct GridCell {
    std::int64_t x, y, z;
    bool operator==(const GridCell&) const = default;
};
struct GridCellHash {
    std::size_t operator()(const GridCell& c) const {
        std::uint64_t h = static_cast<std::uint64_t>(c.x) * 0x9E3779B97F4A7C15ull;
        h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(c.y)) * 0xBF58476D1CE4E5B9ull;
        h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(c.z)) * 0x94D049BB133111EBull;
        return h ^ (h >> 31);
    }
};

// The point each point becomes: itself, or an earlier one nearer than `distance`. Points lie in a
// grid of that spacing, so that only 27 cells need to be looked at.
Corners weld(const std::vector<Point>& points, double distance) {
    Corners result(points.size());
    std::unordered_map<GridCell, Corners, GridCellHash> grid;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto scaled = points[i] / distance;
        const GridCell cell{std::int64_t(std::floor(scaled.x)), std::int64_t(std::floor(scaled.y)),
                            std::int64_t(std::floor(scaled.z))};
        result[i] = i;
        for (int n = 0; n < 27 && result[i] == i; ++n) {
            const auto found =
                grid.find({cell.x + n % 3 - 1, cell.y + n / 3 % 3 - 1, cell.z + n / 9 - 1});
            if (found == grid.end()) continue;
            for (const auto other : found->second) {
                if (glm::length(points[other] - points[i]) <= distance) {
                    result[i] = other;
                    break;
                }
            }
        }
        if (result[i] == i) grid[cell].push_back(i);
    }
    return result;
}

// How many points that faces use become another.
std::size_t count_welded(const FaceSoup& soup, const Corners& becomes, std::size_t& used) {
    std::vector<bool> seen(soup.points.size(), false);
    std::size_t welded = 0;
    for (const SoupFace& face : soup.faces) {
        for (const auto corner : face.corners) {
            if (seen[corner]) continue;
            seen[corner] = true;
            ++used;
            if (becomes[corner] != corner) ++welded;
        }
    }
    return welded;
}

// Twice the area vector (Newell).
glm::dvec3 area_vector(const std::vector<Point>& points, const Corners& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += glm::cross(points[corners[i]] - points[corners[0]],
                          points[corners[i + 1]] - points[corners[0]]);
    }
    return sum;
}

double extent(const std::vector<Point>& points, const Corners& corners) {
    double longest = 0.0;
    for (const auto corner : corners) {
        longest = std::max(longest, glm::length(points[corner] - points[corners[0]]));
    }
    return longest;
}

bool has_area(const std::vector<Point>& points, const Corners& corners) {
    const double size = extent(points, corners);
    return corners.size() >= 3 && glm::length(area_vector(points, corners)) > 1e-10 * size * size;
}

bool planar(const std::vector<Point>& points, const Corners& corners) {
    if (corners.size() == 3) return true;
    const glm::dvec3 normal = glm::normalize(area_vector(points, corners));
    const double slack = 1e-9 * extent(points, corners);
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
        return std::abs(glm::dot(points[corner] - points[corners[0]], normal)) <= slack;
    });
}

// Whether corner i can be cut off: it is convex and no other corner lies in its triangle, seen
// along the normal.
bool is_ear(const std::vector<Point>& points, const Corners& corners, std::size_t i,
            glm::dvec3 normal) {
    const std::size_t count = corners.size();
    const Point a = points[corners[(i + count - 1) % count]], b = points[corners[i]],
                c = points[corners[(i + 1) % count]];
    const auto left = [&](Point p, Point q, Point r) {
        return glm::dot(glm::cross(q - p, r - p), normal);
    };
    if (left(a, b, c) <= 0.0) return false;
    for (std::size_t k = 2; k + 1 < count; ++k) {
        const Point p = points[corners[(i + k) % count]];
        if (left(a, b, p) >= 0.0 && left(b, c, p) >= 0.0 && left(c, a, p) >= 0.0) return false;
    }
    return true;
}

// Ear clipping; where nothing looks like an ear, the next corner is cut all the same.
std::vector<Corners> triangulate(const std::vector<Point>& points, Corners corners) {
    const glm::dvec3 normal = area_vector(points, corners);
    std::vector<Corners> triangles;
    while (corners.size() > 3) {
        std::size_t ear = 0;
        while (ear < corners.size() && !is_ear(points, corners, ear, normal)) ++ear;
        if (ear == corners.size()) ear = 0;
        const std::size_t count = corners.size();
        triangles.push_back(
            {corners[(ear + count - 1) % count], corners[ear], corners[(ear + 1) % count]});
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back(corners);
    return triangles;
}

// The corners after welding, without those that fell together with their neighbour.
Corners welded_corners(const Corners& corners, const Corners& becomes) {
    Corners result;
    for (const auto corner : corners) {
        if (result.empty() || result.back() != becomes[corner]) result.push_back(becomes[corner]);
    }
    while (result.size() > 1 && result.back() == result.front()) result.pop_back();
    return result;
}

std::string faces_text(std::size_t count) {
    return count == 1 ? "1 face" : fmt::format("{} faces", count);
}

}  // namespace

MeshFile mend(FaceSoup soup, double tolerance) {
    MeshFile file;
    std::size_t used = 0, no_area = 0, twice = 0, cut = 0;
    const double distance = tolerance * size_of(soup);
    Corners becomes(soup.points.size());
    std::iota(becomes.begin(), becomes.end(), 0u);
    if (distance > 0.0) becomes = weld(soup.points, distance);
    const std::size_t welded = count_welded(soup, becomes, used);

    file.faces.resize(soup.groups.size());
    for (std::size_t g = 0; g < soup.groups.size(); ++g) file.faces[g].name = soup.groups[g];
    std::set<Corners> known;  // from the lowest corner on: same corners, same front
    for (const SoupFace& face : soup.faces) {
        Corners corners = welded_corners(face.corners, becomes);
        if (!has_area(soup.points, corners)) {
            ++no_area;
            continue;
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        if (!known.insert(corners).second) {
            ++twice;
            continue;
        }
        const bool flat = planar(soup.points, corners);
        if (!flat) ++cut;
        for (const Corners& part :
             flat ? std::vector<Corners>{corners} : triangulate(soup.points, corners)) {
            if (!has_area(soup.points, part)) continue;
            Polygon polygon;
            for (const auto corner : part) polygon.corners.push_back(soup.points[corner]);
            file.faces[face.group].polygons.push_back(std::move(polygon));
        }
    }
    std::erase_if(file.faces, [](const Face& face) { return face.polygons.empty(); });

    if (welded > 0) file.notes.push_back(fmt::format("welded {} of {} vertices", welded, used));
    if (no_area > 0)
        file.notes.push_back(fmt::format("dropped {} without area", faces_text(no_area)));
    if (twice > 0)
        file.notes.push_back(fmt::format("dropped {} that were there twice", faces_text(twice)));
    if (cut > 0) {
        file.notes.push_back(
            fmt::format("cut {} that were not planar into triangles", faces_text(cut)));
    }
    return file;
}

}  // namespace tyndall::mesh
