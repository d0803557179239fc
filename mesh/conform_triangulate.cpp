// Plane by plane: segments cut at each other and at points, then triangulated.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/conform_soup.h"

namespace tyndall::mesh::conforming {

namespace {

using Ends = std::pair<Index, Index>;                 // the smaller first
using Segments = std::map<Ends, std::vector<Index>>;  // with the loops that pass them
using Stops = std::vector<std::pair<double, Index>>;  // points on a segment by their parameter

void toggle(std::vector<Index>& loops, Index loop) {
    const auto found = std::find(loops.begin(), loops.end(), loop);
    if (found != loops.end()) {
        loops.erase(found);
    } else {
        loops.insert(std::upper_bound(loops.begin(), loops.end(), loop), loop);
    }
}

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// What lies in one plane. Points have numbers of their own, 0 to n.
class PlaneWork {
  public:
    PlaneWork(Soup& soup, const Plane& plane) : soup_(soup), plane_(plane) {}

    void add_piece(Index piece) {
        const auto& loop = soup_.pieces[piece].loop;
        const auto number = static_cast<Index>(pieces_.size());
        pieces_.push_back(piece);
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const auto a = add_point(loop[k]), b = add_point(loop[(k + 1) % loop.size()]);
            toggle(segments_[std::minmax(a, b)], number);
        }
    }

    void add_contact(const Contact& contact) {
        const auto a = add_point(contact.a), b = add_point(contact.b);
        if (a != b) {
            segments_[std::minmax(a, b)];
        }
    }

    void triangulate(std::vector<Labelled>& facets) {
        if (pieces_.size() == 1 && points_.size() == 3) {  // most of a triangle mesh
            const auto& piece = soup_.pieces[pieces_[0]];
            facets.push_back({{piece.loop[0], piece.loop[1], piece.loop[2]}, piece.owners});
            return;
        }
        cut();
        PlanarSoup flat{flat_, {}, {}};
        for (const auto& [ends, loops] : segments_) {
            flat.segments.push_back({ends.first, ends.second});
            flat.segment_loops.push_back(loops);
        }
        const auto triangles = conforming::triangulate(flat);
        for (auto i = flat_.size(); i < triangles.points.size(); ++i) {
            points_.push_back(soup_.weld.number(plane_.lift(triangles.points[i])));
        }
        for (std::size_t t = 0; t < triangles.triangles.size(); ++t) {
            const auto& [a, b, c] = triangles.triangles[t];
            const std::array<Index, 3> corners{points_[a], points_[b], points_[c]};
            if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) {
                facets.push_back({corners, owners_of(triangles.loops[t])});
            }
        }
    }

  private:
    Index add_point(Index i) {
        const auto [found, added] = local_.try_emplace(i, static_cast<Index>(points_.size()));
        if (added) {
            points_.push_back(i);
            flat_.push_back(plane_.flatten(soup_.at(i)));
        }
        return found->second;
    }

    // Crossings are welded before the exact triangulation sees them: three lines through one point
    // make one point and not three, and crossings of crossings do not pile up digits. A cut bends a
    // segment by up to the tolerance, which may make new crossings: few rounds are enough, what
    // they leave is cut exactly.
    void cut() {
        split_at_points();
        constexpr int rounds = 3;
        for (int round = 0; round < rounds && split_at_crossings(); ++round) {
            split_at_points();
        }
    }

    void split(std::map<Ends, Stops>& stops) {
        Segments result;
        for (const auto& [ends, loops] : segments_) {
            Index last = ends.first;
            auto& on_this = stops[ends];
            std::sort(on_this.begin(), on_this.end());
            on_this.emplace_back(1.0, ends.second);
            for (const auto& [t, next] : on_this) {
                if (next == last) {
                    continue;
                }
                auto& to = result[std::minmax(last, next)];
                for (const auto loop : loops) {
                    toggle(to, loop);
                }
                last = next;
            }
        }
        segments_ = std::move(result);
    }

