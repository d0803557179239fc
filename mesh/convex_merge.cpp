#include "mesh/convex_merge.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <unordered_map>

namespace tyndall::mesh {
namespace {

constexpr std::size_t largest_group = 4096;   // triangles that are merged together
constexpr std::size_t most_candidates = 128;  // lines tried as the next cut
constexpr double largest_loss = 1e-7;         // of the surface, to tolerances and rounding

// A corner in the plane; `at` is the same point in space, kept bit-exact for input vertices so that
// neighbours still share it.
struct Corner {
    glm::dvec2 uv;
    Point at;
};

// A convex part of the surface. outline[k]: the edge from corner k to k + 1 bounds the surface.
struct Part {
    std::vector<Corner> corners;
    std::vector<bool> outline;
};

using Cell = std::vector<Part>;

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// A directed line; the surface beside the outline edge it comes from is on its left.
struct Line {
    glm::dvec2 origin, direction;
    double left_of(glm::dvec2 p) const { return cross(direction, p - origin); }
};

struct Plane {
    Point origin;
    Direction u, v, normal;

    Plane(Point a, Point b, Point c) : origin(a) {
        normal = glm::normalize(glm::cross(b - a, c - a));
        u = glm::normalize(b - a);
        v = glm::cross(normal, u);
    }
    Corner operator()(Point p) const {
        return {{glm::dot(p - origin, u), glm::dot(p - origin, v)}, p};
    }
};

std::vector<Line> outline_lines(const Cell& cell) {
    std::vector<Line> lines;
    for (const Part& part : cell)
        for (std::size_t k = 0; k < part.corners.size(); ++k) {
            if (!part.outline[k]) continue;
            const auto a = part.corners[k].uv;
            const auto b = part.corners[(k + 1) % part.corners.size()].uv;
            if (const double length = glm::length(b - a); length > 0.0)
                lines.push_back({a, (b - a) / length});
        }
    return lines;
}

bool surface_on_right(const Cell& cell, const Line& line, double tolerance) {
    for (const Part& part : cell)
        for (const Corner& corner : part.corners)
            if (line.left_of(corner.uv) < -tolerance) return true;
    return false;
}

// Outline edges that the line would cut, less twice those that lie on it: the fewer the better.
long cut_cost(const Cell& cell, const Line& line, double tolerance) {
    long cost = 0;
    for (const Part& part : cell)
        for (std::size_t k = 0; k < part.corners.size(); ++k) {
            if (!part.outline[k]) continue;
            const double a = line.left_of(part.corners[k].uv);
            const double b = line.left_of(part.corners[(k + 1) % part.corners.size()].uv);
            if (std::abs(a) <= tolerance && std::abs(b) <= tolerance) cost -= 2;
            if ((a > tolerance && b < -tolerance) || (a < -tolerance && b > tolerance)) ++cost;
        }
    return cost;
}

// Cuts one part; either half may come out empty.
void cut(const Part& part, const Line& line, double tolerance, Part& left, Part& right) {
    const std::size_t n = part.corners.size();
    const auto add = [](Part& to, const Corner& corner, bool outline) {
        to.corners.push_back(corner);
        to.outline.push_back(outline);
    };
    for (std::size_t k = 0; k < n; ++k) {
        const Corner& a = part.corners[k];
        const Corner& b = part.corners[(k + 1) % n];
        double da = line.left_of(a.uv), db = line.left_of(b.uv);
        if (std::abs(da) <= tolerance) da = 0.0;
        if (std::abs(db) <= tolerance) db = 0.0;
        // An edge that starts on the line belongs to the half it goes into; to the other half the
        // edge from here is the cut itself.
        if (da >= 0.0) add(left, a, part.outline[k] && !(da == 0.0 && db < 0.0));
        if (da <= 0.0) add(right, a, part.outline[k] && !(da == 0.0 && db > 0.0));
        if (da * db < 0.0) {
            const double t = da / (da - db);
            const Corner x{a.uv + (b.uv - a.uv) * t, a.at + (b.at - a.at) * t};
            add(left, x, part.outline[k] && db > 0.0);
            add(right, x, part.outline[k] && db < 0.0);
        }
    }
}

double area(const Part& part) {
    double twice = 0.0;
    for (std::size_t k = 1; k + 1 < part.corners.size(); ++k)
        twice += cross(part.corners[k].uv - part.corners[0].uv,
                       part.corners[k + 1].uv - part.corners[0].uv);
    return 0.5 * twice;
}

double area(const std::vector<Point>& polygon) {
    Direction twice(0.0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return 0.5 * glm::length(twice);
}

// Whether b can go from the chain a, b, c because it is within `tolerance` of the line a c.
bool straight(const Corner& a, const Corner& b, const Corner& c, double tolerance) {
    return cross(b.uv - a.uv, c.uv - a.uv) <= tolerance * glm::length(c.uv - a.uv);
}

// A direction that no edge is square to, as far as may be: corners on an edge sort by it in the
// order they have along the edge, however they round.
glm::dvec2 sorting_direction(const Cell& cell) {
    constexpr int tried = 37;
    glm::dvec2 best(1.0, 0.0);
    double best_cosine = -1.0;
    for (int k = 0; k < tried; ++k) {
        const double angle = 3.14159265358979 * k / tried;
        const glm::dvec2 direction(std::cos(angle), std::sin(angle));
        double cosine = 1.0;
        for (const Part& part : cell)
            for (std::size_t c = 0; c < part.corners.size() && cosine > best_cosine; ++c) {
                const auto edge =
                    part.corners[(c + 1) % part.corners.size()].uv - part.corners[c].uv;
                if (const double length = glm::length(edge); length > 0.0)
                    cosine = std::min(cosine, std::abs(glm::dot(edge, direction)) / length);
            }
        if (cosine > best_cosine) best = direction, best_cosine = cosine;
    }
    return best;
}

// Corners of all parts in the order along a direction, each once.
std::vector<Corner> sorted_corners(const Cell& cell, glm::dvec2 along, double tolerance) {
    std::vector<Corner> all, kept;
    for (const Part& part : cell) all.insert(all.end(), part.corners.begin(), part.corners.end());
    std::sort(all.begin(), all.end(), [&](const Corner& a, const Corner& b) {
        const double at_a = glm::dot(a.uv, along), at_b = glm::dot(b.uv, along);
        return at_a != at_b ? at_a < at_b : cross(along, a.uv) < cross(along, b.uv);
    });
    for (const Corner& c : all) {
        bool twice = false;
        for (std::size_t k = kept.size(); k-- > 0 && !twice;) {
            if (glm::dot(c.uv - kept[k].uv, along) > tolerance) break;
            twice = glm::length(c.uv - kept[k].uv) <= tolerance;
        }
        if (!twice) kept.push_back(c);
    }
    return kept;
}

// Andrew's monotone chain; corners within `tolerance` of a straight edge are left out.
std::vector<Point> hull(const Cell& cell, double tolerance) {
    const auto all = sorted_corners(cell, sorting_direction(cell), tolerance);
    std::vector<Corner> chain;
    const auto extend = [&](const Corner& c, std::size_t base) {
        while (chain.size() >= base + 2 &&
               straight(chain[chain.size() - 2], chain.back(), c, tolerance))
            chain.pop_back();
        chain.push_back(c);
    };
    for (const Corner& c : all) extend(c, 0);
    const std::size_t lower = chain.size() - 1;
    for (std::size_t k = all.size() - 1; k-- > 0;) extend(all[k], lower);
    if (chain.size() > 1) chain.pop_back();  // the first once more
    std::vector<Point> corners;
    for (std::size_t k = 0, n = chain.size(); k < n; ++k)  // straight where the two chains meet
        if (!straight(chain[(k + n - 1) % n], chain[k], chain[(k + 1) % n], tolerance))
            corners.push_back(chain[k].at);
    return corners;
}

// Cuts the cell until convex; appends the hulls. False as soon as there would be more than `most`.
bool convexify(Cell cell, double tolerance, std::size_t most,
               std::vector<std::vector<Point>>& out) {
    std::vector<Cell> open{std::move(cell)};
    while (!open.empty()) {
        cell = std::move(open.back());
        open.pop_back();
        const auto lines = outline_lines(cell);
        const std::size_t stride = 1 + lines.size() / most_candidates;
        const Line* best = nullptr;
        long best_cost = 0;
        for (std::size_t k = 0; k < lines.size(); ++k) {
            if (best && k % stride != 0) continue;
            if (!surface_on_right(cell, lines[k], tolerance)) continue;
            const long cost = cut_cost(cell, lines[k], tolerance);
            if (!best || cost < best_cost) best = &lines[k], best_cost = cost;
        }
        if (!best) {
            if (auto corners = hull(cell, tolerance); corners.size() >= 3)
                out.push_back(std::move(corners));
            if (out.size() + open.size() > most) return false;
            continue;
        }
        Cell left, right;
        for (const Part& part : cell) {
            Part l, r;
            cut(part, *best, tolerance, l, r);
            if (area(l) > tolerance * tolerance) left.push_back(std::move(l));
            if (area(r) > tolerance * tolerance) right.push_back(std::move(r));
        }
        if (!left.empty()) open.push_back(std::move(left));
        if (!right.empty()) open.push_back(std::move(right));
    }
    return out.size() <= most;
}

class Merger {
  public:
    Merger(std::span<const Point> points, std::span<const std::array<VertexId, 3>> triangles,
           Facing facing, double tolerance)
        : points_(points), triangles_(triangles), facing_(facing), tolerance_(tolerance) {
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) at_edge_[edge(t, k)].push_back(t);
    }

    std::vector<ConvexPolygon> run() {
        std::vector<bool> seen(triangles_.size(), false);
        for (std::size_t seed = 0; seed < triangles_.size(); ++seed) {
            if (seen[seed]) continue;
            const Plane plane(corner(seed, 0), corner(seed, 1), corner(seed, 2));
            merge(group(seed, plane, seen), plane);
        }
        return std::move(polygons_);
    }

  private:
    Point corner(std::size_t t, int k) const { return points_[triangles_[t][k].value]; }

    std::uint64_t edge(std::size_t t, int k) const {
        const std::uint64_t a = triangles_[t][k].value, b = triangles_[t][(k + 1) % 3].value;
        return (std::min(a, b) << 32) | std::max(a, b);
    }

    bool joins(std::size_t t, const Plane& plane) const {
        for (int k = 0; k < 3; ++k)
            if (std::abs(glm::dot(corner(t, k) - plane.origin, plane.normal)) > tolerance_)
                return false;
        const auto n = glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
        return facing_ == Facing::ignored || glm::dot(n, plane.normal) > 0.0;
    }

    std::vector<std::size_t> group(std::size_t seed, const Plane& plane, std::vector<bool>& seen) {
        std::vector<std::size_t> members{seed};
        seen[seed] = true;
        for (std::size_t m = 0; m < members.size() && members.size() < largest_group; ++m)
            for (int k = 0; k < 3; ++k)
                for (const std::size_t t : at_edge_[edge(members[m], k)])
                    if (!seen[t] && joins(t, plane)) {
                        seen[t] = true;
                        members.push_back(t);
                    }
        return members;
    }

    void merge(const std::vector<std::size_t>& members, const Plane& plane) {
        std::unordered_map<std::uint64_t, int> uses;
        for (const std::size_t t : members)
            for (int k = 0; k < 3; ++k) ++uses[edge(t, k)];
        Cell cell;
        for (const std::size_t t : members) {
            Part part;
            for (int k = 0; k < 3; ++k) {
                part.corners.push_back(plane(corner(t, k)));
                part.outline.push_back(uses[edge(t, k)] == 1);
            }
            if (area(part) < 0.0) {
                std::swap(part.corners[0], part.corners[2]);  // edges 0 and 1 change places
                const bool first = part.outline[0];
                part.outline[0] = part.outline[1];
                part.outline[1] = first;
            }
            cell.push_back(std::move(part));
        }
        std::vector<std::vector<Point>> hulls;
        double merged = 0.0, whole = 0.0;
        const bool convex = convexify(cell, tolerance_, members.size(), hulls);
        for (const Part& part : cell) whole += area(part);
        for (const auto& corners : hulls) merged += area(corners);
        // A hole would let light through: rather the triangles.
        if (!convex || std::abs(merged - whole) > largest_loss * whole) {
            hulls.clear();
            for (const Part& part : cell)
                hulls.push_back({part.corners[0].at, part.corners[1].at, part.corners[2].at});
        }
        for (auto& corners : hulls) polygons_.push_back({std::move(corners), plane.normal});
    }

    std::span<const Point> points_;
    std::span<const std::array<VertexId, 3>> triangles_;
    Facing facing_;
    double tolerance_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> at_edge_;
    std::vector<ConvexPolygon> polygons_;
};

}  // namespace

std::vector<ConvexPolygon> convex_merge(std::span<const Point> points,
                                        std::span<const std::array<VertexId, 3>> triangles,
                                        Facing facing, double tolerance) {
    return Merger(points, triangles, facing, tolerance).run();
}

}  // namespace tyndall::mesh
