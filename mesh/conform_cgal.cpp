// The only file that sees CGAL: it compiles in half a minute and needs -frounding-math.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <map>

#include <glm/common.hpp>

#include "mesh/conform_exact.h"

namespace tyndall::mesh::conforming {

namespace {

constexpr Index unnumbered = ~Index(0);

struct FaceInfo {
    bool reached = false;
    std::vector<Index> loops;  // ascending
};

struct VertexInfo {
    Index index = unnumbered;
};

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Exact>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Exact, CGAL::Triangulation_face_base_with_info_2<FaceInfo, Exact>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Delaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Exact, Structure, CGAL::Exact_intersections_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

// The loops that pass a piece of a segment, by the two ends of the piece.
using EdgeLoops = std::map<std::pair<Index, Index>, std::vector<Index>>;

std::pair<Index, Index> edge_key(Index a, Index b) {
    return std::minmax(a, b);
}

// Symmetric difference of sorted lists: a loop passed twice is not passed.
void toggle(std::vector<Index>& loops, const std::vector<Index>& by) {
    std::vector<Index> result;
    std::set_symmetric_difference(loops.begin(), loops.end(), by.begin(), by.end(),
                                  std::back_inserter(result));
    loops = std::move(result);
}

// Inserts points and segments; returns each segment's handle, in order.
std::vector<Triangulation::Constraint_id> insert(const PlanarSoup& soup, Triangulation& cdt) {
    std::vector<Vertex> vertices;
    vertices.reserve(soup.points.size());
    Face hint;
    for (Index i = 0; i < soup.points.size(); ++i) {
        const auto vertex = cdt.insert(Exact::Point_2(soup.points[i].x, soup.points[i].y), hint);
        if (vertex->info().index == unnumbered) {
            vertex->info().index = i;
        }
        hint = vertex->face();
        vertices.push_back(vertex);
    }
    std::vector<Triangulation::Constraint_id> ids;
    ids.reserve(soup.segments.size());
    for (const auto& [a, b] : soup.segments) {
        ids.push_back(vertices[a] == vertices[b] ? Triangulation::Constraint_id(nullptr)
                                                 : cdt.insert_constraint(vertices[a], vertices[b]));
    }
    return ids;
}

// Crossings get numbers in the order of their coordinates, so that they do not depend on memory
// addresses.
void number_crossings(Triangulation& cdt, std::vector<glm::dvec2>& points) {
    std::vector<Vertex> crossings;
    for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
        if (v->info().index == unnumbered) {
            CGAL::exact(
                v->point());  // so that rounding does not depend on what was evaluated before
            crossings.push_back(v);
        }
    }
    std::sort(crossings.begin(), crossings.end(),
              [](Vertex a, Vertex b) { return a->point() < b->point(); });
    for (const auto v : crossings) {
        v->info().index = static_cast<Index>(points.size());
        points.emplace_back(CGAL::to_double(v->point().x()), CGAL::to_double(v->point().y()));
    }
}

EdgeLoops edge_loops(const PlanarSoup& soup, const Triangulation& cdt,
                     const std::vector<Triangulation::Constraint_id>& ids) {
    EdgeLoops result;
    for (std::size_t s = 0; s < ids.size(); ++s) {
        if (ids[s] == Triangulation::Constraint_id(nullptr) || soup.segment_loops[s].empty()) {
            continue;
        }
        auto v = cdt.vertices_in_constraint_begin(ids[s]);
        const auto end = cdt.vertices_in_constraint_end(ids[s]);
        for (auto next = std::next(v); next != end; ++v, ++next) {
            toggle(result[edge_key((*v)->info().index, (*next)->info().index)],
                   soup.segment_loops[s]);
        }
    }
    return result;
}

// Floods from the infinite face; crossing a loop's edge goes in or out of the loop.
void find_insides(Triangulation& cdt, const EdgeLoops& loops) {
    std::vector<Face> open{cdt.infinite_face()};
    open.front()->info().reached = true;
    while (!open.empty()) {
        const auto face = open.back();
        open.pop_back();
        for (int k = 0; k < 3; ++k) {
            const auto next = face->neighbor(k);
            if (next->info().reached) {
                continue;
            }
            next->info().reached = true;
            next->info().loops = face->info().loops;
            const auto found = face->is_constrained(k)
                                   ? loops.find(edge_key(face->vertex(cdt.cw(k))->info().index,
                                                         face->vertex(cdt.ccw(k))->info().index))
                                   : loops.end();
            if (found != loops.end()) {
                toggle(next->info().loops, found->second);
            }
            open.push_back(next);
        }
    }
}

// Triangles in the order of their corners, the smallest first.
void collect(const Triangulation& cdt, PlanarTriangles& out) {
    std::vector<std::pair<std::array<Index, 3>, const std::vector<Index>*>> found;
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
        if (f->info().loops.empty()) {
            continue;
        }
        std::array<Index, 3> corners{f->vertex(0)->info().index, f->vertex(1)->info().index,
                                     f->vertex(2)->info().index};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        found.emplace_back(corners, &f->info().loops);
    }
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [corners, loops] : found) {
        out.triangles.push_back(corners);
        out.loops.push_back(*loops);
    }
}

}  // namespace

