#include "mesh/surface_mesh.h"

#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <map>

// What has members of these types is seen elsewhere: a name of their own, not an anonymous
// namespace.
namespace tyndall::mesh::manifold {

struct Traits : OpenMesh::DefaultTraitsDouble {
    VertexTraits {
        std::uint32_t id = 0;  // VertexId in the forest
    };
    FaceTraits {
        std::uint32_t id = 0;  // PatchId in the forest
    };
};
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

inline OpenMesh::Vec3d to_openmesh(Point p) {
    return {p.x, p.y, p.z};
}

// One manifold piece and its vertices by forest id.
struct Piece {
    TriMesh mesh;
    std::map<std::uint32_t, OpenMesh::VertexHandle> vertices;

    OpenMesh::VertexHandle vertex(const Forest& forest, VertexId id) {
        const auto [entry, made] = vertices.try_emplace(id.value);
        if (made) {
            entry->second = mesh.add_vertex(to_openmesh(forest.point(id)));
            mesh.data(entry->second).id = id.value;
        }
        return entry->second;
    }

    // Whether the triangle fits: each directed edge free, each vertex still on the border.
    bool accepts(const Forest& forest, const PatchNode& node) {
        std::array<OpenMesh::VertexHandle, 3> v;
        for (int k = 0; k < 3; ++k) v[k] = vertex(forest, node.corners[k]);
        for (int k = 0; k < 3; ++k) {
            if (!mesh.is_boundary(v[k])) return false;
            const auto edge = mesh.find_halfedge(v[k], v[(k + 1) % 3]);
            if (edge.is_valid() && !mesh.is_boundary(edge)) return false;
        }
        return true;
    }

    OpenMesh::FaceHandle add(const Forest& forest, PatchId id) {
        const auto& node = forest[id];
        const auto face =
            mesh.add_face(vertex(forest, node.corners[0]), vertex(forest, node.corners[1]),
                          vertex(forest, node.corners[2]));
        if (face.is_valid()) mesh.data(face).id = id.value;
        return face;
    }

    // The face's own half of the edge between two of its vertices.
    OpenMesh::HalfedgeHandle edge_of(OpenMesh::FaceHandle face, VertexId a, VertexId b) const {
        const auto joins = [&](OpenMesh::HalfedgeHandle h) {
            const VertexId from(mesh.data(mesh.from_vertex_handle(h)).id);
            const VertexId to(mesh.data(mesh.to_vertex_handle(h)).id);
            return (from == a && to == b) || (from == b && to == a);
        };
        auto edge = mesh.halfedge_handle(face);
        while (!joins(edge)) edge = mesh.next_halfedge_handle(edge);
        return edge;
    }
};

struct Place {
    std::uint32_t piece = SurfaceMeshes::no_group;
    OpenMesh::FaceHandle face = OpenMesh::FaceHandle();
};

}  // namespace tyndall::mesh::manifold

namespace tyndall::mesh {

struct SurfaceMeshes::Meshes {
    std::vector<std::unique_ptr<manifold::Piece>> pieces;
    std::vector<manifold::Place> places;  // of each patch node that is a leaf

