// Spectra that a program gives: one value for all bands, one a band, or a message.
#include "radiosity/scene_bands.h"

#include <limits>

#include "mesh/input_error.h"
#include "radiosity/enclosure.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

Scene coloured() {
    Scene scene;
    scene.bands = 3;
    scene.materials = {test::material(0.5)};
    scene.materials[0].name = "plaster";
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
    scene.media = {test::medium(1.0, 0.5)};
    scene.media[0].name = "fog";
    scene.lights = {{"bulb", PointLight{{0.5, 0.5, 0.5}, {2.0}}, "room.toml:7:1"}};
    return scene;
}

}  // namespace

TEST_CASE("One value holds for all bands") {
    const Enclosure enclosure = make_enclosure(coloured());
    CHECK(enclosure.sides[0].reflectance == std::vector<double>{0.5, 0.5, 0.5});
    CHECK(enclosure.media[0].extinction == std::vector<double>{1.0, 1.0, 1.0});
    const Scene scene = with_all_bands(coloured());
    CHECK(std::get<PointLight>(scene.lights[0].source).intensity == Spectrum{2.0, 2.0, 2.0});
    CHECK(scene.environment.empty());  // what was not given stays so
}

TEST_CASE("A flux of all bands together stays one value where bands have wavelengths") {
    Scene scene = coloured();
    scene.spectral.band_edges = {0.0, 1e-6, 4e-6, 1.0};
    scene.materials[0].flux = {10.0};
    CHECK(with_all_bands(scene).materials[0].flux == Spectrum{10.0});
    scene.spectral = {};
    CHECK(with_all_bands(scene).materials[0].flux == Spectrum{10.0, 10.0, 10.0});
}

TEST_CASE("Spectra that are missing, too many or not finite are refused by name") {
    Scene scene = coloured();
    scene.media[0].albedo = {};
    CHECK_THROWS_WITH(make_enclosure(scene),
                      Contains("\"fog\" has 0 values of albedo for 3 bands"));
    scene = coloured();
    scene.materials[0].reflectance = {0.1, 0.2};
    CHECK_THROWS_WITH(make_enclosure(scene), Contains("\"plaster\" has 2 values of reflectance"));
    scene = coloured();
    std::get<PointLight>(scene.lights[0].source).intensity = {
        1.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
    CHECK_THROWS_WITH(make_enclosure(scene),
                      Contains("room.toml:7:1: light \"bulb\"") && Contains("not finite"));
}
