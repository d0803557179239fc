#include "render/arriving_places.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <map>

#include "mesh/body.h"

namespace tyndall::render {

using mesh::PatchId;
using mesh::Point;
using mesh::TetId;
using mesh::VertexId;
using mesh::ZoneId;
using radiosity::none;

namespace {

// From a corner on a wall towards the node's middle [-].
constexpr double off_wall = 1e-3;

class Finder {
  public:
    Finder(const radiosity::Solution& solution, const ArrivingPlacesOptions& options)
        : s_(solution), e_(*solution.enclosure) {
        result_.zone_groups.assign(s_.forest.zone_count(), none);
        result_.patch_groups.assign(s_.forest.patch_count(), none);
        find_walls();
        find_lit_patches();
        find_zones(options);
        result_.in_media = result_.places.size();
        if (result_.in_media > 0) find_patches(options.patch_group, options.lit_patch_group);
    }

    ArrivingPlaces take() { return std::move(result_); }

  private:
    struct Box {
        Point low{std::numeric_limits<double>::max()}, high{-std::numeric_limits<double>::max()};

        void add(Point x) {
            low = glm::min(low, x);
            high = glm::max(high, x);
        }
        double diagonal() const { return glm::distance(low, high); }
    };

    // Base vertices of opaque facets.
    void find_walls() {
        on_wall_.assign(e_.mesh.points.size(), false);
        for (const auto& facet : e_.mesh.facets)
            if (facet.opacity == mesh::Opacity::opaque)
                for (const VertexId v : facet.corners) on_wall_[v.value] = true;
    }

    // Nodes with a leaf in which direct light is more than indirect. Children come after parents.
    template <class Id>
    std::vector<bool> lit_nodes(std::size_t count) const {
        std::vector<bool> lit(count, false);
        for (std::size_t n = count; n-- > 0;) {
            const Id node(n);
            const Id first = s_.forest[node].first_child;
            if (first.valid()) {
                lit[n] = lit[first.value] || lit[first.value + 1];
                continue;
            }
            const Point x = s_.forest.centroid(node);
            for (std::size_t b = 0; b < e_.bands; ++b)
                if (s_.direct.at(node, b).at(x) > s_.indirect.at(node, b).at(x)) lit[n] = true;
        }
        return lit;
    }

    template <class OnTet>
    void for_tets(OnTet&& on_tet) const {
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t) {
            const TetId tet(t);
            if (e_.solid(tet) || e_.medium_of(tet) == none) continue;
            if (!e_.media[e_.medium_of(tet)].phase.isotropic()) on_tet(tet, e_.medium_of(tet));
        }
    }

    void find_lit_patches() {
        const auto lit = lit_nodes<PatchId>(s_.forest.patch_count());
        for (std::size_t p = 0; p < lit.size(); ++p)
            if (lit[p] && s_.forest.is_leaf(PatchId(p)) && reflects(PatchId(p)))
                lit_patches_.push_back(s_.forest.centroid(PatchId(p)));
    }

    bool reflects(PatchId patch) const {
        const auto side = radiosity::side_of(e_, s_.forest, patch);
        return side != none && std::ranges::any_of(e_.sides[side].reflectance,
                                                   [](double rho) { return rho > 0.0; });
    }

    void find_zones(const ArrivingPlacesOptions& options) {
        lit_ = lit_nodes<ZoneId>(s_.forest.zone_count());
        std::vector<Box> boxes(e_.media.size());
        for_tets([&](TetId tet, std::uint32_t medium) {
            for (const VertexId v : e_.mesh.tets[tet.value])
                boxes[medium].add(e_.mesh.points[v.value]);
        });
        for_tets([&](TetId tet, std::uint32_t medium) {
            const double diagonal = boxes[medium].diagonal();
            below(mesh::root_zone(tet), {options.group * diagonal, options.lit_group * diagonal,
                                         options.near, options.least * diagonal});
        });
    }

