#include "mesh/body.h"

#include <algorithm>
#include <map>

namespace tyndall::mesh {
namespace {

// Of the hull's diagonal: above what rounding leaves between a facet and a point on it.
constexpr double gap = 1e-9;
// Of a body's radius: how far beside it what lies inside is taken to be.
constexpr double step_off = 1e-5;

// Every edge has two triangles that run along it in opposite ways, and the volume is positive.
bool turns_outward(std::span<const Point> points,
                   std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0.0;
    for (const auto& t : triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto a = t[k], b = t[(k + 1) % 3];
            edges[std::minmax(a, b)] += a < b ? 1 : 16;
        }
        volume += glm::dot(points[t[0]] - points[0],
                           glm::cross(points[t[1]] - points[0], points[t[2]] - points[0]));
    }
    return volume > 0.0 && std::all_of(edges.begin(), edges.end(),
                                       [](const auto& edge) { return edge.second == 17; });
}

// A projection without the distance along the ray.
walk_detail::Projected across(const BaseMesh& mesh, const walk_detail::Frame& frame, VertexId id) {
    const auto p = mesh.points[id.value] - frame.origin;
    return {glm::dot(p, frame.u), glm::dot(p, frame.v), 0.0, id.value};
}

// Of one triangle; hits nearer than `hit` only, of two at one distance the facet made first.
void meet(const BaseMesh& mesh, const walk_detail::Frame& project, FacetId facet, double gap,
          double length, BodyHit& hit) {
    using namespace walk_detail;
    // Most are missed: no more is computed than tells so.
    const auto& corners = mesh.facets[facet.value].corners;
    Projected a = across(mesh, project, corners[0]), b = across(mesh, project, corners[1]);
    const double ab = cross(a, b);
    const bool along = positive(ab, a, b);
    Projected c = across(mesh, project, corners[2]);
    const double bc = cross(b, c);
    if (positive(bc, b, c) != along) return;
    const double ca = cross(c, a);
    if (positive(ca, c, a) != along) return;
    for (Projected* p : {&a, &b, &c})
        p->w = glm::dot(mesh.points[p->id] - project.origin, project.w);
    const double sum = ab + bc + ca;
    if (sum == 0.0) return;  // seen edge-on: its neighbours are met
    const double distance = (bc * a.w + ca * b.w + ab * c.w) / sum;
    if (distance <= gap || distance > length) return;
    if (distance < hit.distance || (distance == hit.distance && facet < hit.facet))
        hit = {facet, along ? Side::back : Side::front, distance};
}

// Of one body.
void meet(const BaseMesh& mesh, const Body& body, const Ray& ray, BodyHit& hit) {
    const walk_detail::Frame project(ray);
    for (std::uint32_t n = 0; n < body.bounds.size();) {
        const Body::Bound& bound = body.bounds[n];
        if (!meets_sphere(bound, ray)) {
            n = bound.next;
            continue;
        }
        for (std::uint32_t t = bound.triangle; t < bound.end; ++t)
            meet(mesh, project, body.triangles[t], body.gap, ray.length, hit);
        ++n;
    }
}

// A tree of spheres about a body's triangles, halved across the longest side of their centroids'
// box.
class Bounds {
  public:
    Bounds(const BaseMesh& mesh, Body& body) : mesh_(mesh), body_(body) {
        for (std::uint32_t f = body.first.value; f < body.end.value; ++f)
            body.triangles.push_back(FacetId(f));
        add(0, static_cast<std::uint32_t>(body.triangles.size()));
    }

  private:
    static constexpr std::uint32_t most_triangles = 4;
    static constexpr double rounding = 1e-9;

    Point corner(FacetId facet, int k) const {
        return mesh_.points[mesh_.facets[facet.value].corners[k].value];
    }
    Point sum(FacetId facet) const {
        return corner(facet, 0) + corner(facet, 1) + corner(facet, 2);
    }

    void add(std::uint32_t begin, std::uint32_t end) {
        const std::size_t own = body_.bounds.size();
        body_.bounds.push_back(around(begin, end));
        if (end - begin > most_triangles) {
            const std::uint32_t half = begin + (end - begin) / 2;
            halve(begin, half, end);
            add(begin, half);
            add(half, end);
        } else {
            body_.bounds[own].triangle = begin;
            body_.bounds[own].end = end;
        }
        body_.bounds[own].next = static_cast<std::uint32_t>(body_.bounds.size());
    }

    Body::Bound around(std::uint32_t begin, std::uint32_t end) const {
        Point low = corner(body_.triangles[begin], 0), high = low;
        const auto each_corner = [&](auto&& visit) {
            for (std::uint32_t t = begin; t < end; ++t)
                for (int k = 0; k < 3; ++k) visit(corner(body_.triangles[t], k));
        };
        each_corner([&](Point p) { low = glm::min(low, p), high = glm::max(high, p); });
        Body::Bound bound;
        bound.centre = 0.5 * (low + high);
        each_corner([&](Point p) {
            bound.radius = std::max(bound.radius, glm::distance(p, bound.centre));
        });
        bound.radius += rounding * body_.radius;
        return bound;
    }

