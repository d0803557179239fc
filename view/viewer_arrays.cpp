#include "view/viewer_arrays.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>
#include <unordered_map>

namespace tyndall::view {
namespace {

using mesh::Direction;
using mesh::FacetId;
using mesh::PatchId;
using mesh::Point;
using mesh::Side;
using mesh::TetId;
using mesh::ZoneId;
using radiosity::Affine;
using radiosity::none;

// Of a leaf or of an inner node on the way to it: what its four faces lie on and lead to.
struct Faces {
    std::array<std::int32_t, 4> planes, ropes;
};

// The corner that a child does not share with its parent.
template <class Node>
int replaced_corner(const Node& parent, const Node& child) {
    for (int k = 0; k < static_cast<int>(parent.corners.size()); ++k)
        if (child.corners[k] != parent.corners[k]) return k;
    return 0;
}

class Packer {
  public:
    Packer(const radiosity::Solution& solution, const SharpenedPatches& sharpened)
        : s_(with_inner_nodes(solution)),
          e_(*solution.enclosure),
          sharpened_(sharpened),
          passes_(pass_meshes(solution)) {
        a_.bands = e_.bands;
        a_.origin = 0.5 * (e_.mesh.hull_min + e_.mesh.hull_max);
        zone_rope_.resize(s_.forest.zone_count());
        piece_rope_.resize(sharpened_.forest.patch_count(), dark);
    }

    ViewerArrays pack() {
        add_rows();
        number_zones();
        number_patches();
        add_walls();
        add_base_faces();
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t)
            add_zones(mesh::root_zone(TetId(t)), base_faces_[t]);
        for (std::size_t p = 0; p < 2 * e_.mesh.facets.size(); ++p)
            if (side_of(PatchId(p)) != none) add_pieces(PatchId(p), PatchId());
        a_.meshes = passes_.meshes;
        add_coarser(zone_order_, passes_.zone_born, a_.zone_above, a_.zone_born, a_.coarser_zones);
        add_coarser(patch_order_, passes_.patch_born, a_.patch_above, a_.patch_born,
                    a_.coarser_patches);
        return std::move(a_);
    }

  private:
    std::uint32_t side_of(PatchId patch) const {
        return radiosity::side_of(e_, sharpened_.forest, patch);
    }

    std::int32_t add_plane(Direction normal, double offset) {
        const auto index = static_cast<std::int32_t>(a_.planes.size() / 4);
        for (int k = 0; k < 3; ++k) a_.planes.push_back(static_cast<float>(normal[k]));
        a_.planes.push_back(static_cast<float>(offset + glm::dot(normal, a_.origin)));
        return index;
    }

    void add_function(std::vector<float>& values, const Affine& f, double factor) const {
        for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(factor * f.gradient[k]));
        values.push_back(static_cast<float>(factor * f.at(a_.origin)));
    }

    void add_row_value(double extinction, double emission) {
        a_.rows.push_back(static_cast<float>(extinction));
        a_.rows.push_back(static_cast<float>(emission));
    }

    // Media first, sides after.
    void add_rows() {
        for (const auto& medium : e_.media)
            for (std::size_t b = 0; b < e_.bands; ++b)
                add_row_value(medium.extinction[b], medium.emission[b]);
        for (const auto& side : e_.sides)
            for (std::size_t b = 0; b < e_.bands; ++b) add_row_value(0.0, side.emission[b]);
    }

    // The row of an element: the common one, or where emission is found with the solution its own.
    template <class Node>
    std::int32_t row_of(Node node, std::size_t common) {
        if (s_.settled.zone.empty() && s_.settled.patch.empty())
            return static_cast<std::int32_t>(common);
        const auto row = static_cast<std::int32_t>(a_.rows.size() / (2 * e_.bands));
        for (std::size_t b = 0; b < e_.bands; ++b)
            add_row_value(a_.rows[2 * (common * e_.bands + b)],
                          radiosity::emission_of(s_, node, b));
        return row;
    }

