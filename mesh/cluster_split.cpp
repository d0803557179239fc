// Sets of base tets or facet sides split from the top until no opaque facet enters them, and on to
// single ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/cluster_graph.h"

namespace tyndall::mesh {
namespace {

// Normals of the hull's pairs of faces: those of a cube, its edges and its corners.
const std::array<Direction, 13> hull_normals = [] {
    std::array<Direction, 13> normals;
    std::size_t n = 0;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (9 * x + 3 * y + z > 0) normals[n++] = glm::normalize(Direction(x, y, z));
    return normals;
}();

// Which of them are along x, y and z.
constexpr std::array<std::size_t, 3> axis_normals{8, 2, 0};

struct Hull {
    std::array<double, 13> low, high;  // along the normals [m]

    Hull() {
        low.fill(1e300);
        high.fill(-1e300);
    }
    void add(Point p) {
        for (std::size_t d = 0; d < low.size(); ++d) {
            const double at = glm::dot(p, hull_normals[d]);
            low[d] = std::min(low[d], at);
            high[d] = std::max(high[d], at);
        }
    }
    double extent() const {
        double widest = 0.0;
        for (std::size_t d = 0; d < low.size(); ++d) widest = std::max(widest, high[d] - low[d]);
        return widest;
    }
    bool apart(const Hull& other, double tolerance) const {
        for (std::size_t d = 0; d < low.size(); ++d)
            if (high[d] <= other.low[d] + tolerance || other.high[d] <= low[d] + tolerance)
                return true;
        return false;
    }
};

// A wall as a set meets it.
struct Wall {
    Direction normal;
    double offset;  // of the plane dot(normal, x) = offset [m]
    double area;    // [m^2]
    Hull hull;
    Direction outward;  // the normal towards its one side with items; 0 if both have, or none
};

// Around a curved convex body the hull of a set cuts off some of it, though the set lies on one
// side of its surface. Its facets may enter by this share of the set's extent, if their normals
// are within 60 degrees of each other: so a set wraps around no wall, however thin.
constexpr double curve_depth = 0.25, curve_cosine = 0.5;

class Splitter {
  public:
    Splitter(const BaseMesh& mesh, const ClusterGraph& graph)
        : mesh_(mesh),
          graph_(graph),
          connected_(graph),
          // Ten times the distance within which points of the input are one.
          tolerance_(1e-6 * glm::distance(mesh.hull_min, mesh.hull_max)) {
        for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
            if (mesh.facets[f].opacity != Opacity::opaque) continue;
            Wall wall{normal(mesh, FacetId(f)), 0.0, area(mesh, FacetId(f)), {}, {}};
            for (const VertexId v : mesh.facets[f].corners) wall.hull.add(mesh.points[v.value]);
            wall.offset = glm::dot(wall.normal, mesh.points[mesh.facets[f].corners[0].value]);
            wall.outward = outward(mesh.facets[f], wall.normal);
            walls_.push_back(wall);
        }
        std::stable_sort(walls_.begin(), walls_.end(),
                         [](const Wall& a, const Wall& b) { return a.area > b.area; });
    }

    ClusterTree run() {
        tree_.above.resize(graph_.size());
        for (std::uint32_t item = 0; item < graph_.size(); ++item)
            if (graph_.tags[item] != untagged) tree_.members.push_back(item);
        std::vector<std::uint32_t> all(walls_.size());
        for (std::size_t w = 0; w < all.size(); ++w) all[w] = static_cast<std::uint32_t>(w);
        push({0, tree_.members.size(), {}, all});
        while (!open_.empty()) {
            Set set = std::move(open_.back());
            open_.pop_back();
            process(set);
        }
        return std::move(tree_);
    }

  private:
    Direction outward(const BaseFacet& facet, Direction normal) const {
        if (graph_.corners_per_item != 4) return Direction(0.0);
        const auto has_items = [&](int side) {
            return facet.tets[side].valid() && graph_.tags[facet.tets[side].value] != untagged;
        };
        if (has_items(0) == has_items(1)) return Direction(0.0);
        return has_items(0) ? normal : -normal;
    }

    // A set of members; `walls` may enter it.
    struct Set {
        std::size_t begin, end;
        ClusterId parent;
        std::vector<std::uint32_t> walls;
    };

    std::span<std::uint32_t> items(const Set& set) {
        return std::span(tree_.members).subspan(set.begin, set.end - set.begin);
    }
    Point centroid(std::uint32_t item) const {
        Point sum(0.0);
        for (const VertexId v : graph_.corners_of(item)) sum += mesh_.points[v.value];
        return sum / static_cast<double>(graph_.corners_per_item);
    }

    // Opens the connected pieces of a set, so that the first is processed first.
    void push(const Set& set) {
        const auto ends = connected_(items(set));
        for (std::size_t k = ends.size(); k-- > 0;)
            open_.push_back({set.begin + (k > 0 ? ends[k - 1] : 0), set.begin + ends[k], set.parent,
                             set.walls});
    }