    void halve(std::uint32_t begin, std::uint32_t half, std::uint32_t end) {
        Point low = sum(body_.triangles[begin]), high = low;
        for (std::uint32_t t = begin; t < end; ++t)
            low = glm::min(low, sum(body_.triangles[t])),
            high = glm::max(high, sum(body_.triangles[t]));
        const Point size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto at = [&](std::uint32_t t) { return body_.triangles.begin() + t; };
        std::nth_element(at(begin), at(half), at(end), [&](FacetId a, FacetId b) {
            return std::pair(sum(a)[axis], a) < std::pair(sum(b)[axis], b);
        });
    }

    const BaseMesh& mesh_;
    Body& body_;
};

// The nearest point of a triangle. Source: Ericson (2005), Real-Time Collision Detection, 5.1.5.
Point nearest_on(Point p, Point a, Point b, Point c) {
    const auto ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const auto bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
    const auto cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

}  // namespace

Body body_of(const BaseMesh& mesh, FacetId first, FacetId end) {
    std::vector<Point> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::map<VertexId, std::uint32_t> numbers;
    Body body{first, end};
    for (std::uint32_t f = first.value; f < end.value; ++f) {
        auto& triangle = triangles.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const VertexId corner = mesh.facets[f].corners[k];
            const auto [entry, made] =
                numbers.try_emplace(corner, static_cast<std::uint32_t>(points.size()));
            if (made) points.push_back(mesh.points[corner.value]);
            triangle[k] = entry->second;
        }
    }
    Point low = points[0], high = points[0];
    for (const Point& p : points) low = glm::min(low, p), high = glm::max(high, p);
    body.centre = 0.5 * (low + high);
    for (const Point& p : points)
        body.radius = std::max(body.radius, (1.0 + 1e-9) * glm::distance(p, body.centre));
    body.closed = turns_outward(points, triangles);
    body.gap = gap * glm::distance(mesh.hull_min, mesh.hull_max);
    Bounds(mesh, body);
    return body;
}

void add_body(BaseMesh& mesh, std::span<const Point> points,
              std::span<const std::array<std::uint32_t, 3>> triangles) {
    const FacetId first(mesh.facets.size());
    const std::size_t before = mesh.points.size();
    mesh.points.insert(mesh.points.end(), points.begin(), points.end());
    for (const auto& t : triangles) {
        BaseFacet facet;
        for (int k = 0; k < 3; ++k) facet.corners[k] = VertexId(before + t[k]);
        const TetId tet =
            locate(mesh, (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0,
                   mesh.facets.size() > first.value ? mesh.facets.back().tets[0] : TetId(0));
        facet.tets = {tet, tet};
        mesh.facets.push_back(facet);
    }
    mesh.bodies.push_back(body_of(mesh, first, FacetId(mesh.facets.size())));
    if (!mesh.bodies.back().closed) return;
    for (std::size_t f = first.value; f < mesh.facets.size(); ++f) mesh.facets[f].tets[1] = TetId();
}

bool on_body(const BaseMesh& mesh, FacetId facet) {
    return !mesh.bodies.empty() && facet.value >= mesh.bodies.front().first.value;
}

BodyHit first_body(const BaseMesh& mesh, const Ray& ray) {
    BodyHit hit;
    for (const Body& body : mesh.bodies)
        if (meets_sphere(body, ray)) meet(mesh, body, ray, hit);
    return hit;
}

const Body* body_around(const BaseMesh& mesh, Point x) {
    for (const Body& body : mesh.bodies) {
        if (!body.closed || glm::distance(x, body.centre) > body.radius) continue;
        BodyHit hit;  // an odd direction, which few edges lie in
        meet(mesh, body, {x, glm::normalize(Direction(0.3717, 0.6143, 0.7211))}, hit);
        if (hit.facet.valid() && hit.side == Side::back) return &body;
    }
    return nullptr;
}

Point nearest_outside(const BaseMesh& mesh, const Body& body, Point x) {
    Point best = x;
    FacetId on;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = body.first.value; f < body.end.value; ++f) {
        const auto& c = mesh.facets[f].corners;
        const Point p = nearest_on(x, mesh.points[c[0].value], mesh.points[c[1].value],
                                   mesh.points[c[2].value]);
        if (const double d = glm::distance(p, x); d < least) {
            least = d;
            best = p;
            on = FacetId(f);
        }
    }
    return best + step_off * body.radius * normal(mesh, on);
}

TetId tet_before(const BaseMesh& mesh, std::uint32_t facet_side, Point x) {
    const FacetId facet(facet_side / 2);
    const TetId tet = mesh.facets[facet.value].tets[facet_side % 2];
    if (!on_body(mesh, facet)) return tet;
    const TetId here = locate(mesh, x, tet);
    return here.valid() ? here : tet;
}

WalkStart start_before(const BaseMesh& mesh, std::uint32_t facet_side, Point x) {
    const FacetId facet(facet_side / 2);
    if (on_body(mesh, facet)) return {tet_before(mesh, facet_side, x)};
    return start_on(mesh, facet, facet_side % 2 ? Side::back : Side::front);
}

}  // namespace tyndall::mesh
