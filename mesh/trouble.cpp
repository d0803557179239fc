#include "mesh/trouble.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

#include "mesh/conform_exact.h"

namespace tyndall::mesh {

namespace {

using conforming::Box;
using conforming::Index;

std::array<Point, 3> corners_of(const ConformingComplex& complex, Index facet) {
    const auto& corners = complex.facets[facet].corners;
    return {complex.points[corners[0].value], complex.points[corners[1].value],
            complex.points[corners[2].value]};
}

Point nearest_on_edge(Point x, Point a, Point b) {
    const auto along = b - a;
    const double square = glm::dot(along, along);
    const double t = square > 0.0 ? glm::clamp(glm::dot(x - a, along) / square, 0.0, 1.0) : 0.0;
    return a + t * along;
}

double distance(Point x, const std::array<Point, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const auto n = glm::cross(b - a, c - a);
    bool inside = true;
    double least = INFINITY;
    for (int k = 0; k < 3; ++k) {
        const auto &p = triangle[k], &q = triangle[(k + 1) % 3];
        inside = inside && glm::dot(glm::cross(n, q - p), x - p) >= 0.0;
        least = std::min(least, glm::distance(x, nearest_on_edge(x, p, q)));
    }
    const double length = glm::length(n);
    return inside && length > 0.0 ? std::abs(glm::dot(x - a, n)) / length : least;
}

Trouble gap_between(const ConformingComplex& complex, Index i, Index j) {
    const auto s = corners_of(complex, i), t = corners_of(complex, j);
    Trouble trouble{FacetId(i), FacetId(j), s[0], INFINITY};
    const auto note = [&](Point x, double gap) {
        if (gap < trouble.gap) {
            trouble.gap = gap;
            trouble.where = x;
        }
    };
    for (int k = 0; k < 3; ++k) {
        note(s[k], distance(s[k], t));
        note(t[k], distance(t[k], s));
    }
    return trouble;
}

bool connected(const ConformingComplex& complex, Index i, Index j) {
    const auto &p = complex.facets[i].corners, &q = complex.facets[j].corners;
    return std::find_first_of(p.begin(), p.end(), q.begin(), q.end()) != p.end();
}

std::optional<Trouble> find_crossing(const ConformingComplex& complex) {
    std::vector<std::array<Index, 3>> triangles;
    for (const auto& facet : complex.facets) {
        triangles.push_back(
            {facet.corners[0].value, facet.corners[1].value, facet.corners[2].value});
    }
    const auto pairs = conforming::crossing_pairs(complex.points, triangles);
    if (pairs.empty()) {
        return {};
    }
    const auto [i, j] = pairs.front();
    // The middle of what their boxes have in common is near enough to go and look.
    const auto s = corners_of(complex, i), t = corners_of(complex, j);
    const auto low =
        glm::max(glm::min(glm::min(s[0], s[1]), s[2]), glm::min(glm::min(t[0], t[1]), t[2]));
    const auto high =
        glm::min(glm::max(glm::max(s[0], s[1]), s[2]), glm::max(glm::max(t[0], t[1]), t[2]));
    return Trouble{FacetId(i), FacetId(j), 0.5 * (low + high), 0.0};
}

}  // namespace

std::optional<Trouble> find_trouble(const ConformingComplex& complex) {
    if (auto crossing = find_crossing(complex)) {
        return crossing;
    }
    Point low = complex.points.front(), high = low;
    for (const auto& point : complex.points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    const double reach = 1e-3 * glm::distance(low, high);
    std::vector<Box> boxes;
    for (Index f = 0; f < complex.facets.size(); ++f) {
        const auto [a, b, c] = corners_of(complex, f);
        boxes.push_back({glm::min(glm::min(a, b), c) - 0.5 * Point(reach),
                         glm::max(glm::max(a, b), c) + 0.5 * Point(reach)});
    }
    std::optional<Trouble> nearest;
    for (const auto& [i, j] : conforming::touching_pairs(boxes)) {
        if (!connected(complex, i, j)) {
            const auto trouble = gap_between(complex, i, j);
            if (trouble.gap <= reach && (!nearest || trouble.gap < nearest->gap)) {
                nearest = trouble;
            }
        }
    }
    return nearest;
}

std::string names_of(std::span<const FacetId> facets, const ConformingComplex& complex,
                     std::span<const Polygon> polygons) {
    std::set<std::string> names;
    for (const auto facet : facets) {
        for (const auto polygon : complex.facets[facet.value].polygons) {
            const bool named =
                polygon.value < polygons.size() && !polygons[polygon.value].name.empty();
            names.insert(named ? fmt::format("\"{}\"", polygons[polygon.value].name)
                               : fmt::format("polygon {}", polygon.value));
        }
    }
    constexpr std::size_t most = 6;
    std::string list;
    std::size_t listed = 0;
    for (const auto& name : names) {
        if (listed++ == most) {
            return list + fmt::format(" and {} more", names.size() - most);
        }
        list += (list.empty() ? "" : ", ") + name;
    }
    return list;
}

}  // namespace tyndall::mesh
