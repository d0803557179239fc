// Every indicator bisects where it should, and nowhere else.
#include "radiosity/indicators.h"

#include <algorithm>
#include <cstring>

#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "radiosity/scene_builder.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

using Names = std::vector<std::string>;

Solution solve(const Enclosure& enclosure, const Names& names, const Indicator& own = {},
               std::size_t max_elements = 4000, double error = 0.1) {
    SolveOptions options;
    options.error = error;
    options.start = Start::base;
    options.max_elements = max_elements;
    options.rays = options.gather_rays = 8;
    options.indicators = names;
    if (own) options.indicator = std::make_shared<const Indicator>(own);
    return solve_adaptively(std::make_shared<const Enclosure>(enclosure), options);
}

// A lamp of some size, and a point that casts sharp shadows through the slit.
Enclosure lit_room(double intensity = 10.0) {  // of the point [W/sr]
    Scene scene = test::slit_room();
    scene.lights = {{"point", PointLight{{0.4, 0.6, 1.5}, {intensity}}, ""}};
    return make_enclosure(scene);
}

std::size_t leaves(const Solution& s) {
    return s.report.zones + s.report.patches;
}

bool same_bits(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Affine)) == 0;
}

}  // namespace

TEST_CASE("Without indicators nothing is bisected, and each alone bisects", "[indicators]") {
    const Enclosure enclosure = lit_room();
    const auto none = leaves(solve(enclosure, {}));
    CHECK(leaves(solve(enclosure, {"direct"})) > none);
    // Beside the point it is so bright that its shadows hardly count for the whole.
    CHECK(leaves(solve(lit_room(1000.0), {"shadow_boundary"}, {}, 4000, 1e-4)) > none);
    CHECK(leaves(solve(enclosure, {"indirect"})) > none);
    CHECK(leaves(solve(enclosure, {"jump"})) > none);
}

TEST_CASE("The default indicators are direct, shadow_boundary and indirect", "[indicators]") {
    const Enclosure enclosure = lit_room();
    const auto shared = std::make_shared<const Enclosure>(enclosure);
    SolveOptions options;
    options.error = 0.1;
    options.start = Start::base;
    options.max_elements = 4000;
    options.rays = options.gather_rays = 8;
    const Solution as_ever = solve_adaptively(shared, options);
    const Solution named = solve(enclosure, {"indirect", "shadow_boundary", "direct"});
    CHECK(same_bits(as_ever.direct.zone, named.direct.zone));
    CHECK(same_bits(as_ever.direct.patch, named.direct.patch));
    CHECK(same_bits(as_ever.indirect.zone, named.indirect.zone));
    CHECK(same_bits(as_ever.indirect.patch, named.indirect.patch));
}

TEST_CASE("Refinement ends after max_passes rounds, and says so", "[indicators]") {
    const auto enclosure = std::make_shared<const Enclosure>(lit_room());
    SolveOptions options;
    options.error = 0.01;
    options.start = Start::base;
    options.rays = options.gather_rays = 8;
    options.indicators = {"direct"};  // rounds of direct light alone
    std::vector<std::size_t> counts;
    for (const std::size_t rounds : {0, 1, 2}) {
        options.max_passes = rounds;
        const Solution solution = solve_adaptively(enclosure, options);
        counts.push_back(leaves(solution));
        CHECK(std::any_of(solution.report.warnings.begin(), solution.report.warnings.end(),
                          [&](const std::string& w) {
                              return w.find("max_passes = " + std::to_string(rounds)) != w.npos;
                          }));
    }
    CHECK(counts[0] == leaves(solve(*enclosure, {})));  // the mesh it began with
    CHECK(counts[1] > counts[0]);
    CHECK(counts[2] > counts[1]);
}

TEST_CASE("Indirect light keeps to max_elements as direct light does", "[indicators]") {
    const Enclosure enclosure = lit_room();
    const std::size_t before = leaves(solve(enclosure, {}));
    const std::size_t most = 2 * before;
    for (const char* indicator : {"direct", "indirect"}) {
        INFO(indicator);
        const Solution solution = solve(enclosure, {indicator}, {}, most, 1e-3);
        CHECK(leaves(solution) > before);
        // What a patch's bisection asks of its neighbours is done to the end.
        CHECK(leaves(solution) <= most + 20);
        CHECK(std::any_of(solution.report.warnings.begin(), solution.report.warnings.end(),
                          [](const std::string& w) { return w.find("at a limit") != w.npos; }));
    }
}

