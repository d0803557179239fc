#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "mesh/input_error.h"
#include "mesh/tet_file_surfaces.h"

namespace tyndall::mesh {
namespace {

// The face opposite corner k, counter-clockwise seen from inside a positive tet.
constexpr std::array<std::array<int, 3>, 4> inward{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

std::array<Point, 3> corners_of(const ConformingComplex& complex, FacetId facet) {
    std::array<Point, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = complex.points[complex.facets[facet.value].corners[k].value];
    return p;
}

Point nearest_on_segment(Point x, Point a, Point b) {
    const auto d = b - a;
    const double t = glm::dot(x - a, d) / glm::dot(d, d);
    return a + std::clamp(t, 0.0, 1.0) * d;
}

// Where x meets the plane of a triangle at right angles.
Point on_plane(Point x, const std::array<Point, 3>& p) {
    const auto n = glm::cross(p[1] - p[0], p[2] - p[0]);
    return x - glm::dot(x - p[0], n) / glm::dot(n, n) * n;
}

double distance_to(Point x, const std::array<Point, 3>& p) {
    const auto n = glm::cross(p[1] - p[0], p[2] - p[0]);
    bool over = true;  // the triangle, not beside it
    for (int k = 0; k < 3; ++k)
        over = over && glm::dot(glm::cross(n, p[(k + 1) % 3] - p[k]), x - p[k]) >= 0.0;
    if (over) return std::abs(glm::dot(x - p[0], n)) / glm::length(n);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
        least = std::min(least, glm::distance(x, nearest_on_segment(x, p[k], p[(k + 1) % 3])));
    return least;
}

class NodeFitter {
  public:
    NodeFitter(const ConformingComplex& complex, double tolerance, FittedNodes& nodes)
        : complex_(complex), tolerance_(tolerance), nodes_(nodes) {}

    void move(std::uint32_t node) {
        if (!to_corner(node) && !to_edge(node)) {
            Point& x = nodes_.points[node];
            x = on_plane(x, corners_of(complex_, nodes_.facets[node].front()));
        }
    }

  private:
    bool to_corner(std::uint32_t node) {
        double least = tolerance_;
        VertexId nearest;
        for (const FacetId facet : nodes_.facets[node])
            for (const VertexId corner : complex_.facets[facet.value].corners) {
                const double away =
                    glm::distance(complex_.points[corner.value], nodes_.points[node]);
                if (away > least || (away == least && nearest.valid())) continue;
                least = away;
                nearest = corner;
            }
        if (!nearest.valid()) return false;
        nodes_.points[node] = complex_.points[nearest.value];
        nodes_.same[node] = nodes_.at_corner.try_emplace(nearest.value, node).first->second;
        return true;
    }

    bool to_edge(std::uint32_t node) {
        double least = tolerance_;
        std::array<std::uint32_t, 2> nearest{};
        bool found = false;
        Point moved(0);
        for (const FacetId facet : nodes_.facets[node])
            for (int k = 0; k < 3; ++k) {
                const auto& c = complex_.facets[facet.value].corners;
                const auto [a, b] = std::minmax(c[k].value, c[(k + 1) % 3].value);
                const Point there =
                    nearest_on_segment(nodes_.points[node], complex_.points[a], complex_.points[b]);
                const double away = glm::distance(there, nodes_.points[node]);
                if (away > least || (away == least && found)) continue;
                least = away;
                nearest = {a, b};
                moved = there;
                found = true;
            }
        if (!found) return false;
        nodes_.points[node] = moved;
        nodes_.on_edge[nearest].push_back(node);
        return true;
    }

    const ConformingComplex& complex_;
    double tolerance_;
    FittedNodes& nodes_;
};

}  // namespace

FacetFinder::FacetFinder(const ConformingComplex& complex, double tolerance)
    : complex_(complex), tolerance_(tolerance) {
    low_ = complex.points.front();
    Point high = low_;
    for (const Point& p : complex.points) {
        low_ = glm::min(low_, p);
        high = glm::max(high, p);
    }
    cells_ = std::clamp(
        static_cast<int>(std::cbrt(2.0 * static_cast<double>(complex.facets.size()))), 1, 64);
    step_ = glm::max((high - low_) / double(cells_), Point(tolerance));
    lists_.resize(static_cast<std::size_t>(cells_) * cells_ * cells_);
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
        const auto p = corners_of(complex, FacetId(f));
        const auto from = cell_of(glm::min(glm::min(p[0], p[1]), p[2]) - tolerance);
        const auto to = cell_of(glm::max(glm::max(p[0], p[1]), p[2]) + tolerance);
        for (int z = from.z; z <= to.z; ++z)
            for (int y = from.y; y <= to.y; ++y)
                for (int x = from.x; x <= to.x; ++x) lists_[cell({x, y, z})].push_back(FacetId(f));
    }
}

glm::ivec3 FacetFinder::cell_of(Point x) const {
    return glm::ivec3(
        glm::clamp(glm::floor((x - low_) / step_), Point(0.0), Point(double(cells_ - 1))));
}

std::vector<FacetId> FacetFinder::at(Point x) const {
    std::vector<FacetId> found;
    for (const FacetId facet : lists_[cell(cell_of(x))])
        if (distance_to(x, corners_of(complex_, facet)) <= tolerance_) found.push_back(facet);
    return found;
}

FittedNodes fit_nodes(const TetFile& file, const ConformingComplex& complex,
                      const FacetFinder& finder, double tolerance) {
    FittedNodes nodes;
    nodes.points = file.points;
    nodes.same.resize(file.points.size());
    std::iota(nodes.same.begin(), nodes.same.end(), 0u);
    NodeFitter fitter(complex, tolerance, nodes);
    for (std::uint32_t n = 0; n < file.points.size(); ++n) {
        nodes.facets.push_back(finder.at(file.points[n]));
        if (nodes.facets[n].empty()) continue;
        fitter.move(n);
        nodes.facets[n] = finder.at(nodes.points[n]);  // a corner has more than what was near it
    }
    return nodes;
}

std::vector<TetFace> faces_of(const TetFile& file, std::span<const Point> points) {
    struct Sorted {
        std::array<std::uint32_t, 3> key;
        std::uint32_t tet;
        int k;
    };
    std::vector<Sorted> sorted;
    sorted.reserve(4 * file.tets.size());
    for (std::uint32_t t = 0; t < file.tets.size(); ++t)
        for (int k = 0; k < 4; ++k) {
            Sorted face{{}, t, k};
            for (int i = 0; i < 3; ++i) face.key[i] = file.tets[t].corners[inward[k][i]];
            std::sort(face.key.begin(), face.key.end());
            sorted.push_back(face);
        }
    std::sort(sorted.begin(), sorted.end(), [](const Sorted& a, const Sorted& b) {
        return std::tie(a.key, a.tet) < std::tie(b.key, b.tet);
    });
    const auto side = [&](const Sorted& face) {
        const auto& c = file.tets[face.tet].corners;
        const Point& a = points[face.key[0]];
        return glm::dot(glm::cross(points[face.key[1]] - a, points[face.key[2]] - a),
                        points[c[face.k]] - a) > 0.0;
    };
    std::vector<TetFace> faces;
    for (std::size_t i = 0, end; i < sorted.size(); i = end) {
        for (end = i + 1; end < sorted.size() && sorted[end].key == sorted[i].key;) ++end;
        const Sorted& first = sorted[i];
        if (end - i > 2 || (end - i == 2 && side(first) == side(sorted[i + 1]))) {
            const Point x = points[first.key[0]];
            throw InputError(fmt::format(
                "{} overlaps tetrahedron {} near [{:.6g}, {:.6g}, {:.6g}]: both lie on the same "
                "side of a face they share. Mesh the volume again.",
                file.place(first.tet), file.tets[sorted[end - 1].tet].number, x.x, x.y, x.z));
        }
        const auto& c = file.tets[first.tet].corners;
        const auto& order = inward[first.k];
        faces.push_back({{c[order[0]], c[order[1]], c[order[2]]}, first.tet, end - i == 1});
    }
    return faces;
}

}  // namespace tyndall::mesh
