// The meshes of earlier passes: which elements they had, and what these hold.
#include "view/pass_meshes.h"

#include <set>

#include "radiosity/adaptive.h"
#include "support/catch.h"
#include "support/rooms.h"
#include "view/viewer_arrays.h"

using namespace tyndall;

namespace {

const radiosity::Solution& refined() {
    static const radiosity::Solution solution = radiosity::solve_adaptively(
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(test::slit_room())),
        {.error = 0.05,
         .start = radiosity::Start::base,
         .max_elements = 3000,
         .rays = 16,
         .gather_rays = 16});
    return solution;
}

// The leaves of the trees of some roots, in the arrays' order.
template <class Node>
void collect(const mesh::Forest& forest, Node node, std::vector<Node>& leaves) {
    if (forest.is_leaf(node)) return leaves.push_back(node);
    const Node first = forest[node].first_child;
    collect(forest, first, leaves);
    collect(forest, Node(first.value + 1ull), leaves);
}

std::vector<mesh::ZoneId> zones_of(const radiosity::Solution& s) {
    std::vector<mesh::ZoneId> leaves;
    for (std::size_t t = 0; t < s.enclosure->mesh.tets.size(); ++t)
        collect(s.forest, mesh::ZoneId(t), leaves);
    return leaves;
}

std::vector<mesh::PatchId> patches_of(const radiosity::Solution& s) {
    std::vector<mesh::PatchId> leaves;
    for (std::size_t p = 0; p < 2 * s.enclosure->mesh.facets.size(); ++p)
        if (radiosity::side_of(*s.enclosure, s.forest, mesh::PatchId(p)) != radiosity::none)
            collect(s.forest, mesh::PatchId(p), leaves);
    return leaves;
}

// The coarser element that a mesh shows for a leaf; -1: the leaf itself.
std::int32_t shown(std::int32_t born, std::int32_t above, const view::CoarserElements& coarser,
                   std::int32_t mesh) {
    if (born <= mesh) return -1;
    while (coarser.born[above] > mesh) above = coarser.above[above];
    return above;
}

double at(const std::vector<float>& functions, std::size_t index, mesh::Point x) {
    return functions[4 * index] * x.x + functions[4 * index + 1] * x.y +
           functions[4 * index + 2] * x.z + functions[4 * index + 3];
}

}  // namespace

TEST_CASE("The mesh of every pass has the elements that its report counts", "[view]") {
    const auto& s = refined();
    const auto passes = view::pass_meshes(s);
    REQUIRE(passes.meshes.size() >= 2);
    CHECK(passes.meshes.back().zones == s.report.zones);
    CHECK(passes.meshes.back().patches == s.report.patches);
    CHECK(passes.meshes.front().passes.starts_with(s.report.passes.front().stage));
    const auto a = view::viewer_arrays(s, {s.forest, s.direct});
    REQUIRE(a.meshes.size() == passes.meshes.size());
    for (std::size_t m = 0; m < a.meshes.size(); ++m) {
        std::set<std::pair<bool, std::int32_t>> zones, patches;
        for (std::size_t z = 0; z < a.zone_count(); ++z) {
            if (a.zone_row[z] < 0) continue;
            const auto c = shown(a.zone_born[z], a.zone_above[z], a.coarser_zones,
                                 static_cast<std::int32_t>(m));
            zones.insert({c < 0, c < 0 ? static_cast<std::int32_t>(z) : c});
        }
        for (std::size_t p = 0; p < a.patch_count(); ++p) {
            const auto c = shown(a.patch_born[p], a.patch_above[p], a.coarser_patches,
                                 static_cast<std::int32_t>(m));
            patches.insert({c < 0, c < 0 ? static_cast<std::int32_t>(p) : c});
        }
        CAPTURE(m, a.meshes[m].passes);
        CHECK(zones.size() == a.meshes[m].zones);
        CHECK(patches.size() == a.meshes[m].patches);
    }
}

TEST_CASE("Elements of earlier passes hold the means of what they were bisected into", "[view]") {
    const auto& s = refined();
    const auto a = view::viewer_arrays(s, {s.forest, s.direct});
    const auto zones = zones_of(s);
    const auto patches = patches_of(s);
    REQUIRE(zones.size() == a.zone_count());
    REQUIRE(patches.size() == a.patch_count());
    // Functions are linear: an element's integral is the sum over its leaves of size times value at
    // their centroids.
    double direct = 0.0, indirect = 0.0, reflected = 0.0;
    for (std::size_t z = 0; z < zones.size(); ++z) {
        const auto x = s.forest.centroid(zones[z]) - a.origin;
        direct += s.forest.volume(zones[z]) * at(a.zone_direct, z, x);
        indirect += s.forest.volume(zones[z]) * at(a.zone_indirect, z, x);
    }
    for (std::size_t p = 0; p < patches.size(); ++p)
        reflected += s.forest.area(patches[p]) *
                     at(a.patch_indirect, p, s.forest.centroid(patches[p]) - a.origin);
    double coarse_direct = 0.0, coarse_indirect = 0.0, coarse_reflected = 0.0;
    std::size_t zones_above = 0, patches_above = 0;
    for (std::size_t z = 0; z < zones.size(); ++z) {
        const auto c = shown(a.zone_born[z], a.zone_above[z], a.coarser_zones, 0);
        const auto x = s.forest.centroid(zones[z]) - a.origin;
        const double volume = s.forest.volume(zones[z]);
        coarse_direct +=
            volume * (c < 0 ? at(a.zone_direct, z, x) : at(a.coarser_zones.direct, c, x));
        coarse_indirect +=
            volume * (c < 0 ? at(a.zone_indirect, z, x) : at(a.coarser_zones.indirect, c, x));
        zones_above += c >= 0;
    }
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const auto c = shown(a.patch_born[p], a.patch_above[p], a.coarser_patches, 0);
        const auto x = s.forest.centroid(patches[p]) - a.origin;
        coarse_reflected +=
            s.forest.area(patches[p]) *
            (c < 0 ? at(a.patch_indirect, p, x) : at(a.coarser_patches.indirect, c, x));
        patches_above += c >= 0;
    }
    REQUIRE(zones_above + patches_above > 500);
    // To single precision.
    CHECK(coarse_direct == Approx(direct).epsilon(1e-5));
    CHECK(coarse_indirect == Approx(indirect).epsilon(1e-5));
    CHECK(coarse_reflected == Approx(reflected).epsilon(1e-5));
    for (const float error : a.coarser_zones.error) CHECK(error > 0.0f);
}

TEST_CASE("A solution that does not tell its passes shows its last mesh alone", "[view]") {
    auto s = refined();
    s.report.passes.front().zones += 1;  // that the forest never had with so many patches
    s.report.passes.front().patches = 1;
    CHECK(view::pass_meshes(s).meshes.size() >= 1);
    CHECK(view::pass_meshes(s).meshes.back().zones == s.report.zones);
    s.report.passes.resize(1);
    CHECK(view::pass_meshes(s).meshes.empty());
    s.report.passes.clear();
    const auto a = view::viewer_arrays(s, {s.forest, s.direct});
    CHECK(a.meshes.empty());
    CHECK(a.coarser_zones.born.empty());
    CHECK(std::count(a.zone_above.begin(), a.zone_above.end(), -1) ==
          std::ptrdiff_t(a.zone_count()));
}