    void process(Set& set) {
        if (set.end - set.begin == 1) {
            tree_.above[tree_.members[set.begin]] = set.parent;
            return;
        }
        const Hull hull = hull_of(set);
        std::erase_if(set.walls,
                      [&](std::uint32_t w) { return raised_.apart(walls_[w].hull, tolerance_); });
        const Wall* wall = intruder(set, hull);
        std::size_t middle = set.begin;
        if (!wall) {
            const ClusterId id(tree_.clusters.size());
            tree_.clusters.push_back({static_cast<std::uint32_t>(set.begin),
                                      static_cast<std::uint32_t>(set.end), set.parent,
                                      static_cast<float>(hull.extent())});
            set.parent = id;
            set.walls.clear();
        } else {
            middle = split_by(set, *wall);
        }
        if (middle == set.begin || middle == set.end) middle = split_in_middle(set, hull);
        push({middle, set.end, set.parent, set.walls});
        push({set.begin, middle, set.parent, std::move(set.walls)});
    }

    // The hull of a set; `raised_` becomes the hull that nothing may enter.
    Hull hull_of(const Set& set) {
        Hull hull;
        for (const auto item : items(set))
            for (const VertexId v : graph_.corners_of(item)) hull.add(mesh_.points[v.value]);
        raised_ = hull;
        if (graph_.raised > 0.0) {
            const auto side = tree_.members[set.begin];
            const Direction up = (side % 2 ? -1.0 : 1.0) * normal(mesh_, FacetId(side / 2));
            for (std::size_t d = 0; d < hull_normals.size(); ++d) {
                const double by = graph_.raised * hull.extent() * glm::dot(up, hull_normals[d]);
                (by > 0.0 ? raised_.high : raised_.low)[d] += by;
            }
        }
        return hull;
    }

    // How deep a wall that meets the hull enters: how far the members reach on that side of its
    // plane on which they reach less far [m].
    double depth(const Set& set, const Hull& hull, const Wall& wall) {
        double low = -wall.offset, high = -wall.offset;  // of the members' box above the plane [m]
        for (int axis = 0; axis < 3; ++axis) {
            const double a = wall.normal[axis] * hull.low[axis_normals[axis]];
            const double b = wall.normal[axis] * hull.high[axis_normals[axis]];
            low += std::min(a, b);
            high += std::max(a, b);
        }
        if (low >= -tolerance_ || high <= tolerance_) return 0.0;
        double below = 0.0, above = 0.0;
        for (const auto item : items(set))
            for (const VertexId v : graph_.corners_of(item)) {
                const double at = glm::dot(wall.normal, mesh_.points[v.value]) - wall.offset;
                below = std::max(below, -at);
                above = std::max(above, at);
            }
        return std::min(below, above);
    }

    // The first wall that a set may not keep; none if it may be a cluster.
    const Wall* intruder(const Set& set, const Hull& hull) {
        const Wall* curved = nullptr;
        for (const auto w : set.walls) {
            const Wall& wall = walls_[w];
            const double by = depth(set, hull, wall);
            if (by <= tolerance_) continue;
            const bool shallow = wall.outward != Direction(0.0) && by < curve_depth * hull.extent();
            if (!shallow || (curved && glm::dot(wall.outward, curved->outward) < curve_cosine))
                return &wall;
            if (!curved) curved = &wall;
        }
        return nullptr;
    }

    std::size_t split_by(const Set& set, const Wall& wall) {
        const auto range = items(set);
        const auto middle =
            std::stable_partition(range.begin(), range.end(), [&](std::uint32_t item) {
                return glm::dot(wall.normal, centroid(item)) < wall.offset;
            });
        return set.begin + static_cast<std::size_t>(middle - range.begin());
    }

    std::size_t split_in_middle(const Set& set, const Hull& hull) {
        std::size_t longest = 0;
        for (std::size_t d = 0; d < hull_normals.size(); ++d)
            if (hull.high[d] - hull.low[d] > hull.high[longest] - hull.low[longest]) longest = d;
        const Direction axis = hull_normals[longest];
        const auto range = items(set);
        const auto half = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
        std::vector<std::pair<double, std::uint32_t>> places;
        for (const auto item : range) places.push_back({glm::dot(axis, centroid(item)), item});
        std::sort(places.begin(), places.end());
        for (std::size_t k = 0; k < places.size(); ++k) range[k] = places[k].second;
        return set.begin + static_cast<std::size_t>(half - range.begin());
    }

    const BaseMesh& mesh_;
    const ClusterGraph& graph_;
    Connected connected_;
    double tolerance_;
    std::vector<Wall> walls_;  // largest first
    std::vector<Set> open_;
    Hull raised_;
    ClusterTree tree_;
};

}  // namespace

ClusterTree split_clusters(const BaseMesh& mesh, const ClusterGraph& graph) {
    return Splitter(mesh, graph).run();
}

}  // namespace tyndall::mesh