    // Trees one after the other, in the order that add_zones meets them.
    void number_zones() {
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t)
            number(s_.forest, mesh::root_zone(TetId(t)), zone_rope_, RopeKind::zone, zones_);
    }

    void number_patches() {
        for (std::size_t p = 0; p < 2 * e_.mesh.facets.size(); ++p)
            if (side_of(PatchId(p)) != none)
                number(sharpened_.forest, PatchId(p), piece_rope_, RopeKind::patch, pieces_);
        a_.nodes.resize(3 * nodes_);
    }

    template <class Node>
    void number(const radiosity::Forest& forest, Node node, std::vector<std::int32_t>& ropes,
                RopeKind leaf, std::size_t& leaves) {
        if (forest.is_leaf(node)) {
            ropes[node.value] = rope_to(leaf, leaves++);
            return;
        }
        ropes[node.value] = rope_to(RopeKind::node, nodes_++);
        const auto first = forest[node].first_child;
        number(forest, first, ropes, leaf, leaves);
        number(forest, Node(first.value + 1ull), ropes, leaf, leaves);
    }

    void add_walls() {
        for (std::size_t f = 0; f < e_.mesh.facets.size(); ++f)
            for (const Side side : {Side::front, Side::back}) {
                const TetId behind = e_.mesh.facets[f].tets[side == Side::front ? 1 : 0];
                a_.walls.push_back(piece_rope_[mesh::root_patch(FacetId(f), side).value]);
                a_.walls.push_back(behind.valid() ? zone_rope_[behind.value] : outside);
            }
    }

    // What is across the face of a base tet.
    std::int32_t rope_across(TetId tet, int k) const {
        const FacetId facet = e_.mesh.tet_facets[tet.value][k];
        const TetId next = e_.mesh.neighbours[tet.value][k];
        if (facet.valid() && e_.mesh.facets[facet.value].opacity == mesh::Opacity::opaque) {
            const bool front = e_.mesh.facets[facet.value].tets[0] == tet;
            return rope_to(RopeKind::wall, 2ull * facet.value + (front ? 0 : 1));
        }
        return next.valid() ? zone_rope_[next.value] : outside;
    }

    // Planes of faces that two tets share are made once.
    void add_base_faces() {
        base_faces_.resize(e_.mesh.tets.size());
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t)
            for (int k = 0; k < 4; ++k) {
                const TetId tet(t), next = e_.mesh.neighbours[t][k];
                base_faces_[t].ropes[k] = rope_across(tet, k);
                if (!next.valid()) add_hull_face(tet, k);
                if (next.valid() && next < tet) continue;
                const std::int32_t plane = add_face_plane(tet, k);
                base_faces_[t].planes[k] = 2 * plane;
                if (!next.valid()) continue;
                for (int j = 0; j < 4; ++j)
                    if (e_.mesh.neighbours[next.value][j] == tet)
                        base_faces_[next.value].planes[j] = 2 * plane + 1;
            }
    }

    Point corner(TetId tet, int k) const {
        return e_.mesh.points[e_.mesh.tets[tet.value][k].value];
    }

    // Its normal looks into the tet.
    std::int32_t add_face_plane(TetId tet, int k) {
        const auto& f = mesh::face_corners[k];
        const Point a = corner(tet, f[0]);
        const Direction normal =
            -glm::normalize(glm::cross(corner(tet, f[1]) - a, corner(tet, f[2]) - a));
        return add_plane(normal, -glm::dot(normal, a));
    }

    void add_hull_face(TetId tet, int k) {
        for (const int c : mesh::face_corners[k])
            for (int axis = 0; axis < 3; ++axis)
                a_.hull_corners.push_back(
                    static_cast<float>(corner(tet, c)[axis] - a_.origin[axis]));
        a_.hull_zones.push_back(zone_rope_[tet.value]);
    }

    void add_zones(ZoneId zone, const Faces& faces) {
        const auto& node = s_.forest[zone];
        if (s_.forest.is_leaf(zone)) return add_zone(zone, faces);
        const ZoneId first = node.first_child, second(first.value + 1ull);
        const std::int32_t plane = add_plane(node.plane_normal, node.plane_offset);
        set_node(zone_rope_[zone.value], plane, zone_rope_[first.value], zone_rope_[second.value]);
        // A child's face on the split plane is opposite the corner that it shares with its parent
        // and its sibling does not: first is where the plane's value is negative.
        const int i = replaced_corner(node, s_.forest[second]);
        const int j = replaced_corner(node, s_.forest[first]);
        Faces low = faces, high = faces;
        low.planes[i] = 2 * plane + 1;
        low.ropes[i] = zone_rope_[second.value];
        high.planes[j] = 2 * plane;
        high.ropes[j] = zone_rope_[first.value];
        add_zones(first, low);
        add_zones(second, high);
    }

    void set_node(std::int32_t rope, std::int32_t plane, std::int32_t first, std::int32_t second) {
        const auto index = static_cast<std::size_t>(rope / 4);
        a_.nodes[3 * index] = plane;
        a_.nodes[3 * index + 1] = first;
        a_.nodes[3 * index + 2] = second;
    }

    void add_zone(ZoneId zone, const Faces& faces) {
        zone_order_.push_back(zone);
        a_.zone_planes.insert(a_.zone_planes.end(), faces.planes.begin(), faces.planes.end());
        a_.zone_ropes.insert(a_.zone_ropes.end(), faces.ropes.begin(), faces.ropes.end());
        const TetId tet = s_.forest.base_tet(zone);
        const auto medium = e_.solid(tet) ? none : e_.medium_of(tet);
        a_.zone_medium.push_back(medium == none ? -1 : static_cast<std::int32_t>(medium));
        a_.zone_row.push_back(medium != none  ? row_of(zone, medium)
                              : e_.solid(tet) ? solid_inside
                                              : empty_space);
        a_.zone_level.push_back(static_cast<std::int32_t>(s_.forest[zone].level));
        a_.zone_error.push_back(medium == none ? 0.0f : s_.zone_error[zone.value]);
        a_.zone_volume.push_back(static_cast<float>(s_.forest.volume(zone)));
        for (std::size_t b = 0; b < e_.bands; ++b) {
            const double albedo = medium == none ? 0.0 : e_.media[medium].albedo[b];
            add_function(a_.zone_direct, s_.direct.at(zone, b), albedo);
            add_function(a_.zone_indirect, s_.indirect.at(zone, b), albedo);
            if (e_.varies()) add_extinction(zone, medium, b);
        }
    }

    void add_extinction(ZoneId zone, std::uint32_t medium, std::size_t band) {
        Affine f;
        if (medium != none && e_.media[medium].varying.empty())
            f.constant = e_.media[medium].extinction[band];
        else if (medium != none) {
            std::array<Point, 4> corners;
            std::array<double, 4> values;
            for (int k = 0; k < 4; ++k) {
                corners[k] = s_.forest.point(s_.forest[zone].corners[k]);
                values[k] = e_.media[medium].varying[band].at(corners[k]);
            }
            f = radiosity::with_mean(radiosity::interpolate(corners, values),
                                     s_.forest.centroid(zone),
                                     radiosity::extinction_in(e_, s_.forest, zone, band).mean);
        }
        add_function(a_.zone_extinction, f, 1.0);
    }

    // Pieces below a node; `patch`: the leaf of the solution that holds them, once it is found.
    void add_pieces(PatchId piece, PatchId patch) {
        const auto& forest = sharpened_.forest;
        if (!patch.valid() && s_.forest.is_leaf(piece)) {
            patch = piece;
            add_patch(patch);
        }
        if (forest.is_leaf(piece)) {
            a_.piece_patch.push_back(static_cast<std::int32_t>(a_.patch_row.size() - 1));
            for (std::size_t b = 0; b < e_.bands; ++b)
                add_function(a_.piece_direct, sharpened_.direct.at(piece, b),
                             radiosity::scatter_of(s_, patch, b));
            return;
        }
        const auto& node = forest[piece];
        const PatchId first = node.first_child, second(first.value + 1ull);
        set_node(piece_rope_[piece.value], add_plane(node.plane_normal, node.plane_offset),
                 piece_rope_[first.value], piece_rope_[second.value]);
        add_pieces(first, patch);
        add_pieces(second, patch);
    }

    void add_patch(PatchId patch) {
        patch_order_.push_back(patch);
        const auto side = radiosity::side_of(e_, s_.forest, patch);
        a_.patch_row.push_back(row_of(patch, e_.media.size() + side));
        a_.patch_side.push_back(static_cast<std::int32_t>(side));
        a_.patch_level.push_back(static_cast<std::int32_t>(s_.forest[patch].level));
        a_.patch_error.push_back(s_.patch_error[patch.value]);
        a_.patch_area.push_back(static_cast<float>(s_.forest.area(patch)));
        for (std::size_t b = 0; b < e_.bands; ++b)
            add_function(a_.patch_indirect, s_.indirect.at(patch, b),
                         radiosity::scatter_of(s_, patch, b));
    }

    // The elements of earlier passes above `leaves`, which were leaves themselves when such a pass
    // ended: those whose children were born in a later one.
    template <class Node>
    void add_coarser(const std::vector<Node>& leaves, const std::vector<std::int32_t>& born,
                     std::vector<std::int32_t>& above, std::vector<std::int32_t>& leaf_born,
                     CoarserElements& coarser) {
        std::unordered_map<std::uint32_t, std::int32_t> known;
        std::vector<double> squares;
        for (const Node leaf : leaves) {
            leaf_born.push_back(born[leaf.value]);
            above.push_back(-1);
            std::int32_t last = -1;  // of those found; -1: the leaf itself
            Node child = leaf;
            for (Node node = s_.forest[leaf].parent; node.valid();
                 child = node, node = s_.forest[node].parent) {
                if (born[child.value] == born[node.value]) continue;
                const auto [at, is_new] =
                    known.emplace(node.value, static_cast<std::int32_t>(coarser.born.size()));
                if (is_new) {
                    add_coarser_element(node, born[node.value], coarser);
                    squares.push_back(0.0);
                }
                (last < 0 ? above.back() : coarser.above[last]) = at->second;
                last = at->second;
                squares[last] += squared_error(leaf, node);
            }
        }
        for (std::size_t k = 0; k < squares.size(); ++k)
            coarser.error.push_back(
                static_cast<float>(std::sqrt(squares[k] / static_cast<double>(coarser.size[k]))));
    }

    void add_coarser_element(ZoneId zone, std::int32_t born, CoarserElements& c) {
        const auto medium = radiosity::medium_of(e_, s_.forest, zone);
        c.row.push_back(row_of(zone, medium));
        c.size.push_back(static_cast<float>(s_.forest.volume(zone)));
        for (std::size_t b = 0; b < e_.bands; ++b)
            add_function(c.direct, s_.direct.at(zone, b), e_.media[medium].albedo[b]);
        add_coarser_common(zone, born, c);
    }

    void add_coarser_element(PatchId patch, std::int32_t born, CoarserElements& c) {
        c.row.push_back(row_of(patch, e_.media.size() + side_of(patch)));
        c.size.push_back(static_cast<float>(s_.forest.area(patch)));
        add_coarser_common(patch, born, c);
    }

    template <class Node>
    void add_coarser_common(Node node, std::int32_t born, CoarserElements& c) {
        c.above.push_back(-1);
        c.born.push_back(born);
        c.level.push_back(static_cast<std::int32_t>(s_.forest[node].level));
        for (std::size_t b = 0; b < e_.bands; ++b)
            add_function(c.indirect, s_.indirect.at(node, b), radiosity::scatter_of(s_, node, b));
    }

    // What a leaf adds to the squared error of an element above it, times its size: of the band
    // that is off most, at its centroid. Direct light on patches is drawn anew, and does not count.
    template <class Node>
    double squared_error(Node leaf, Node above) const {
        constexpr bool zone = std::is_same_v<Node, ZoneId>;
        const Point x = s_.forest.centroid(leaf);
        double off = 0.0;
        for (std::size_t b = 0; b < e_.bands; ++b) {
            double difference = s_.indirect.at(leaf, b).at(x) - s_.indirect.at(above, b).at(x);
            if (zone) difference += s_.direct.at(leaf, b).at(x) - s_.direct.at(above, b).at(x);
            off = std::max(off, std::abs(radiosity::scatter_of(s_, leaf, b) * difference));
        }
        double own = 0.0, size = 0.0;
        if constexpr (zone) {
            own = s_.zone_error[leaf.value];
            size = s_.forest.volume(leaf);
        } else {
            own = s_.patch_error[leaf.value];
            size = s_.forest.area(leaf);
        }
        return size * (off * off + own * own);
    }

    const radiosity::Solution s_;
    const radiosity::Enclosure& e_;
    const SharpenedPatches& sharpened_;
    const PassMeshes passes_;
    std::vector<ZoneId> zone_order_;  // leaves in the order of the arrays
    std::vector<PatchId> patch_order_;
    ViewerArrays a_;
    std::vector<std::int32_t> zone_rope_, piece_rope_;  // of every node: what leads to it
    std::vector<Faces> base_faces_;
    std::size_t zones_ = 0, pieces_ = 0, nodes_ = 0;
};

}  // namespace

ViewerArrays viewer_arrays(const radiosity::Solution& solution, const SharpenedPatches& patches) {
    return Packer(solution, patches).pack();
}

}  // namespace tyndall::view