    struct Sizes {
        double dark, lit;    // [m]
        double near = 0.0;   // over the distance of a lit patch [-]
        double least = 0.0;  // [m]
    };
    // Whether a node is too large to stand together.
    template <class Id>
    bool divide(Id node, const Sizes& sizes) const {
        const double edge = s_.forest[node].longest_edge;
        if (s_.forest.is_leaf(node) || edge <= sizes.least) return false;
        if (edge > (lit_[node.value] ? sizes.lit : sizes.dark)) return true;
        if (!(sizes.near > 0.0)) return false;
        const Point x = s_.forest.centroid(node);
        return std::ranges::any_of(
            lit_patches_, [&](Point patch) { return glm::distance(patch, x) * sizes.near < edge; });
    }

    void below(ZoneId zone, const Sizes& sizes) {
        const auto& forest = s_.forest;
        if (divide(zone, sizes)) {
            for (const std::uint32_t k : {0u, 1u})
                below(ZoneId(forest[zone].first_child.value + k), sizes);
            return;
        }
        const auto group = std::uint32_t(result_.zone_corners.size());
        result_.zone_groups[zone.value] = group;
        std::array<std::uint32_t, 4> corners;
        for (int k = 0; k < 4; ++k) corners[k] = place_at(zone, forest[zone].corners[k]);
        result_.zone_corners.push_back(corners);
        keep_leaves(zone, group);
    }

    void keep_leaves(ZoneId zone, std::uint32_t group) {
        if (s_.forest.is_leaf(zone)) {
            result_.zones.push_back(zone);
            result_.group_of_zone.push_back(group);
            return;
        }
        for (const std::uint32_t k : {0u, 1u})
            keep_leaves(ZoneId(s_.forest[zone].first_child.value + k), group);
    }

    std::uint32_t place(std::array<std::uint32_t, 2> key, const radiosity::GatherPoint& point) {
        const auto [at, fresh] = known_.try_emplace(key, result_.places.size());
        if (fresh) result_.places.push_back(point);
        return std::uint32_t(at->second);
    }

    // A corner that may be on a wall has a place for each base tet: two of them may lie on two
    // sides of it.
    std::uint32_t place_at(ZoneId zone, VertexId corner) {
        const auto& forest = s_.forest;
        bool wall = true;
        for (const VertexId v : forest.carrier(corner))
            if (v.valid()) wall = wall && on_wall_[v.value];
        const TetId tet = forest.base_tet(zone);
        const Point x = forest.point(corner);
        const Point off = wall ? x + off_wall * (forest.centroid(zone) - x) : x;
        return place({corner.value, wall ? tet.value : none}, {off, {tet}});
    }

    void find_patches(double group, double lit_group) {
        known_.clear();
        lit_ = lit_nodes<PatchId>(s_.forest.patch_count());
        Box box;
        for (const Point x : e_.mesh.points) box.add(x);
        const Sizes sizes{group * box.diagonal(), lit_group * box.diagonal()};
        for (std::size_t f = 0; f < e_.mesh.facets.size(); ++f)
            for (const auto side : {mesh::Side::front, mesh::Side::back}) {
                const PatchId root = mesh::root_patch(mesh::FacetId(f), side);
                if (reflects(root)) below(root, sizes);
            }
    }

    void below(PatchId patch, const Sizes& sizes) {
        const auto& forest = s_.forest;
        if (divide(patch, sizes)) {
            for (const std::uint32_t k : {0u, 1u})
                below(PatchId(forest[patch].first_child.value + k), sizes);
            return;
        }
        result_.patch_groups[patch.value] = std::uint32_t(result_.patch_corners.size());
        const std::uint32_t root = forest.base_facet_side(patch);
        std::array<std::uint32_t, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const VertexId corner = forest[patch].corners[k];
            const Point x = forest.point(corner);
            const Point off = x + off_wall * (forest.centroid(patch) - x);
            corners[k] = place({corner.value, root}, {off, mesh::start_before(e_.mesh, root, off),
                                                      radiosity::normal_of(forest, patch)});
        }
        result_.patch_corners.push_back(corners);
    }

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    ArrivingPlaces result_;
    std::vector<bool> on_wall_, lit_;
    std::vector<Point> lit_patches_;  // leaves' centroids
    std::map<std::array<std::uint32_t, 2>, std::size_t> known_;
};

}  // namespace

ArrivingPlaces arriving_places(const radiosity::Solution& solution,
                               const ArrivingPlacesOptions& options) {
    return Finder(solution, options).take();
}

}  // namespace tyndall::render
