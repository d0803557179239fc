// Planes of the soup: which pieces share one, and points moved onto them.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "mesh/conform_soup.h"

namespace tyndall::mesh::conforming {

namespace {

// The axis that flattening drops, and the two that it keeps, in cyclic order.
std::array<int, 3> axes(const Direction& normal) {
    const auto n = glm::abs(normal);
    const int drop = n.x >= n.y && n.x >= n.z ? 0 : (n.y >= n.z ? 1 : 2);
    return {drop, (drop + 1) % 3, (drop + 2) % 3};
}

}  // namespace

double Plane::above(Point x) const {
    return glm::dot(normal, x) - offset;
}

glm::dvec2 Plane::flatten(Point x) const {
    const auto [drop, u, v] = axes(normal);
    return normal[drop] > 0.0 ? glm::dvec2(x[u], x[v]) : glm::dvec2(x[v], x[u]);
}

Point Plane::lift(glm::dvec2 x) const {
    const auto [drop, u, v] = axes(normal);
    Point result(0.0);
    result[u] = normal[drop] > 0.0 ? x.x : x.y;
    result[v] = normal[drop] > 0.0 ? x.y : x.x;
    result[drop] = (offset - normal[u] * result[u] - normal[v] * result[v]) / normal[drop];
    return result;
}

glm::dvec3 area_vector(const Soup& soup, const std::vector<Index>& loop) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        const auto& p = soup.at(loop[0]);
        sum += glm::cross(soup.at(loop[i]) - p, soup.at(loop[i + 1]) - p);
    }
    return 0.5 * sum;
}

std::optional<Plane> fit_plane(const Soup& soup, const std::vector<Index>& loop) {
    if (loop.size() < 3) {
        return {};
    }
    const auto base = soup.at(loop[0]);
    glm::dvec3 longest(0.0), normal(0.0);
    for (const auto i : loop) {
        const auto side = soup.at(i) - base;
        if (glm::dot(side, side) > glm::dot(longest, longest)) {
            longest = side;
        }
    }
    for (const auto i : loop) {
        const auto candidate = glm::cross(longest, soup.at(i) - base);
        if (glm::dot(candidate, candidate) > glm::dot(normal, normal)) {
            normal = candidate;
        }
    }
    if (glm::length(normal) <= soup.tolerance * glm::length(longest)) {
        return {};
    }
    normal /= glm::length(normal);  // not normalize(): an axis must stay one to the last bit
    if (glm::dot(normal, area_vector(soup, loop)) < 0.0) {
        normal = -normal;
    }
    return Plane{normal, glm::dot(normal, base)};
}

void clean_loop(std::vector<Index>& loop) {
    bool changed = true;
    while (changed && !loop.empty()) {
        changed = false;
        for (std::size_t i = 0; i < loop.size() && loop.size() > 1; ++i) {
            const auto n = loop.size();
            if (loop[i] == loop[(i + 1) % n] || loop[(i + n - 1) % n] == loop[(i + 1) % n]) {
                loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
                changed = true;
                break;
            }
        }
        if (loop.size() < 3) {
            loop.clear();
        }
    }
}

Pairs near_pieces(const Soup& soup) {
    std::vector<Box> boxes;
    boxes.reserve(soup.pieces.size());
    for (const auto& piece : soup.pieces) {
        Box box{soup.at(piece.loop[0]), soup.at(piece.loop[0])};
        for (const auto i : piece.loop) {
            box.min = glm::min(box.min, soup.at(i));
            box.max = glm::max(box.max, soup.at(i));
        }
        boxes.push_back({box.min - Point(soup.tolerance), box.max + Point(soup.tolerance)});
    }
    return touching_pairs(boxes);
}

namespace {

using Neighbours = std::vector<std::vector<Index>>;

Neighbours neighbours_of(std::size_t count, const Pairs& near) {
    Neighbours result(count);
    for (const auto& [i, j] : near) {
        result[i].push_back(j);
        result[j].push_back(i);
    }
    return result;
}

// Pieces with the largest area first.
std::vector<Index> by_area(const Soup& soup) {
    std::vector<double> areas;
    for (const auto& piece : soup.pieces) {
        areas.push_back(glm::length(area_vector(soup, piece.loop)));
    }
    std::vector<Index> order(soup.pieces.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return areas[a] > areas[b]; });
    return order;
}