    void insert(const Forest& forest, PatchId id, std::uint32_t& first, std::uint32_t& last);
    // `t`: from the edge's lower vertex to its higher one.
    void split(Forest& forest, manifold::Piece& piece, std::uint32_t index,
               OpenMesh::HalfedgeHandle edge, double t, std::vector<PatchId>* made);
};

// Tries the group's pieces in turn, opens a new one when none accepts.
void SurfaceMeshes::Meshes::insert(const Forest& forest, PatchId id, std::uint32_t& first,
                                   std::uint32_t& last) {
    for (std::uint32_t k = first; k <= last; ++k) {
        if (k == pieces.size()) pieces.push_back(std::make_unique<manifold::Piece>());
        if (!pieces[k]->accepts(forest, forest[id])) {
            if (k == last) last = static_cast<std::uint32_t>(pieces.size());
            continue;
        }
        if (const auto face = pieces[k]->add(forest, id); face.is_valid()) {
            places[id.value] = {k, face};
            return;
        }
        if (k == last) last = static_cast<std::uint32_t>(pieces.size());
    }
}

SurfaceMeshes::SurfaceMeshes(const Forest& forest, std::span<const std::uint32_t> groups)
    : meshes_(std::make_unique<Meshes>()) {
    meshes_->places.resize(forest.patch_count());
    std::map<std::uint32_t, std::vector<PatchId>> members;
    for (std::size_t s = 0; s < groups.size(); ++s)
        if (groups[s] != no_group) members[groups[s]].push_back(PatchId(s));
    for (const auto& [group, patches] : members) {
        auto first = static_cast<std::uint32_t>(meshes_->pieces.size()), last = first;
        for (const PatchId patch : patches) meshes_->insert(forest, patch, first, last);
    }
}

SurfaceMeshes::~SurfaceMeshes() = default;

// Splits an edge and the one or two triangles on it, in the OpenMesh and in the forest alike.
void SurfaceMeshes::Meshes::split(Forest& forest, manifold::Piece& piece, std::uint32_t index,
                                  OpenMesh::HalfedgeHandle edge, double t,
                                  std::vector<PatchId>* made) {
    manifold::TriMesh& mesh = piece.mesh;
    const VertexId a(mesh.data(mesh.from_vertex_handle(edge)).id);
    const VertexId b(mesh.data(mesh.to_vertex_handle(edge)).id);
    const VertexId middle = forest.vertex_on_edge(std::min(a, b), std::max(a, b), t);

    std::vector<PatchId> children;
    for (const auto half : {edge, mesh.opposite_halfedge_handle(edge)}) {
        const auto face = mesh.face_handle(half);
        if (!face.is_valid()) continue;
        const PatchId patch(mesh.data(face).id);
        const auto& corners = forest[patch].corners;
        const int i =
            int(std::find(corners.begin(), corners.end(), std::min(a, b)) - corners.begin());
        const int j =
            int(std::find(corners.begin(), corners.end(), std::max(a, b)) - corners.begin());
        const PatchId first = forest.bisect(patch, i, j, t);
        places[patch.value] = manifold::Place{};
        children.push_back(first);
        children.push_back(PatchId(first.value + 1ull));
    }
    const auto vertex = mesh.add_vertex(manifold::to_openmesh(forest.point(middle)));
    mesh.data(vertex).id = middle.value;
    mesh.split_edge(mesh.edge_handle(edge), vertex);
    places.resize(forest.patch_count());
    // The faces around the new vertex are the children: match them by their third and fourth
    // corners.
    for (auto face = mesh.vf_begin(vertex); face.is_valid(); ++face) {
        std::array<std::uint32_t, 3> ids{};
        int n = 0;
        for (auto v = mesh.fv_begin(*face); v.is_valid(); ++v) ids[n++] = mesh.data(*v).id;
        std::sort(ids.begin(), ids.end());
        for (const PatchId child : children) {
            std::array<std::uint32_t, 3> corners{};
            for (int k = 0; k < 3; ++k) corners[k] = forest[child].corners[k].value;
            std::sort(corners.begin(), corners.end());
            if (corners != ids) continue;
            mesh.data(*face).id = child.value;
            places[child.value] = {index, *face};
        }
    }
    if (made) made->insert(made->end(), children.begin(), children.end());
}

void SurfaceMeshes::refine(Forest& forest, PatchId patch, std::vector<PatchId>* made) {
    while (forest.is_leaf(patch)) {
        const manifold::Place place = meshes_->places[patch.value];
        if (place.piece == no_group) return;
        manifold::Piece& piece = *meshes_->pieces[place.piece];
        const auto [i, j] = forest.longest_edge(patch);
        const auto& corners = forest[patch].corners;
        const VertexId a = corners[i], b = corners[j];
        const auto edge = piece.edge_of(place.face, a, b);

        const auto beyond = piece.mesh.face_handle(piece.mesh.opposite_halfedge_handle(edge));
        if (beyond.is_valid()) {
            const PatchId neighbour(piece.mesh.data(beyond).id);
            const auto [p, q] = forest.longest_edge(neighbour);
            const auto& other = forest[neighbour].corners;
            const bool same = (other[p] == a && other[q] == b) || (other[p] == b && other[q] == a);
            if (!same) {
                refine(forest, neighbour, made);
                continue;
            }
        }
        meshes_->split(forest, piece, place.piece, edge, 0.5, made);
    }
}

void SurfaceMeshes::split(Forest& forest, PatchId patch, int i, int j, double t,
                          std::vector<PatchId>* made) {
    const manifold::Place place = meshes_->places[patch.value];
    if (place.piece == no_group) return;
    manifold::Piece& piece = *meshes_->pieces[place.piece];
    const VertexId a = forest[patch].corners[i], b = forest[patch].corners[j];
    t = Forest::place(t);
    meshes_->split(forest, piece, place.piece, piece.edge_of(place.face, a, b), a < b ? t : 1.0 - t,
                   made);
}

std::array<PatchId, 3> SurfaceMeshes::neighbours(const Forest& forest, PatchId patch) const {
    std::array<PatchId, 3> result;
    const manifold::Place place = meshes_->places[patch.value];
    if (place.piece == no_group) return result;
    const manifold::TriMesh& mesh = meshes_->pieces[place.piece]->mesh;
    const auto& corners = forest[patch].corners;
    for (auto half = mesh.cfh_begin(place.face); half.is_valid(); ++half) {
        const auto beyond = mesh.face_handle(mesh.opposite_halfedge_handle(*half));
        if (!beyond.is_valid()) continue;
        const VertexId from(mesh.data(mesh.from_vertex_handle(*half)).id);
        const VertexId to(mesh.data(mesh.to_vertex_handle(*half)).id);
        for (int k = 0; k < 3; ++k)
            if (corners[k] != from && corners[k] != to) result[k] = PatchId(mesh.data(beyond).id);
    }
    return result;
}

}  // namespace tyndall::mesh
