#include "mesh/surface_mesh.h"

#include <algorithm>
#include <map>
#include <set>

#include "support/catch.h"
#include "support/ray_scenes.h"

using namespace tyndall;
using namespace tyndall::mesh;

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(VertexId a, VertexId b) {
    return {std::min(a, b).value, std::max(a, b).value};
}

// The side of a polygon that each facet side belongs to.
std::vector<std::uint32_t> groups_of(const ConformingComplex& complex, const BaseMesh& mesh) {
    std::vector<std::uint32_t> groups(2 * mesh.facets.size(), SurfaceMeshes::no_group);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        if (!mesh.facets[f].source.valid()) continue;
        const auto& source = complex.facets[mesh.facets[f].source.value];
        if (source.opacity != Opacity::opaque) continue;
        for (const auto& [slot, owner] : {std::pair{0, source.front}, std::pair{1, source.back}})
            if (owner.polygon.valid())
                groups[2 * f + slot] = 2 * owner.polygon.value + (owner.side == Side::back);
    }
    return groups;
}

struct Refined {
    BaseMesh mesh;
    Forest forest;
    std::vector<std::uint32_t> groups;
    std::unique_ptr<SurfaceMeshes> surfaces;
};

Refined refined(const test::RayScene& scene, int steps) {
    const auto complex = conform(scene.polygons);
    Refined r;
    r.mesh = tetrahedralize(complex, scene.polygons);
    r.forest = Forest(r.mesh);
    r.groups = groups_of(complex, r.mesh);
    r.surfaces = std::make_unique<SurfaceMeshes>(r.forest, r.groups);
    test::Random random(11);
    for (int k = 0; k < steps; ++k) {
        // Every third time near one corner, so that sizes differ widely.
        PatchId patch(test::index_below(random, k % 3 ? r.forest.patch_count() : 20));
        while (!r.forest.is_leaf(patch))
            patch = PatchId(r.forest[patch].first_child.value + (k % 3 ? random() % 2 : 0));
        if (r.groups[r.forest.base_facet_side(patch)] == SurfaceMeshes::no_group) continue;
        // Every fourth time cut somewhere along any edge, as along a shadow's.
        if (k % 4 == 0) {
            const int i = int(random() % 3), j = (i + 1 + int(random() % 2)) % 3;
            r.surfaces->split(r.forest, patch, i, j, test::uniform(random, 0.1, 0.9));
        } else {
            r.surfaces->refine(r.forest, patch);
        }
        REQUIRE(!r.forest.is_leaf(patch));
    }
    return r;
}

}  // namespace

TEST_CASE("No T-junction within a surface", "[surface_mesh]") {
    for (const auto& scene : test::ray_scenes()) {
        INFO(scene.name);
        Refined r = refined(scene, 3000);
        // Every edge of every leaf, by group. A vertex in the middle of a leaf's edge that another
        // leaf of its group has as a corner would be a T-junction.
        std::map<std::uint32_t, std::map<Edge, int>> edges;
        std::map<std::uint32_t, std::set<std::uint32_t>> vertices;
        std::size_t leaves = 0;
        const std::size_t count = r.forest.patch_count();
        for (std::size_t p = 0; p < count; ++p) {
            const PatchId patch(p);
            const auto group = r.groups[r.forest.base_facet_side(patch)];
            if (!r.forest.is_leaf(patch) || group == SurfaceMeshes::no_group) continue;
            ++leaves;
            const auto& c = r.forest[patch].corners;
            for (int k = 0; k < 3; ++k) {
                ++edges[group][edge_of(c[k], c[(k + 1) % 3])];
                vertices[group].insert(c[k].value);
            }
        }
        CHECK(leaves > 3000);
        std::size_t hanging = 0, crowded = 0;
        for (const auto& [group, of_group] : edges)
            for (const auto& [edge, uses] : of_group) crowded += uses > 2;
        // A vertex on an edge, in its middle or elsewhere, that a leaf has as a corner while
        // another still has the whole edge.
        const std::size_t base = r.forest.vertex_count() - r.forest.vertex_edges().size();
        for (std::size_t k = 0; k < r.forest.vertex_edges().size(); ++k) {
            const auto& on = r.forest.vertex_edges()[k];
            for (const auto& [group, of_group] : edges)
                hanging += vertices[group].count(static_cast<std::uint32_t>(base + k)) &&
                           of_group.count(edge_of(on.a, on.b));
        }
        CHECK(hanging == 0);
        CHECK(crowded == 0);
    }
}

TEST_CASE("Neighbours are mutual and share the edge", "[surface_mesh]") {
    for (const auto& scene : test::ray_scenes()) {
        INFO(scene.name);
        const Refined r = refined(scene, 500);
        std::map<std::pair<std::uint32_t, Edge>, int> uses;
        for (std::size_t p = 0; p < r.forest.patch_count(); ++p) {
            const PatchId patch(p);
            if (!r.forest.is_leaf(patch)) continue;
            const auto group = r.groups[r.forest.base_facet_side(patch)];
            const auto& c = r.forest[patch].corners;
            for (int k = 0; k < 3; ++k) ++uses[{group, edge_of(c[k], c[(k + 1) % 3])}];
        }
        std::size_t wrong = 0, missing = 0;
        for (std::size_t p = 0; p < r.forest.patch_count(); ++p) {
            const PatchId patch(p);
            const auto group = r.groups[r.forest.base_facet_side(patch)];
            if (!r.forest.is_leaf(patch) || group == SurfaceMeshes::no_group) continue;
            const auto next = r.surfaces->neighbours(r.forest, patch);
            const auto& c = r.forest[patch].corners;
            for (int k = 0; k < 3; ++k) {
                const Edge edge = edge_of(c[(k + 1) % 3], c[(k + 2) % 3]);
                if (!next[k].valid()) {
                    missing += uses[{group, edge}] == 2;
                    continue;
                }
                const auto& other = r.forest[next[k]].corners;
                wrong += !r.forest.is_leaf(next[k]);
                wrong += std::count(other.begin(), other.end(), VertexId(edge.first)) != 1;
                wrong += std::count(other.begin(), other.end(), VertexId(edge.second)) != 1;
                const auto back = r.surfaces->neighbours(r.forest, next[k]);
                wrong += std::count(back.begin(), back.end(), patch) != 1;
            }
        }
        CHECK(wrong == 0);
        CHECK(missing == 0);
    }
}

TEST_CASE("Refinement reports what it made", "[surface_mesh]") {
    const auto scene = test::ray_scenes()[0];
    const auto complex = conform(scene.polygons);
    const BaseMesh mesh = tetrahedralize(complex, scene.polygons);
    Forest forest(mesh);
    const auto groups = groups_of(complex, mesh);
    SurfaceMeshes surfaces(forest, groups);
    const auto first = static_cast<std::uint32_t>(
        std::find_if(groups.begin(), groups.end(),
                     [](std::uint32_t g) { return g != SurfaceMeshes::no_group; }) -
        groups.begin());
    const std::size_t before = forest.patch_count();
    std::vector<PatchId> made;
    surfaces.refine(forest, PatchId(first), &made);
    CHECK(made.size() == forest.patch_count() - before);
    for (std::size_t k = 0; k < made.size(); ++k) CHECK(made[k] == PatchId(before + k));
}
