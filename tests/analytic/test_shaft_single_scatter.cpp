// Light-shaft box: single-scattered source radiance and direct floor irradiance, exact visibility.
// Figures computed for this project, see docs/validation.
#include <fstream>
#include <nlohmann/json.hpp>

#include "radiosity/direct_light.h"
#include "support/box_mesh.h"
#include "support/catch.h"

using namespace tyndall;

namespace {

bool between(double v, double low, double high) {
    return v > low && v < high;
}

// Unit box, partition at z = 0.7 with a slit, a 4 cm emitter in the ceiling that looks down.
radiosity::Enclosure shaft_box(const nlohmann::json& p) {
    enum : std::uint32_t { wall, lamp };
    const auto face = [&](mesh::Point c, int axis) -> std::optional<test::Face> {
        const bool above_slit = between(c.x, 0.42, 0.58) && between(c.y, 0.38, 0.62);
        const bool in_lamp = between(c.x, 0.48, 0.52) && between(c.y, 0.48, 0.52);
        if (axis == 2 && c.z == 1.0)
            return test::Face{mesh::Opacity::opaque, radiosity::none, in_lamp ? lamp : wall};
        if (axis == 2 && c.z == 0.7 && !above_slit)
            return test::Face{mesh::Opacity::opaque, wall, wall};
        if (c[axis] == 0.0) return test::Face{mesh::Opacity::opaque, wall, radiosity::none};
        if (c[axis] == 1.0) return test::Face{mesh::Opacity::opaque, radiosity::none, wall};
        return std::nullopt;
    };
    auto enclosure = test::box_enclosure(
        {{{0, 0.42, 0.48, 0.52, 0.58, 1}, {0, 0.38, 0.48, 0.52, 0.62, 1}, {0, 0.35, 0.7, 1}}},
        face);
    enclosure.sides = {{"wall", 0, mesh::Side::front, {p["rho"]}, {0.0}, 0.0},
                       {"lamp", 1, mesh::Side::front, {0.0}, {p["Le"]}, 0.04 * 0.04}};
    const double kappa = p["kappa"], omega = p["omega"];
    enclosure.media = {{"haze", {kappa}, {omega}, {0.0}, {kappa * (1.0 - omega)}}};
    enclosure.region_medium.assign(enclosure.mesh.region_count, 0);
    return enclosure;
}

}  // namespace

TEST_CASE("Shaft box: J1 and floor irradiance against exact visibility", "[direct_light]") {
    const auto file = nlohmann::json::parse(
        std::ifstream(TYNDALL_SOURCE_DIR "/tests/reference/4g_shaft_single_scatter.json"));
    const auto& parameters = file["scene_parameters"];
    const auto enclosure = shaft_box(parameters);
    REQUIRE(enclosure.mesh.region_count == 1);
    const radiosity::DirectLight light(enclosure);
    const double omega = parameters["omega"];
    for (const auto& c : file["cases"]) {
        const std::string name = c["name"];
        const auto& at = c["geometry"]["point"];
        const mesh::Point x(at[0], at[1], at[2]);
        double incident = -1.0, value = c["value"];
        if (name.find("J1") != std::string::npos) {
            light.at_zone(x, test::tet_at(enclosure.mesh, x), {&incident, 1});
            incident *= omega;
        } else {
            light.at_patch(x, {0, 0, 1}, test::tet_at(enclosure.mesh, x), {&incident, 1});
        }
        INFO(name << " at " << x.x << " " << x.y << " " << x.z);
        // Visibility and solid angles are exact to rounding; 1e-6 is left for the cubature of the
        // transmittance (degree 2 where the optical depth varies by less than 0.01). Points at
        // which the shadow's edge meets the emitter's corner round to parts of 1e-15.
        CHECK(incident == Approx(value).epsilon(1e-6).margin(1e-13));
    }
}
