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

// Whether the ray's point lies in a tet's projection, and if so the face by which it leaves: the
// one that holds the point and is seen from behind. `entry` cannot be it.
inline bool exit_of(const std::array<Projected, 4>& p, int entry, Exit& exit) {
    for (int k = 0; k < 4; ++k) {
        if (k == entry) continue;
        const auto& f = face_corners[k];
        const auto &a = p[f[0]], &b = p[f[1]], &c = p[f[2]];
        exit = {a, b, c, cross(a, b), cross(b, c), cross(c, a), k};
        if (positive(exit.ab, a, b) && positive(exit.bc, b, c) && positive(exit.ca, c, a))
            return true;
    }
    return false;
}

// The exit of a tet entered by face (a, b, c), with corners ia, ib, ic, and apex d. The face holds
// the ray's point, so the tests against d cannot all agree and one of the other faces holds it.
inline Exit exit_from_face(const Exit& in, const Projected& d, int ia, int ib, int ic) {
    const double ad = cross(in.a, d), bd = cross(in.b, d), cd = cross(in.c, d);
    const bool pa = positive(ad, in.a, d), pb = positive(bd, in.b, d), pc = positive(cd, in.c, d);
    if (pb && !pa) return {in.a, in.b, d, in.ab, bd, -ad, ic};
    if (pc && !pb) return {in.b, in.c, d, in.bc, cd, -bd, ia};
    return {in.c, in.a, d, in.ca, ad, -cd, ib};
}

// The first exit. Starts on a tet's rim move towards its centroid until the projection holds them.
inline Exit first_exit(const BaseMesh& mesh, const Ray& ray, WalkStart start, Frame& project) {
    const auto& ids = mesh.tets[start.tet.value];
    Exit exit{};
    int entry = start.face;
    for (const double step : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0}) {
        if (step > 0.0) {
            Point centroid(0.0);
            for (const VertexId id : ids) centroid += 0.25 * mesh.points[id.value];
            project.origin = ray.origin + step * (centroid - ray.origin);
        }
        if (exit_of({project(mesh, ids[0]), project(mesh, ids[1]), project(mesh, ids[2]),
                     project(mesh, ids[3])},
                    entry, exit))
            break;
        entry = WalkStart::inside;
    }
    return exit;
}

}  // namespace walk_detail

namespace walk_detail {

template <Passes passes, class OnTet>
WalkEnd walk_tets(const BaseMesh& mesh, const Ray& ray, WalkStart start, OnTet&& on_tet) {
    Frame project(ray);
    TetId tet = start.tet;
    double t = 0.0;
    Exit exit = first_exit(mesh, ray, start, project);

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

}  // namespace walk_detail

// A body ends the walk as the ray's length would.
template <Passes passes, class OnTet>
WalkEnd walk(const BaseMesh& mesh, const Ray& ray, WalkStart start, OnTet&& on_tet) {
    if (mesh.bodies.empty() || passes == Passes::everything)
        return walk_detail::walk_tets<passes>(mesh, ray, start, on_tet);
    const BodyHit hit = first_body(mesh, ray);
    if (!hit.facet.valid()) return walk_detail::walk_tets<passes>(mesh, ray, start, on_tet);
    WalkEnd end = walk_detail::walk_tets<passes>(mesh, {ray.origin, ray.direction, hit.distance},
                                                 start, on_tet);
    if (end.arrival == Arrival::ended)
        end = {Arrival::struck, hit.facet, hit.side, end.tet, hit.distance};
    return end;
}

}  // namespace tyndall::mesh