    // Segments that pass within the tolerance of a point go through it.
    void split_at_points() {
        std::vector<Index> order(flat_.size());
        for (Index i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](Index i, Index j) { return flat_[i].x < flat_[j].x; });
        std::map<Ends, Stops> stops;
        for (const auto& segment : segments_) {
            const auto& ends = segment.first;
            const auto a = flat_[ends.first], along = flat_[ends.second] - a;
            const double low = std::min(a.x, a.x + along.x) - soup_.tolerance;
            const double high = std::max(a.x, a.x + along.x) + soup_.tolerance;
            auto i = std::lower_bound(order.begin(), order.end(), low,
                                      [&](Index k, double x) { return flat_[k].x < x; });
            for (; i != order.end() && flat_[*i].x <= high; ++i) {
                const double t = glm::dot(flat_[*i] - a, along) / glm::dot(along, along);
                if (*i != ends.first && *i != ends.second && t > 0.0 && t < 1.0 &&
                    glm::distance(a + t * along, flat_[*i]) <= soup_.tolerance) {
                    stops[ends].emplace_back(t, *i);
                }
            }
        }
        split(stops);
    }

    // Whether there was any crossing.
    bool split_at_crossings() {
        std::vector<std::pair<double, Ends>> by_low;  // by their least x
        for (const auto& segment : segments_) {
            const auto& ends = segment.first;
            by_low.emplace_back(std::min(flat_[ends.first].x, flat_[ends.second].x), ends);
        }
        std::sort(by_low.begin(), by_low.end());
        std::map<Ends, Stops> stops;
        for (std::size_t i = 0; i < by_low.size(); ++i) {
            const auto& e = by_low[i].second;
            const double high = std::max(flat_[e.first].x, flat_[e.second].x);
            for (std::size_t k = i + 1; k < by_low.size() && by_low[k].first <= high; ++k) {
                cross_segments(std::min(e, by_low[k].second), std::max(e, by_low[k].second), stops);
            }
        }
        const bool any = !stops.empty();
        split(stops);
        return any;
    }

    void cross_segments(Ends e, Ends f, std::map<Ends, Stops>& stops) {
        if (e.first == f.first || e.first == f.second || e.second == f.first ||
            e.second == f.second) {
            return;
        }
        const auto a = flat_[e.first], c = flat_[f.first];
        const auto u = flat_[e.second] - a, v = flat_[f.second] - c;
        const double area = cross(u, v);
        if (area == 0.0) {
            return;
        }
        const double s = cross(c - a, v) / area, t = cross(c - a, u) / area;
        if (!(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)) {
            return;
        }
        const auto x = add_point(soup_.weld.number(plane_.lift(a + s * u)));
        if (x != e.first && x != e.second) {
            stops[e].emplace_back(s, x);
        }
        if (x != f.first && x != f.second) {
            stops[f].emplace_back(t, x);
        }
    }

    std::vector<Owner> owners_of(const std::vector<Index>& loops) const {
        std::map<Index, bool> owners;
        for (const auto loop : loops) {
            const auto& piece = soup_.pieces[pieces_[loop]];
            const bool reversed = glm::dot(area_vector(soup_, piece.loop), plane_.normal) < 0.0;
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

    Soup& soup_;
    const Plane& plane_;
    std::vector<Index> points_;     // of the soup, by own number
    std::vector<glm::dvec2> flat_;  // in the plane, by own number
    std::map<Index, Index> local_;  // own number, by the soup's
    Segments segments_;
    std::vector<Index> pieces_;  // by loop
};

}  // namespace

std::vector<Labelled> triangulate_planes(Soup& soup, const std::vector<Contact>& contacts) {
    std::vector<PlaneWork> works;
    works.reserve(soup.planes.size());
    for (const auto& plane : soup.planes) {
        works.emplace_back(soup, plane);
    }
    for (Index p = 0; p < soup.pieces.size(); ++p) {
        works[soup.pieces[p].plane].add_piece(p);
    }
    for (const auto& contact : contacts) {
        works[contact.plane].add_contact(contact);
    }
    std::vector<Labelled> facets;
    for (auto& work : works) {
        work.triangulate(facets);
    }
    return facets;
}

}  // namespace tyndall::mesh::conforming