PlanarTriangles triangulate(const PlanarSoup& soup) {
    PlanarTriangles out;
    Triangulation cdt;
    const auto ids = insert(soup, cdt);
    out.points = soup.points;
    number_crossings(cdt, out.points);
    if (cdt.dimension() == 2) {
        find_insides(cdt, edge_loops(soup, cdt, ids));
        collect(cdt, out);
    }
    return out;
}

namespace {

using IndexedBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Index>;

}  // namespace

std::vector<std::pair<Index, Index>> touching_pairs(std::span<const Box> boxes) {
    std::vector<IndexedBox> items;
    items.reserve(boxes.size());
    for (Index i = 0; i < boxes.size(); ++i) {
        const auto& [low, high] = boxes[i];
        items.emplace_back(CGAL::Bbox_3(low.x, low.y, low.z, high.x, high.y, high.z), i);
    }
    std::vector<std::pair<Index, Index>> pairs;
    CGAL::box_self_intersection_d(items.begin(), items.end(), [&](const auto& a, const auto& b) {
        pairs.push_back(std::minmax(a.info(), b.info()));
    });
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

namespace {

using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = std::array<Index, 3>;

class CrossingTest {
  public:
    explicit CrossingTest(std::span<const Point> points) : points_(points) {}

    bool operator()(const Triangle& s, const Triangle& t) const {
        Triangle p = s, q = t;
        const int shared = shared_first(p, q);
        if (shared == 0) {
            return CGAL::do_intersect(triangle(p), triangle(q));
        }
        if (shared == 1) {  // they meet in one corner: do they meet elsewhere?
            return CGAL::do_intersect(segment(p[1], p[2]), triangle(q)) ||
                   CGAL::do_intersect(segment(q[1], q[2]), triangle(p));
        }
        if (shared == 2) {  // one edge: wrong only if folded onto each other
            return CGAL::coplanar(at(p[0]), at(p[1]), at(p[2]), at(q[2])) &&
                   CGAL::coplanar_orientation(at(p[0]), at(p[1]), at(p[2]), at(q[2])) !=
                       CGAL::NEGATIVE;
        }
        return true;
    }

    bool degenerate(const Triangle& t) const {
        return CGAL::collinear(at(t[0]), at(t[1]), at(t[2]));
    }

  private:
    // Moves the shared corners to the front, in the same order in both; returns how many there are.
    static int shared_first(Triangle& p, Triangle& q) {
        int shared = 0;
        for (int i = 0; i < 3; ++i) {
            for (int k = shared; k < 3; ++k) {
                if (p[i] == q[k]) {
                    std::swap(p[shared], p[i]);
                    std::swap(q[shared], q[k]);
                    ++shared;
                    break;
                }
            }
        }
        return shared;
    }

    Inexact::Point_3 at(Index i) const { return {points_[i].x, points_[i].y, points_[i].z}; }
    Inexact::Triangle_3 triangle(const Triangle& t) const { return {at(t[0]), at(t[1]), at(t[2])}; }
    Inexact::Segment_3 segment(Index a, Index b) const { return {at(a), at(b)}; }

    std::span<const Point> points_;
};

}  // namespace

std::vector<std::pair<Index, Index>> crossing_pairs(
    std::span<const Point> points, std::span<const std::array<Index, 3>> triangles) {
    const CrossingTest crossing(points);
    std::vector<std::pair<Index, Index>> result;
    std::vector<Box> boxes;
    for (Index i = 0; i < triangles.size(); ++i) {
        const auto &a = points[triangles[i][0]], &b = points[triangles[i][1]],
                   &c = points[triangles[i][2]];
        boxes.push_back({glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
        if (crossing.degenerate(triangles[i])) {
            result.emplace_back(i, i);
        }
    }
    for (const auto& [i, j] : touching_pairs(boxes)) {
        if (!crossing.degenerate(triangles[i]) && !crossing.degenerate(triangles[j]) &&
            crossing(triangles[i], triangles[j])) {
            result.emplace_back(i, j);
        }
    }
    return result;
}

}  // namespace tyndall::mesh::conforming