TEST_CASE("A caller's indicator bisects where it says", "[indicators]") {
    const Enclosure enclosure = lit_room();
    const double middle = 0.5 * (enclosure.mesh.hull_min.x + enclosure.mesh.hull_max.x);
    const Forest base = solve(enclosure, {}).forest;
    const auto left_only = [middle](const JudgedElement& e) {
        const auto* zone = std::get_if<ZoneId>(&e.node);
        if (!zone) return 0.0;
        for (const auto corner : e.forest[*zone].corners)
            if (e.forest.point(corner).x > middle) return 0.0;
        // Falls with the element, so that the goal can be met [W/m^2/sr].
        return 10.0 * e.forest[*zone].longest_edge;
    };
    const Solution solution = solve(enclosure, {}, left_only);
    CHECK(solution.forest.zone_count() > base.zone_count() + 100);
    std::size_t elsewhere = 0;
    for (std::size_t z = 0; z < base.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!base.is_leaf(zone) || solution.forest.is_leaf(zone)) continue;
        for (const auto corner : base[zone].corners) elsewhere += base.point(corner).x > middle;
    }
    CHECK(elsewhere == 0);
    CHECK(solution.forest.patch_count() == base.patch_count());
}

TEST_CASE("A jump is half of what two leaves differ by, and none where they agree",
          "[indicators]") {
    const Enclosure enclosure = lit_room();
    ElementMesh mesh(enclosure);
    const Forest& forest = mesh.forest();
    Fields radiance;
    radiance.resize(forest, enclosure.bands);
    const ZoneId odd = mesh.zones()[mesh.zones().size() / 2];
    const auto error = [&](ZoneId zone) {
        return jump_error({enclosure, mesh, forest, radiance, zone});
    };
    for (const ZoneId z : mesh.zones()) radiance.at(z, 0) = {{0.3, -0.2, 0.1}, 2.0};
    for (const ZoneId z : mesh.zones()) CHECK(error(z) < 1e-12);  // one function: only rounding
    radiance.at(odd, 0).constant += 1.0;
    CHECK(std::abs(error(odd) - 0.5) < 1e-9);
    std::size_t touched = 0;
    for (const ZoneId z : mesh.zones()) touched += error(z) > 1e-12;
    CHECK(touched >= 2);
    CHECK(touched <= 5);  // itself and what lies across its four faces
}

TEST_CASE("Thick zones are bisected where light changes, thin ones are not", "[indicators]") {
    Scene scene = test::slit_room();
    const auto zones_at = [&](double extinction, const Names& names) {
        for (auto& medium : scene.media) medium.extinction = {extinction};
        return solve(make_enclosure(scene), names, {}, 8000).report.solved_elements;
    };
    CHECK(zones_at(0.05, {"optical_thickness"}) == zones_at(0.05, {}));
    CHECK(zones_at(8.0, {"optical_thickness"}) > zones_at(8.0, {}));
}

TEST_CASE("Thickness: 5 % of the flux at an optical depth of 0.5, 19 % at 1, 3/4 of it beyond",
          "[indicators]") {
    const Enclosure enclosure = lit_room();
    ElementMesh mesh(enclosure);
    Fields radiance;
    radiance.resize(mesh.forest(), 1);
    const ZoneId zone = mesh.zones().front();
    const double h = std::cbrt(mesh.forest().volume(zone));
    radiance.at(zone, 0).gradient = {1.0, 0.0, 0.0};
    const auto of_flux = [&](double depth) {
        Enclosure other = enclosure;
        for (auto& medium : other.media) medium.extinction.assign(1, depth / h);
        return thickness_error({other, mesh, mesh.forest(), radiance, zone}) /
               (4.0 / (3.0 * depth / h));
    };
    // The measured shares have two digits.
    CHECK(std::abs(of_flux(0.5) - 0.05) < 0.005);
    CHECK(std::abs(of_flux(1.0) - 0.19) < 0.005);
    CHECK(std::abs(of_flux(40.0) / 40.0 - 0.75) < 0.001);
}

TEST_CASE("Indicators that there are not, and errors that are none, are refused", "[indicators]") {
    const Enclosure enclosure = lit_room();
    CHECK_THROWS_AS(solve(enclosure, {"directly"}), mesh::InputError);
    CHECK_THROWS_AS(solve(enclosure, {}, [](const JudgedElement&) { return -1.0; }),
                    mesh::InputError);
}
