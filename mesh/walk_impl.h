// The walk's inner loop; included by walk.h.
#pragma once

namespace tyndall::mesh {
namespace walk_detail {

// A face with its corners so ordered that cross(a,b), cross(b,c), cross(c,a) count as positive:
// the ray leaves the tet by it. `opposite` is the tet's corner that is not on it.
struct Exit {
    Projected a, b, c;
    double ab, bc, ca;
    int opposite;

    // Distance along the ray, between the corners' distances whatever the face's slant.
    double distance(double fallback) const {
        const double wa = std::max(bc, 0.0), wb = std::max(ca, 0.0), wc = std::max(ab, 0.0);
        const double sum = wa + wb + wc;
        return sum > 0.0 ? (wa * a.w + wb * b.w + wc * c.w) / sum : fallback;
    }
};

inline double worst(const Exit& exit) {
    return std::min({exit.ab, exit.bc, exit.ca});
}

// The exit of a tet whose origin lies inside, from all six edges.
inline Exit exit_from_inside(const std::array<Projected, 4>& p) {
    Exit best{};
    double best_score = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 4; ++k) {
        const auto& f = face_corners[k];
        const auto &a = p[f[0]], &b = p[f[1]], &c = p[f[2]];
        const Exit candidate{a, b, c, cross(a, b), cross(b, c), cross(c, a), k};
        if (positive(candidate.ab, a, b) && positive(candidate.bc, b, c) &&
            positive(candidate.ca, c, a))
            return candidate;
        if (const double score = worst(candidate); score > best_score) {
            best_score = score;
            best = candidate;
        }
    }
    return best;  // the origin lies a rounding error outside: the face it is nearest to being in
}

// The exit of a tet entered by face (a, b, c), with corners ia, ib, ic, and apex d.
inline Exit exit_from_face(const Exit& in, const Projected& d, int ia, int ib, int ic) {
    const double ad = cross(in.a, d), bd = cross(in.b, d), cd = cross(in.c, d);
    const bool pa = positive(ad, in.a, d), pb = positive(bd, in.b, d), pc = positive(cd, in.c, d);
    const Exit abd{in.a, in.b, d, in.ab, bd, -ad, ic};
    const Exit bcd{in.b, in.c, d, in.bc, cd, -bd, ia};
    const Exit cad{in.c, in.a, d, in.ca, ad, -cd, ib};
    if (pb && !pa) return abd;
    if (pc && !pb) return bcd;
    if (pa && !pc) return cad;
    // All three agree: only rounding at a start on the tet's rim leads here.
    const double x = worst(abd), y = worst(bcd), z = worst(cad);
    return x >= y && x >= z ? abd : y >= z ? bcd : cad;
}

}  // namespace walk_detail

template <Passes passes, class OnTet>
WalkEnd walk(const BaseMesh& mesh, const Ray& ray, WalkStart start, OnTet&& on_tet) {
    using namespace walk_detail;
    const Frame project(ray);
    TetId tet = start.tet;
    double t = 0.0;

    const auto corner = [&](int k) { return project(mesh, mesh.tets[tet.value][k]); };
    Exit exit;
    if (start.face == WalkStart::inside) {
        exit = exit_from_inside({corner(0), corner(1), corner(2), corner(3)});
    } else {
        // Seen from inside, the entry face runs the other way round.
        const auto& f = face_corners[start.face];
        const Projected a = corner(f[0]), b = corner(f[2]), c = corner(f[1]);
        const Exit in{a, b, c, cross(a, b), cross(b, c), cross(c, a), start.face};
        exit = exit_from_face(in, corner(start.face), f[0], f[2], f[1]);
    }

    const std::size_t step_cap = 64 + 4 * mesh.tets.size();
    for (std::size_t step = 0; step < step_cap; ++step) {
        const double t_out = std::max(t, exit.distance(t));
        if (t_out >= ray.length) {
            if (ray.length > t && !on_tet(tet, t, ray.length))
                return {Arrival::stopped, {}, Side::front, tet, t};
            return {Arrival::ended, {}, Side::front, tet, ray.length};
        }
        if (t_out > t && !on_tet(tet, t, t_out)) return {Arrival::stopped, {}, Side::front, tet, t};
        t = t_out;

        const FacetId facet = mesh.tet_facets[tet.value][exit.opposite];
        const TetId next = mesh.neighbours[tet.value][exit.opposite];
        if (facet.valid() && passes == Passes::interfaces &&
            mesh.facets[facet.value].opacity == Opacity::opaque) {
            const Side side = mesh.facets[facet.value].tets[0] == tet ? Side::front : Side::back;
            return {Arrival::struck, facet, side, tet, t};
        }
        if (!next.valid()) return {Arrival::left, facet, Side::front, tet, t};

        // In the next tet: find the three shared corners and the apex.
        const auto& ids = mesh.tets[next.value];
        int ia = 0, ib = 0, ic = 0, id = 0;
        for (int k = 0; k < 4; ++k) {
            const auto v = ids[k].value;
            if (v == exit.a.id)
                ia = k;
            else if (v == exit.b.id)
                ib = k;
            else if (v == exit.c.id)
                ic = k;
            else
                id = k;
        }
        tet = next;
        exit = exit_from_face(exit, project(mesh, ids[id]), ia, ib, ic);
    }
    return {Arrival::lost, {}, Side::front, tet, t};
}

}  // namespace tyndall::mesh
