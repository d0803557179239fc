#include "mesh/tet_file_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numeric>

#include "mesh/input_error.h"
#include "mesh/tet_file_fit.h"
#include "mesh/trouble.h"

namespace tyndall::mesh {
namespace {

// Areas agree when they differ by less than this times themselves [-].
constexpr double area_tolerance = 1e-6;
// Barycentric coordinates nearer to 0 than this are on a face [-].
constexpr double rounding = 1e-6;

double area_of(const Point& a, const Point& b, const Point& c) {
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

bool same_surface(std::span<const Polygon> polygons, PolygonId a, PolygonId b) {
    if (a == b) return true;
    if (!a.valid() || !b.valid() || std::max(a.value, b.value) >= polygons.size()) return false;
    const Polygon &p = polygons[a.value], &q = polygons[b.value];
    return !p.name.empty() && p.name == q.name && p.opacity == q.opacity;
}

// Whether two facets with a common edge are of one plane and made of the same, front and back.
bool one_sheet(const ConformingComplex& complex, std::span<const Polygon> polygons, std::uint32_t a,
               std::uint32_t b) {
    const ConformingFacet &f = complex.facets[a], &g = complex.facets[b];
    const auto same = [&](PolygonId p, PolygonId q) { return same_surface(polygons, p, q); };
    if (!std::equal(f.polygons.begin(), f.polygons.end(), g.polygons.begin(), g.polygons.end(),
                    same))
        return false;
    if (f.opacity != g.opacity || f.front.side != g.front.side || f.back.side != g.back.side ||
        !same(f.front.polygon, g.front.polygon) || !same(f.back.polygon, g.back.polygon))
        return false;
    const auto normal = [&](const ConformingFacet& facet) {
        const auto& c = facet.corners;
        const Point& p = complex.points[c[0].value];
        return glm::normalize(
            glm::cross(complex.points[c[1].value] - p, complex.points[c[2].value] - p));
    };
    return glm::dot(normal(f), normal(g)) > 1.0 - 1e-10;  // within 1.4e-5 rad
}

class Matcher {
  public:
    Matcher(const TetFile& file, const ConformingComplex& complex,
            std::span<const Polygon> polygons, const FacetGroups& sheets, const FacetFinder& finder,
            const FittedNodes& nodes)
        : file_(file),
          complex_(complex),
          polygons_(polygons),
          sheets_(sheets),
          finder_(finder),
          nodes_(nodes),
          covered_(complex.facets.size(), 0.0) {}

    Matched match(std::span<const TetFace> faces) {
        for (const TetFace& face : faces) place(face);
        for (std::size_t s = 0; s < sheets_.size(); ++s) check(s);
        if (wrong_ > 0) refuse();
        return std::move(result_);
    }

  private:
    // The facet of one of the sheets that x lies on; of any sheet if none is given.
    FacetId on(const std::vector<std::size_t>& sheets, Point x) const {
        for (const FacetId facet : finder_.at(x))
            if (std::binary_search(sheets.begin(), sheets.end(), sheets_.group(facet)))
                return facet;
        return {};
    }

    std::vector<std::size_t> sheets_at(std::uint32_t node) const {
        std::vector<std::size_t> list;
        for (const FacetId facet : nodes_.facets[node]) list.push_back(sheets_.group(facet));
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        return list;
    }

    void place(const TetFace& face) {
        std::vector<std::size_t> common = sheets_at(face.corners[0]);
        for (int k = 1; k < 3 && !common.empty(); ++k) {
            const auto more = sheets_at(face.corners[k]);
            std::erase_if(common, [&](std::size_t s) {
                return !std::binary_search(more.begin(), more.end(), s);
            });
        }
        if (common.empty()) return;
        std::array<Point, 3> p;
        for (int k = 0; k < 3; ++k) p[k] = nodes_.points[face.corners[k]];
        const Point centroid = (p[0] + p[1] + p[2]) / 3.0;
        for (const std::size_t sheet : common) {
            const std::vector<std::size_t> only{sheet};
            const FacetId source = on(only, centroid);
            if (!source.valid()) continue;
            bool inside = true;  // corners on a sheet do not suffice where it is not convex
            for (int k = 0; k < 3; ++k)
                inside = inside && on(only, 0.5 * (p[k] + p[(k + 1) % 3])).valid();
            if (!inside) continue;
            covered_[source.value] += area_of(p[0], p[1], p[2]);
            result_.faces.push_back({face.corners, source});
            return;
        }
    }

    double facet_area(FacetId facet) const {
        const auto& c = complex_.facets[facet.value].corners;
        return area_of(complex_.points[c[0].value], complex_.points[c[1].value],
                       complex_.points[c[2].value]);
    }
    Point facet_point(FacetId facet, double towards_first) const {
        const auto& c = complex_.facets[facet.value].corners;
        const double rest = 0.5 * (1.0 - towards_first);
        return towards_first * complex_.points[c[0].value] + rest * complex_.points[c[1].value] +
               rest * complex_.points[c[2].value];
    }

    // Keeps the sheet followed worst, first of all one that runs through tets: one that is not
    // followed spoils those its outline is on.
    void note(FacetId facet, double covered, double wanted, bool through = false) {
        ++wrong_;
        const double rank = covered / wanted - (through ? 1.0 : 0.0);
        if (worst_.facet.valid() && rank >= worst_.rank) return;
        worst_ = {facet, covered, wanted, rank};
    }

    void check(std::size_t sheet) {
        double wanted = 0.0, covered = 0.0, most = -1.0;
        FacetId where;
        for (const FacetId facet : sheets_.members(sheet)) {
            const double area = facet_area(facet);
            wanted += area;
            covered += covered_[facet.value];
            if (area - covered_[facet.value] > most) {
                most = area - covered_[facet.value];
                where = facet;
            }
        }
        if (std::abs(covered - wanted) <= area_tolerance * wanted) return;
        if (covered > area_tolerance * wanted) return note(where, covered, wanted);
        double deepest = -1.0;
        for (const FacetId facet : sheets_.members(sheet))
            for (const double t : {1.0 / 3.0, 0.8, 0.05})
                if (const double depth = depth_in_tets(facet_point(facet, t)); depth > deepest) {
                    deepest = depth;
                    where = facet;
                }
        if (deepest >= -rounding) return note(where, covered, wanted, deepest > rounding);
        const auto& members = sheets_.members(sheet);
        result_.outside.insert(result_.outside.end(), members.begin(), members.end());
    }

    // The least barycentric coordinate of x in the tet of the file it is in deepest: 0 on a face,
    // below −rounding outside all of them.
    double depth_in_tets(Point x) const {
        double deepest = -1.0;
        for (const FileTet& tet : file_.tets) {
            std::array<Point, 4> p;
            for (int k = 0; k < 4; ++k) p[k] = nodes_.points[tet.corners[k]] - x;
            const Point low = glm::min(glm::min(p[0], p[1]), glm::min(p[2], p[3]));
            const Point high = glm::max(glm::max(p[0], p[1]), glm::max(p[2], p[3]));
            if (low.x > 0 || low.y > 0 || low.z > 0 || high.x < 0 || high.y < 0 || high.z < 0)
                continue;
            const auto six = [&](int a, int b, int c) {
                return glm::dot(glm::cross(p[a], p[b]), p[c]);
            };
            const double v[4]{six(1, 2, 3), six(0, 3, 2), six(0, 1, 3), six(0, 2, 1)};
            const double all = v[0] + v[1] + v[2] + v[3];
            deepest = std::max(deepest, *std::min_element(v, v + 4) / all);
        }
        return deepest;
    }

    [[noreturn]] void refuse() const {
        const Point x = facet_point(worst_.facet, 1.0 / 3.0);
        const std::vector<FacetId> named{worst_.facet};
        throw InputError(fmt::format(
            "the tetrahedra of {} do not follow surface {} near [{:.6g}, {:.6g}, {:.6g}] ({:.6g} "
            "m2 of {:.6g} m2 covered){}. Mesh it with the surface as a constraint, or take start = "
            "\"base\".",
            file_.name, names_of(named, complex_, polygons_), x.x, x.y, x.z, worst_.covered,
            worst_.wanted, wrong_ > 1 ? fmt::format(", and {} more", wrong_ - 1) : ""));
    }

    struct Wrong {
        FacetId facet;
        double covered, wanted;  // [m^2]
        double rank;             // the lowest is the worst
    };

    const TetFile& file_;
    const ConformingComplex& complex_;
    std::span<const Polygon> polygons_;
    const FacetGroups& sheets_;
    const FacetFinder& finder_;
    const FittedNodes& nodes_;
    std::vector<double> covered_;  // of each facet, by faces whose centroid it holds [m^2]
    Wrong worst_{};
    std::size_t wrong_ = 0;
    Matched result_;
};

}  // namespace

FacetGroups sheets_of(const ConformingComplex& complex, std::span<const Polygon> polygons) {
    std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t f = 0; f < complex.facets.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const auto& c = complex.facets[f].corners;
            const auto [low, high] = std::minmax(c[k].value, c[(k + 1) % 3].value);
            edges[{low, high}].push_back(f);
        }
    std::vector<std::uint32_t> root(complex.facets.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t f) {
        while (root[f] != f) f = root[f] = root[root[f]];
        return f;
    };
    for (const auto& [edge, on] : edges)
        if (on.size() == 2 && one_sheet(complex, polygons, on[0], on[1])) {
            const std::uint32_t a = find(on[0]), b = find(on[1]);
            root[std::max(a, b)] = std::min(a, b);
        }
    std::vector<std::size_t> groups(root.size());
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < root.size(); ++f) {
        const auto r = find(f);
        groups[f] = r == f ? count++ : groups[r];
    }
    return {complex, std::move(groups)};
}

Matched match_surfaces(const TetFile& file, const ConformingComplex& complex,
                       std::span<const Polygon> polygons, const FacetGroups& sheets,
                       const FacetFinder& finder, const FittedNodes& nodes,
                       std::span<const TetFace> faces) {
    return Matcher(file, complex, polygons, sheets, finder, nodes).match(faces);
}

}  // namespace tyndall::mesh
