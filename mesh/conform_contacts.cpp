// Where the pieces of a soup touch and cross.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "mesh/conform_soup.h"

namespace tyndall::mesh::conforming {

namespace {

using Edge = std::pair<Index, Index>;  // the smaller index first

Edge edge_of(const std::vector<Index>& loop, std::size_t i) {
    return std::minmax(loop[i], loop[(i + 1) % loop.size()]);
}

// Points to be inserted into edges. Ordered, so that nothing depends on a hash.
using Splits = std::map<Edge, std::vector<Index>>;

// Parameter of the point of the edge nearest to x, and its distance [m].
struct Foot {
    double t;
    double distance;
};

Foot foot(const Soup& soup, Edge edge, Point x) {
    const auto& a = soup.at(edge.first);
    const auto along = soup.at(edge.second) - a;
    const double t = std::clamp(glm::dot(x - a, along) / glm::dot(along, along), 0.0, 1.0);
    return {t, glm::distance(a + t * along, x)};
}

bool contains(const std::vector<Index>& loop, Index i) {
    return std::find(loop.begin(), loop.end(), i) != loop.end();
}

// Every loop with the points of `splits` between the ends of its edges, in order along the edge.
void apply(Soup& soup, Splits& splits) {
    for (auto& [edge, points] : splits) {
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
        std::stable_sort(points.begin(), points.end(), [&, edge = edge](Index i, Index j) {
            return foot(soup, edge, soup.at(i)).t < foot(soup, edge, soup.at(j)).t;
        });
    }
    for (auto& piece : soup.pieces) {
        std::vector<Index> loop;
        for (std::size_t i = 0; i < piece.loop.size(); ++i) {
            loop.push_back(piece.loop[i]);
            const auto edge = edge_of(piece.loop, i);
            const auto found = splits.find(edge);
            if (found == splits.end()) {
                continue;
            }
            const auto& points = found->second;
            if (edge.first == piece.loop[i]) {
                loop.insert(loop.end(), points.begin(), points.end());
            } else {
                loop.insert(loop.end(), points.rbegin(), points.rend());
            }
        }
        piece.loop = std::move(loop);
    }
}

// The corners of p within the tolerance of an edge of q split that edge.
void find_points_on_edges(const Soup& soup, const Piece& p, const Piece& q, Splits& splits) {
    for (const auto i : p.loop) {
        // A loop stays within a few tolerances of its plane, and so does what is near its edges.
        if (std::abs(soup.plane_of(q).above(soup.at(i))) > 8.0 * soup.tolerance ||
            contains(q.loop, i)) {
            continue;
        }
        for (std::size_t k = 0; k < q.loop.size(); ++k) {
            const auto edge = edge_of(q.loop, k);
            if (foot(soup, edge, soup.at(i)).distance <= soup.tolerance) {
                splits[edge].push_back(i);
            }
        }
    }
}

}  // namespace

bool holds(const Soup& soup, const Piece& piece, Point x) {
    const auto& plane = soup.plane_of(piece);
    const auto flat = plane.flatten(x);
    bool inside = false;
    for (std::size_t i = 0; i < piece.loop.size(); ++i) {
        const auto edge = edge_of(piece.loop, i);
        if (foot(soup, edge, x).distance <= soup.tolerance) {
            return true;
        }
        const auto a = plane.flatten(soup.at(edge.first)), b = plane.flatten(soup.at(edge.second));
        if ((a.y > flat.y) != (b.y > flat.y) &&
            flat.x < a.x + (flat.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            inside = !inside;
        }
    }
    return inside;
}

void split_edges_at_points(Soup& soup, const Pairs& near) {
    Splits splits;
    for (const auto& [i, j] : near) {
        find_points_on_edges(soup, soup.pieces[i], soup.pieces[j], splits);
        find_points_on_edges(soup, soup.pieces[j], soup.pieces[i], splits);
    }
    apply(soup, splits);
}

namespace {

// Where two edges come within the tolerance of each other, away from their ends.
std::optional<Point> crossing_of_edges(const Soup& soup, Edge e, Edge f) {
    const auto &a = soup.at(e.first), &c = soup.at(f.first);
    const auto u = soup.at(e.second) - a, v = soup.at(f.second) - c, w = c - a;
    const auto n = glm::cross(u, v);
    const double square = glm::dot(n, n);
    if (square <= 1e-20 * glm::dot(u, u) * glm::dot(v, v)) {
        return {};  // parallel: their ends have been put on each other already
    }
    const double s = glm::dot(glm::cross(w, v), n) / square;
    const double t = glm::dot(glm::cross(w, u), n) / square;
    if (s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0) {
        return {};
    }
    const auto x = a + s * u, y = c + t * v;
    if (glm::distance(x, y) > soup.tolerance) {
        return {};
    }
    return 0.5 * (x + y);
}

// Where an edge passes through the inside of a piece, its ends clearly on either side.
std::optional<Point> crossing_of_piece(const Soup& soup, Edge e, const Piece& piece) {
    const auto& plane = soup.plane_of(piece);
    const auto &a = soup.at(e.first), &b = soup.at(e.second);
    const double from = plane.above(a), to = plane.above(b);
    if (std::min(std::abs(from), std::abs(to)) <= soup.tolerance || (from > 0.0) == (to > 0.0)) {
        return {};
    }
    const auto x = a + from / (from - to) * (b - a);
    if (!holds(soup, piece, x)) {
        return {};
    }
    return x;
}

class Crossings {
  public:
    explicit Crossings(Soup& soup) : soup_(soup) {}

    void find(const Piece& p, const Piece& q) {
        for (std::size_t i = 0; i < p.loop.size(); ++i) {
            const auto e = edge_of(p.loop, i);
            for (std::size_t k = 0; k < q.loop.size(); ++k) {
                cross(e, edge_of(q.loop, k));
            }
            if (p.plane != q.plane) {
                pierce(e, q);
            }
        }
        for (std::size_t k = 0; k < q.loop.size() && p.plane != q.plane; ++k) {
            pierce(edge_of(q.loop, k), p);
        }
    }

    Splits splits;

  private:
    void cross(Edge e, Edge f) {
        if (e.first == f.first || e.first == f.second || e.second == f.first ||
            e.second == f.second) {
            return;
        }
        if (const auto x = crossing_of_edges(soup_, std::min(e, f), std::max(e, f))) {
            const auto i = soup_.weld.number(*x);
            add(e, i);
            add(f, i);
        }
    }

    void pierce(Edge e, const Piece& piece) {
        if (const auto x = crossing_of_piece(soup_, e, piece)) {
            add(e, soup_.weld.number(*x));
        }
    }

    void add(Edge e, Index i) {
        if (i != e.first && i != e.second) {
            splits[e].push_back(i);
        }
    }

    Soup& soup_;
};

}  // namespace

void split_edges_at_crossings(Soup& soup, const Pairs& near) {
    Crossings crossings(soup);
    for (const auto& [i, j] : near) {
        crossings.find(soup.pieces[i], soup.pieces[j]);
    }
    apply(soup, crossings.splits);
}

namespace {

// Points of both loops within the tolerance of both planes, along the line that the planes share.
std::vector<Index> points_on_both(const Soup& soup, const Piece& p, const Piece& q) {
    const auto &P = soup.plane_of(p), &Q = soup.plane_of(q);
    std::vector<Index> points;
    for (const auto* loop : {&p.loop, &q.loop}) {
        for (const auto i : *loop) {
            if (std::abs(P.above(soup.at(i))) <= soup.tolerance &&
                std::abs(Q.above(soup.at(i))) <= soup.tolerance) {
                points.push_back(i);
            }
        }
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const auto line = glm::cross(P.normal, Q.normal);
    std::stable_sort(points.begin(), points.end(), [&](Index i, Index j) {
        return glm::dot(line, soup.at(i)) < glm::dot(line, soup.at(j));
    });
    return points;
}

// Both loops have at most the given corners in common: an edge, a corner; and no other point near.
bool only_share(const Piece& p, const Piece& q, const std::vector<Index>& points) {
    return std::all_of(points.begin(), points.end(),
                       [&](Index i) { return contains(p.loop, i) && contains(q.loop, i); });
}

void find_contacts(const Soup& soup, const Piece& p, const Piece& q,
                   std::vector<Contact>& contacts) {
    const auto points = points_on_both(soup, p, q);
    if (points.empty() || (points.size() == 1 && only_share(p, q, points))) {
        return;
    }
    const auto add = [&](Index a, Index b) {
        contacts.push_back({p.plane, a, b});
        contacts.push_back({q.plane, a, b});
    };
    for (const auto i : points) {
        if (holds(soup, p, soup.at(i)) && holds(soup, q, soup.at(i))) {
            add(i, i);
        }
    }
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto middle = 0.5 * (soup.at(points[k]) + soup.at(points[k + 1]));
        if (holds(soup, p, middle) && holds(soup, q, middle)) {
            add(points[k], points[k + 1]);
        }
    }
}

}  // namespace

std::vector<Contact> find_contacts(const Soup& soup, const Pairs& near) {
    std::vector<Contact> contacts;
    for (const auto& [i, j] : near) {
        if (soup.pieces[i].plane != soup.pieces[j].plane) {
            find_contacts(soup, soup.pieces[i], soup.pieces[j], contacts);
        }
    }
    return contacts;
}

}  // namespace tyndall::mesh::conforming