bool lies_in(const Soup& soup, const Piece& piece, const Plane& plane) {
    return std::all_of(piece.loop.begin(), piece.loop.end(), [&](Index i) {
        return std::abs(plane.above(soup.at(i))) <= soup.tolerance;
    });
}

}  // namespace

void find_planes(Soup& soup, const Pairs& near) {
    const auto neighbours = neighbours_of(soup.pieces.size(), near);
    std::vector<bool> placed(soup.pieces.size(), false);
    soup.planes.clear();
    for (const auto leader : by_area(soup)) {
        if (placed[leader]) {
            continue;
        }
        // Pieces join through their neighbours but are measured against the leader: no drift.
        const auto plane = fit_plane(soup, soup.pieces[leader].loop);
        const auto number = static_cast<Index>(soup.planes.size());
        soup.planes.push_back(
            plane.value_or(Plane{{0, 0, 1}, soup.at(soup.pieces[leader].loop[0]).z}));
        std::vector<Index> open{leader};
        placed[leader] = true;
        while (!open.empty()) {
            const auto piece = open.back();
            open.pop_back();
            soup.pieces[piece].plane = number;
            for (const auto next : neighbours[piece]) {
                if (!placed[next] && lies_in(soup, soup.pieces[next], soup.planes[number])) {
                    placed[next] = true;
                    open.push_back(next);
                }
            }
        }
    }
}

namespace {

// x moved onto as many of the planes as can be met together, in their order. Each plane is
// met along directions that keep the ones before (Gram–Schmidt); a plane nearly parallel to those
// is left.
Point onto_planes(const Soup& soup, const std::vector<Index>& planes, Point x) {
    const Point start = x;
    std::vector<Direction> kept;
    for (const auto p : planes) {
        const auto& plane = soup.planes[p];
        auto along = plane.normal;
        for (const auto& direction : kept) {
            along -= glm::dot(along, direction) * direction;
        }
        const double slope = glm::dot(along, plane.normal);
        if (kept.size() == 3 || slope < 1e-4) {
            continue;
        }
        const double distance = plane.above(x);
        const auto moved = x - (distance / slope) * along;
        // Already as near as doubles can be: exact coordinates stay exact.
        const bool there = std::abs(distance) <= 1e-15 * (std::abs(plane.offset) + glm::length(x));
        if (!there && glm::distance(moved, start) <= 4.0 * soup.tolerance) {
            x = moved;
        }
        kept.push_back(glm::normalize(along));
    }
    return x;
}

std::vector<std::vector<Index>> planes_of_points(const Soup& soup, const Pairs& near) {
    std::vector<std::vector<Index>> planes(soup.weld.points().size());
    for (const auto& piece : soup.pieces) {
        for (const auto i : piece.loop) {
            planes[i].push_back(piece.plane);
        }
    }
    const auto touch = [&](const Piece& p, const Piece& q) {
        for (const auto i : p.loop) {
            if (std::abs(soup.plane_of(q).above(soup.at(i))) <= soup.tolerance &&
                holds(soup, q, soup.at(i))) {
                planes[i].push_back(q.plane);
            }
        }
    };
    for (const auto& [i, j] : near) {
        if (soup.pieces[i].plane != soup.pieces[j].plane) {
            touch(soup.pieces[i], soup.pieces[j]);
            touch(soup.pieces[j], soup.pieces[i]);
        }
    }
    for (auto& list : planes) {  // planes are numbered by area: the largest first
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return planes;
}

}  // namespace

void snap_to_planes(Soup& soup, const Pairs& near) {
    const auto planes = planes_of_points(soup, near);
    PointWeld weld(soup.tolerance);
    std::vector<Index> renumbered;
    for (Index i = 0; i < planes.size(); ++i) {
        renumbered.push_back(weld.number(onto_planes(soup, planes[i], soup.at(i))));
    }
    soup.weld = std::move(weld);
    for (auto& piece : soup.pieces) {
        for (auto& i : piece.loop) {
            i = renumbered[i];
        }
        clean_loop(piece.loop);
    }
    std::erase_if(soup.pieces, [](const Piece& piece) { return piece.loop.empty(); });
}

}  // namespace tyndall::mesh::conforming
