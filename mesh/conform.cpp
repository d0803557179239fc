// Method: contacts are found on numbered points within a tolerance, so that every plane speaks of
// the
//   same points; each plane is then triangulated exactly (conform_exact.h); the result is checked
//   exactly, and conformed once more where rounding or a near miss left a crossing.
#include "mesh/conform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/conform_check.h"
#include "mesh/conform_soup.h"
#include "mesh/input_error.h"

namespace tyndall::mesh {

namespace {

using namespace conforming;

struct Labelled {
    std::array<Index, 3> corners;
    std::vector<Owner> owners;  // ascending by polygon
};

// One plane's soup, with the soup's points behind its own.
struct PlaneWork {
    std::vector<Index> points;                                       // of the soup, by local index
    std::map<Index, Index> local;                                    // and back
    std::map<std::pair<Index, Index>, std::vector<Index>> segments;  // local, with loops
    std::vector<Index> pieces;                                       // loop = position here

    Index add(Index i) {
        const auto [found, added] = local.try_emplace(i, static_cast<Index>(points.size()));
        if (added) {
            points.push_back(i);
        }
        return found->second;
    }
};

void toggle(std::vector<Index>& loops, Index loop) {
    const auto found = std::find(loops.begin(), loops.end(), loop);
    if (found != loops.end()) {
        loops.erase(found);
    } else {
        loops.insert(std::upper_bound(loops.begin(), loops.end(), loop), loop);
    }
}

std::vector<PlaneWork> gather(const Soup& soup, const std::vector<Contact>& contacts) {
    std::vector<PlaneWork> works(soup.planes.size());
    for (Index p = 0; p < soup.pieces.size(); ++p) {
        const auto& loop = soup.pieces[p].loop;
        auto& work = works[soup.pieces[p].plane];
        const auto number = static_cast<Index>(work.pieces.size());
        work.pieces.push_back(p);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const auto a = work.add(loop[k]), b = work.add(loop[(k + 1) % loop.size()]);
            toggle(work.segments[std::minmax(a, b)], number);
        }
    }
    for (const auto& contact : contacts) {
        auto& work = works[contact.plane];
        const auto a = work.add(contact.a), b = work.add(contact.b);
        if (a != b) {
            work.segments[std::minmax(a, b)];
        }
    }
    return works;
}

// Segments that pass within the tolerance of a point go through it.
void split_segments(const std::vector<glm::dvec2>& points, double tolerance, PlaneWork& work) {
    std::vector<Index> order(points.size());
    for (Index i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return points[i].x < points[j].x; });
    decltype(work.segments) result;
    for (const auto& [ends, loops] : work.segments) {
        const auto a = points[ends.first], along = points[ends.second] - a;
        std::vector<std::pair<double, Index>> stops;
        auto i =
            std::lower_bound(order.begin(), order.end(), std::min(a.x, a.x + along.x) - tolerance,
                             [&](Index k, double x) { return points[k].x < x; });
        for (; i != order.end() && points[*i].x <= std::max(a.x, a.x + along.x) + tolerance; ++i) {
            const double t = glm::dot(points[*i] - a, along) / glm::dot(along, along);
            if (*i != ends.first && *i != ends.second && t > 0.0 && t < 1.0 &&
                glm::distance(a + t * along, points[*i]) <= tolerance) {
                stops.emplace_back(t, *i);
            }
        }
        std::sort(stops.begin(), stops.end());
        Index last = ends.first;
        stops.emplace_back(1.0, ends.second);
        for (const auto& [t, next] : stops) {
            auto& to = result[std::minmax(last, next)];
            for (const auto loop : loops) {
                toggle(to, loop);
            }
            last = next;
        }
    }
    work.segments = std::move(result);
}

std::vector<Owner> owners_of(const Soup& soup, const PlaneWork& work,
                             const std::vector<Index>& loops, const Plane& plane) {
    std::map<Index, bool> owners;
    for (const auto loop : loops) {
        const auto& piece = soup.pieces[work.pieces[loop]];
        const bool reversed = glm::dot(area_vector(soup, piece.loop), plane.normal) < 0.0;
        for (const auto& owner : piece.owners) {
            owners.try_emplace(owner.polygon, owner.reversed != reversed);
        }
    }
    std::vector<Owner> result;
    for (const auto& [polygon, reversed] : owners) {
        result.push_back({polygon, reversed});
    }
    return result;
}

void triangulate_plane(Soup& soup, const Plane& plane, PlaneWork& work,
                       std::vector<Labelled>& facets) {
    if (work.pieces.size() == 1 && work.points.size() == 3) {  // most of a triangle mesh
        const auto& loop = soup.pieces[work.pieces[0]].loop;
        facets.push_back({{loop[0], loop[1], loop[2]}, soup.pieces[work.pieces[0]].owners});
        return;
    }
    PlanarSoup flat;
    for (const auto i : work.points) {
        flat.points.push_back(plane.flatten(soup.at(i)));
    }
    split_segments(flat.points, soup.tolerance, work);
    for (const auto& [ends, loops] : work.segments) {
        flat.segments.push_back({ends.first, ends.second});
        flat.segment_loops.push_back(loops);
    }
    const auto triangles = triangulate(flat);
    auto points = work.points;
    for (auto i = points.size(); i < triangles.points.size(); ++i) {
        points.push_back(soup.weld.number(plane.lift(triangles.points[i])));
    }
    for (std::size_t t = 0; t < triangles.triangles.size(); ++t) {
        const auto& [a, b, c] = triangles.triangles[t];
        const std::array<Index, 3> corners{points[a], points[b], points[c]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
            facets.push_back({corners, owners_of(soup, work, triangles.loops[t], plane)});
        }
    }
}

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
    auto works = gather(soup, find_contacts(soup, near));
    std::vector<Labelled> facets;
    for (std::size_t p = 0; p < works.size(); ++p) {
        triangulate_plane(soup, soup.planes[p], works[p], facets);
    }
    return facets;
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

ConformingComplex conform(std::span<const Polygon> polygons, const ConformOptions& options) {
    if (polygons.empty()) {
        return {};
    }
    double tolerance = options.tolerance * check_corners(polygons, options.tolerance);
    auto soup = soup_of(polygons, tolerance);
    auto facets = cut(soup);
    constexpr int rounds = 4;
    for (int round = 0;; ++round) {
        const auto corners = corners_of(facets);
        const auto crossings = crossing_pairs(soup.weld.points(), corners);
        if (crossings.empty()) {
            break;
        }
        if (round == rounds) {
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
