// Method: contacts are found on numbered points within a tolerance, so that every plane speaks of
//   the same points; each plane is then triangulated exactly (conform_exact.h); the result is
//   checked exactly, and conformed once more where rounding or a near miss left a crossing.
#include "mesh/conform.h"

#include <algorithm>
#include <cmath>

#include "mesh/conform_check.h"
#include "mesh/conform_soup.h"
#include "mesh/input_error.h"

namespace tyndall::mesh::conforming {

namespace {

// The first opaque polygon owns both sides; a later one takes the side that its front looks to.
void find_sides(std::span<const Polygon> polygons, const std::vector<Owner>& owners,
                ConformingFacet& facet) {
    facet.opacity = Opacity::interface;
    for (const auto& owner : owners) {
        const PolygonId id(owner.polygon);
        facet.polygons.push_back(id);
        if (polygons[owner.polygon].opacity != Opacity::opaque) {
            continue;
        }
        if (facet.opacity == Opacity::interface) {
            facet.opacity = Opacity::opaque;
            facet.front = {id, owner.reversed ? Side::back : Side::front};
            facet.back = {id, owner.reversed ? Side::front : Side::back};
        } else {
            (owner.reversed ? facet.back : facet.front) = {id, Side::front};
        }
    }
}

std::vector<Labelled> cut(Soup& soup) {
    find_planes(soup, near_pieces(soup));
    snap_to_planes(soup, near_pieces(soup));
    const auto near = near_pieces(soup);
    split_edges_at_points(soup, near);
    split_edges_at_crossings(soup, near);
    split_edges_at_points(soup, near);
    return triangulate_planes(soup, find_contacts(soup, near));
}

// Turns each facet the way its first polygon looks.
ConformingComplex finish(const Soup& soup, std::span<const Polygon> polygons,
                         const std::vector<Labelled>& facets) {
    ConformingComplex result;
    std::vector<VertexId> numbers(soup.weld.points().size());
    for (const auto& [corners, labels] : facets) {
        auto owners = labels;
        ConformingFacet facet;
        for (int k = 0; k < 3; ++k) {
            auto& number = numbers[corners[k]];
            if (!number.valid()) {
                number = VertexId(result.points.size());
                result.points.push_back(soup.at(corners[k]));
            }
            facet.corners[k] = number;
        }
        if (owners.front().reversed) {
            std::swap(facet.corners[1], facet.corners[2]);
            for (auto& owner : owners) {
                owner.reversed = !owner.reversed;
            }
        }
        find_sides(polygons, owners, facet);
        result.facets.push_back(std::move(facet));
    }
    return result;
}

std::vector<std::array<Index, 3>> corners_of(const std::vector<Labelled>& facets) {
    std::vector<std::array<Index, 3>> result;
    for (const auto& facet : facets) {
        result.push_back(facet.corners);
    }
    return result;
}

bool is_flat(const Soup& soup, const std::vector<Index>& loop) {
    const auto plane = fit_plane(soup, loop);
    return std::all_of(loop.begin(), loop.end(), [&](Index i) {
        return std::abs(plane->above(soup.at(i))) <= soup.tolerance;
    });
}

// A polygon whose corners are a little off its plane goes on as triangles.
void add_triangles(Soup& soup, const Piece& piece) {
    const auto plane = fit_plane(soup, piece.loop);
    PlanarSoup flat;
    const auto n = static_cast<Index>(piece.loop.size());
    for (Index k = 0; k < n; ++k) {
        flat.points.push_back(plane->flatten(soup.at(piece.loop[k])));
        flat.segments.push_back({k, (k + 1) % n});
        flat.segment_loops.push_back({0});
    }
    for (const auto& [a, b, c] : triangulate(flat).triangles) {
        if (std::max({a, b, c}) < n) {
            soup.pieces.push_back({{piece.loop[a], piece.loop[b], piece.loop[c]}, piece.owners, 0});
        }
    }
}

Soup soup_of(std::span<const Polygon> polygons, double tolerance) {
    Soup soup{tolerance, PointWeld(tolerance), {}, {}};
    for (Index p = 0; p < polygons.size(); ++p) {
        Piece piece;
        for (const auto& corner : polygons[p].corners) {
            piece.loop.push_back(soup.weld.number(corner));
        }
        clean_loop(piece.loop);
        piece.owners.push_back({p, false});
        check_loop(soup, piece.loop, polygons[p], p);
        if (is_flat(soup, piece.loop)) {
            soup.pieces.push_back(std::move(piece));
        } else {
            add_triangles(soup, piece);
        }
    }
    return soup;
}

// The facets become the pieces of the next round; slivers that have no plane go.
Soup soup_of(const Soup& last, const std::vector<Labelled>& facets, double tolerance) {
    Soup soup{tolerance, PointWeld(tolerance), {}, {}};
    for (const auto& facet : facets) {
        Piece piece;
        for (const auto i : facet.corners) {
            piece.loop.push_back(soup.weld.number(last.at(i)));
        }
        clean_loop(piece.loop);
        piece.owners = facet.owners;
        if (fit_plane(soup, piece.loop)) {
            soup.pieces.push_back(std::move(piece));
        }
    }
    return soup;
}

}  // namespace

}  // namespace tyndall::mesh::conforming

namespace tyndall::mesh {

ConformingComplex conform(std::span<const Polygon> polygons, const ConformOptions& options) {
    if (polygons.empty()) {
        return {};
    }
    using namespace conforming;
    double tolerance = options.tolerance * check_corners(polygons, options.tolerance);
    auto soup = soup_of(polygons, tolerance);
    auto facets = cut(soup);
    const auto first = facets.size();
    constexpr int rounds = 4;
    for (int round = 0;; ++round) {
        const auto corners = corners_of(facets);
        const auto crossings = crossing_pairs(soup.weld.points(), corners);
        if (crossings.empty()) {
            break;
        }
        // Nearly parallel sheets can shatter each other: no use in going on.
        const bool shattered = facets.size() > 1000 + 4 * first;
        if (round == rounds || shattered) {
            const auto [i, j] = crossings.front();
            throw_crossing(polygons, facets[i].owners, facets[j].owners,
                           soup.at(facets[i].corners[0]));
        }
        tolerance *= 4.0;
        soup = soup_of(soup, facets, tolerance);
        facets = cut(soup);
    }
    auto complex = finish(soup, polygons, facets);
    check_areas(complex, polygons, tolerance);
    return complex;
}

}  // namespace tyndall::mesh
