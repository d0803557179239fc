// tyndall render: parts of pictures, other projections, elements in colours; compare: regions.
#include <nlohmann/json.hpp>

#include "render/image_files.h"
#include "support/catch.h"
#include "support/foggy_box.h"
#include "support/program.h"

using namespace tyndall;

namespace {

// Solved once for all cases.
const test::Workplace& solved_place() {
    static const test::Workplace place("render_flags");
    static const bool solved = [] {
        place.write("box.toml", test::foggy_box);
        place.good("solve box.toml -o out --quiet --set solve.direct_light=rows");
        return true;
    }();
    REQUIRE(solved);
    return place;
}

std::string crop_complaint(const std::string& arguments) {
    const auto outcome = solved_place().run(arguments);
    CHECK(outcome.code == 1);
    return outcome.err;
}

}  // namespace

TEST_CASE("A crop is that part of the picture") {
    const auto& place = solved_place();
    place.good("render out -o whole.pfm --quiet");
    place.good("render out -o part.pfm --quiet --crop 4,2,6,5");
    const auto whole = render::read_image(place.path / "whole.pfm");
    const auto part = render::read_image(place.path / "part.pfm");
    REQUIRE(part.width == 6);
    REQUIRE(part.height == 5);
    // Other places within the pixels: their numbers begin anew.
    double most = 0.0, mean = 0.0;
    for (std::size_t y = 0; y < 5; ++y)
        for (std::size_t x = 0; x < 6; ++x) {
            const double a = whole.layers[0].values[(y + 2) * 16 + x + 4];
            most = std::max(most, std::abs(part.layers[0].values[y * 6 + x] - a));
            mean += a / 30.0;
        }
    CHECK(most < 0.2 * mean);
    CHECK_THAT(crop_complaint("render out -o part.pfm --crop 4,2,60,5"),
               Contains("Give a part of it"));
    CHECK_THAT(crop_complaint("render out -o part.pfm --crop 4,2,6"),
               Contains("--crop") && Contains("left,top,width,height"));
    CHECK_THAT(crop_complaint("render out -o part.pfm --crop 4,2,x,1"), Contains("--crop"));
}

TEST_CASE("Elements in colours say what the colours stand for") {
    const auto& place = solved_place();
    for (const std::string field :
         {"radiance", "direct", "indirect", "incident", "error", "level", "extinction", "albedo"})
        for (const std::string where : {"", " --slice middle", " --slice 1,1,1,0,0,1"}) {
            CAPTURE(field, where);
            const auto json = nlohmann::json::parse(
                place.good("render out -o field.png --json --field " + field + where));
            CHECK(json.at("field") == field);
            CHECK(json.at("low").get<double>() < json.at("high").get<double>());
            CHECK(json.at("width").get<int>() == (where.empty() ? 16 : 960));
        }
    const auto ranged = nlohmann::json::parse(
        place.good("render out -o field.png --json --field radiance --range 0.5,2"));
    CHECK(ranged.at("low") == 0.5);
    CHECK(ranged.at("high") == 2.0);
    CHECK_THAT(crop_complaint("render out -o f.png --field temperature"),
               Contains("has a temperature"));
    CHECK_THAT(crop_complaint("render out -o f.png --field heat"), Contains("radiance, direct"));
    CHECK_THAT(crop_complaint("render out -o f.png --field radiance --range 2,1"),
               Contains("lower end"));
    CHECK_THAT(crop_complaint("render out -o f.png --field radiance --range 0,1"),
               Contains("above 0"));
    CHECK_THAT(crop_complaint("render out -o f.png --slice 1,1,1,0,0,0"), Contains("normal 0,0,0"));
    CHECK_THAT(crop_complaint("render out -o f.png --slice 1,1"), Contains("or middle"));
    CHECK_THAT(crop_complaint("render out -o f.exr --field level"), Contains(".png"));
    CHECK_THAT(crop_complaint("render out -o f.exr --mesh"), Contains(".png"));
    CHECK_FALSE(place.has("f.png"));
    place.good("render out -o mesh.png --mesh --quiet");
    CHECK(place.has("mesh.png"));
}

TEST_CASE("Another camera than that solved for is warned of, other projections are pictures") {
    const auto& place = solved_place();
    CHECK_THAT(place.good("render out -o side.png --camera side"),
               Contains("refined for camera \"main\""));
    const auto json =
        nlohmann::json::parse(place.good("render out -o side.png --camera side --json"));
    CHECK(json.at("warnings").size() == 1);
    CHECK_FALSE(place.good("render out -o main.png").find("warning") != std::string::npos);
    for (const std::string settings :
         {"--set camera.main.projection=panorama --set camera.main.height=8",
          "--set camera.main.projection=orthographic --set camera.main.extent_y=0.3",
          "--set camera.main.lens={diameter=0.1,focus=1.0} --samples 16"}) {
        CAPTURE(settings);
        place.good("render out -o other.pfm --quiet " + settings);
        const auto image = render::read_image(place.path / "other.pfm");
        for (const float value : image.layers[0].values) {
            CHECK(std::isfinite(value));
            CHECK(value > 0.0f);
        }
    }
    for (const std::string tone : {"shoulder", "filmic", "reinhard", "linear"})
        place.good("render out -o tone.png --quiet --tone " + tone);
    CHECK_THAT(crop_complaint("render out -o tone.png --tone flat"), Contains("shoulder, filmic"));
}

TEST_CASE("compare knows regions and MAPE") {
    const auto& place = solved_place();
    render::Image image{4, 2, {{"beauty", 1, {1, 1, 2, 2, 1, 1, 2, 2}}}};
    render::write_image(place.path / "a.pfm", image);
    for (const std::size_t k : {2, 3, 6, 7}) image.layers[0].values[k] = 2.2f;
    render::write_image(place.path / "b.pfm", image);
    const auto compared = [&](const std::string& more) {
        return nlohmann::json::parse(place.good("compare b.pfm a.pfm --json" + more));
    };
    CHECK(compared("").at("mape").get<double>() == Approx(0.05).epsilon(0.01));
    CHECK(compared(" --region 0,0,2,2").at("rmse") == 0.0);
    CHECK(compared(" --region 2,0,2,2").at("rmse").get<double>() == Approx(0.1).epsilon(1e-5));
    CHECK_THAT(crop_complaint("compare b.pfm a.pfm --region 3,0,2,2"),
               Contains("Give a part of it"));
}
