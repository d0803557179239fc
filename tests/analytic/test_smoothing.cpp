// After smoothing, furnace, closure and reciprocity hold together, all to 1e-10.
#include <cmath>

#include "cli/scene_file.h"
#include "radiosity/adaptive.h"
#include "radiosity/exchange_table.h"
#include "support/box_mesh.h"
#include "support/catch.h"
#include "support/furnace.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

constexpr Smoothing methods[]{Smoothing::least_squares, Smoothing::scaling};

// Few elements and rays: what is tested is exact at any number. 1/(1 − a) makes up to a hundred
// times of the residual.
SolveOptions coarse(Smoothing method) {
    SolveOptions options{.start = Start::base,
                         .refinement = Refinement::none,
                         .direct_light = DirectLightMode::rows,
                         .rays = 64,
                         .gather_rays = 16,
                         .solver_tolerance = 1e-13};
    options.exchange_settings.smoothing = method;
    return options;
}

Enclosure scene(const std::string& name) {
    return make_enclosure(
        cli::read_scene_file(TYNDALL_SOURCE_DIR "/examples/scenes/" + name + ".toml").scene);
}

// Two rooms with media of 0.3 and 3 per metre and an opening in the hull above the first. Between
// them a wall as high as half the room, and an interface above.
Enclosure two_media() {
    auto e = test::box_enclosure({{{0, 0.5, 1, 1.5, 2}, {0, 0.5, 1}, {0, 0.5, 1}}},
                                 [](mesh::Point c, int axis) -> std::optional<test::Face> {
                                     const mesh::Point end(2, 1, 1);
                                     if (axis == 2 && c.z == 1.0 && c.x < 0.5)
                                         return std::nullopt;  // open
                                     if (axis == 0 && c.x == 1.0 && c.z < 0.5)
                                         return test::Face{mesh::Opacity::opaque, 1, 2};
                                     if (axis == 0 && c.x == 1.0)
                                         return test::Face{mesh::Opacity::interface};
                                     if (c[axis] == 0.0)
                                         return test::Face{mesh::Opacity::opaque, 0, none};
                                     if (c[axis] == end[axis])
                                         return test::Face{mesh::Opacity::opaque, none, 0};
                                     return std::nullopt;
                                 });
    e.open = true;
    e.sides = {{"walls", 0, mesh::Side::front, {0.6}, {0.1}, 9.5},
               {"partition+", 1, mesh::Side::front, {0.2}, {2.0}, 0.5},
               {"partition-", 1, mesh::Side::back, {0.8}, {0.0}, 0.5}};
    e.media = {{"haze", {0.3}, {0.9}, {0.5}, {0.03}}, {"smoke", {3.0}, {0.5}, {0.0}, {1.5}}};
    REQUIRE(e.mesh.region_count == 2);
    for (std::uint32_t m = 0; m < 2; ++m) {
        const auto tet = test::tet_at(e.mesh, {0.3 + m, 0.3, 0.3});
        e.region_medium[e.mesh.regions[tet.value].value] = m;
    }
    return e;
}

void check_furnace(const std::string& name, Enclosure enclosure) {
    test::make_furnace(enclosure);
    const auto furnace = std::make_shared<const Enclosure>(std::move(enclosure));
    for (const auto method : methods) {
        const Solution solution = solve_adaptively(furnace, coarse(method));
        const Report& report = solution.report;
        REQUIRE(report.smoothing);
        const SmoothingReport& s = *report.smoothing;
        INFO(name << ", " << (method == Smoothing::scaling ? "scaling" : "least squares") << ": "
                  << report.solved_elements << " elements, reciprocity was off by "
                  << s.raw_reciprocity_error << ", rows moved by " << s.moved_mean << " to "
                  << s.moved_max << ", " << s.clamped << " entries at 0, " << s.iterations
                  << " passes; closure " << report.closure_error << ", x off by "
                  << test::largest_departure(solution.coarse.radiance));
        CHECK(s.converged);
        CHECK(test::largest_departure(solution.coarse.radiance) < 1e-10);
        CHECK(test::largest_departure(solution.coarse.incident) < 1e-10);
        CHECK(report.closure_error < 1e-10);
        CHECK(report.reciprocity_error < 1e-10);
        // What was there to mend: 64 rays a row leave S_ij and S_ji of base elements far apart, and
        // none of it is hidden.
        CHECK(s.raw_reciprocity_error > 0.01);
        CHECK(s.moved_max >= s.moved_mean);
        CHECK(s.moved_mean > 0.2 * s.raw_reciprocity_error);
    }
}

}  // namespace

TEST_CASE("Smoothed: furnace, closure and reciprocity", "[smoothing][furnace][long]") {
    // The columns stand in the light's way; the louvres are an occluder of many facets.
    for (const std::string name :
         {"cornell_fog", "sharp_sun", "slit_room", "sun_louvres", "window_shafts", "columns_obj"})
        check_furnace(name, scene(name));
    check_furnace("two media, a partition and an opening", two_media());
}

TEST_CASE("Smoothed rows balance energy", "[smoothing]") {
    // Reciprocity and closure are all that (27) needs, where elements hold constants: what is left
    // is the solver's residual.
    const auto enclosure = std::make_shared<const Enclosure>(two_media());
    auto options = coarse(Smoothing::none);
    options.radiance = Radiance::constant;
    const double raw = std::abs(solve_adaptively(enclosure, options).report.energy_balance);
    for (const auto method : methods) {
        options.exchange_settings.smoothing = method;
        const double smoothed =
            std::abs(solve_adaptively(enclosure, options).report.energy_balance);
        INFO(raw << " raw, " << smoothed << " smoothed");
        CHECK(raw > 1e-4);
        CHECK(smoothed < 1e-10);
    }
}

TEST_CASE("Smoothed tables are of all pairs, whichever are asked for", "[smoothing]") {
    const Enclosure enclosure = two_media();
    ExchangeOptions options{.rays = 256};
    for (const auto method : methods) {
        options.settings.smoothing = method;
        const auto names = exchange_names(enclosure);
        const auto table = [&](const std::vector<std::string>& from,
                               const std::vector<std::string>& to) {
            return exchange_table(enclosure, exchange_method("walked"), options, from, to);
        };
        const ExchangeTable all = table(names, names);
        REQUIRE(all.smoothing);
        INFO("raw: closure " << all.smoothing->raw_closure_error << ", reciprocity "
                             << all.smoothing->raw_reciprocity_error << "; smoothed: "
                             << all.closure_error << ", " << all.reciprocity_error);
        CHECK(all.smoothing->raw_reciprocity_error > 1e-3);
        CHECK(all.closure_error < 1e-12);
        CHECK(all.reciprocity_error < 1e-14);
        const ExchangeTable some = table({"haze", "outside"}, {"walls", "haze"});
        REQUIRE(some.entries.size() == 4);
        CHECK(some.closure_error == all.closure_error);
        CHECK(some.reciprocity_error == all.reciprocity_error);
        for (const auto& entry : some.entries) {
            const auto same =
                std::find_if(all.entries.begin(), all.entries.end(), [&](const auto& other) {
                    return other.from == entry.from && other.to == entry.to;
                });
            REQUIRE(same != all.entries.end());
            CHECK(entry.exchange_area == same->exchange_area);
            CHECK(entry.exchange_area[0] > 0.0);
        }
    }
}
