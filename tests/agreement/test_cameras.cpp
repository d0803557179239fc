// Whatever a camera looks at, no renderer shows what is no radiance.
#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "render/renderers.h"
#include "support/catch.h"
#include "support/path_scenes.h"

using namespace tyndall;

namespace {

// Fog in an open box under a dim sky: a wall is missing, a solid block and a lamp are in it, the
// sun shines in.
const radiosity::Solution& open_box(double asymmetry = 0.0) {
    const auto solved = [](double g) {
        radiosity::Scene scene;
        scene.materials = {test::material(0.6), test::material(0.0, 10.0)};
        std::vector<mesh::Face> walls = mesh::room({0, 0, 0}, {3, 2, 2});
        std::erase_if(walls, [](const mesh::Face& face) { return face.name == "x1"; });
        test::add_surfaces(scene, "room", walls, 0);
        test::add_surfaces(scene, "lamp", mesh::rectangle({0.5, 0.7, 2}, {0, 0.6, 0}, {0.6, 0, 0}),
                           1);
        test::add_surfaces(scene, "block", mesh::box({1.6, 0.6, 0}, {2.4, 1.4, 0.7}), 0);
        scene.media = {test::medium(0.3, 0.9)};
        scene.media[0].asymmetry = g;
        scene.lights = {{"sun", radiosity::Sun{{-1, 0.2, -0.5}, {2.0}, 0.01}, ""}};
        scene.environment = {0.05};
        return radiosity::solve_adaptively(
            test::enclosed(scene),
            {.error = 0.3, .max_elements = 1500, .rays = 16, .gather_rays = 16});
    };
    if (asymmetry != 0.0) {
        static const radiosity::Solution forward = solved(asymmetry);
        return forward;
    }
    static const radiosity::Solution even = solved(0.0);
    return even;
}

render::Camera small_camera(mesh::Point eye, mesh::Point target) {
    return test::camera_at(eye, target, 1.2, 12, 9);
}

// Checks that no layer has a value that cannot be.
void check_radiances(const render::Image& image) {
    for (const auto& layer : image.layers) {
        INFO(layer.name);
        CHECK(std::ranges::none_of(layer.values, [&](float v) {
            return !(v >= 0.0f) || (layer.name != "depth" && !std::isfinite(v));
        }));
    }
}

}  // namespace

TEST_CASE("No picture has what is no radiance, wherever the camera stands", "[picture][long]") {
    const std::pair<const char*, render::Camera> cameras[]{
        {"inside", small_camera({0.3, 0.3, 1.0}, {2.0, 1.0, 0.4})},
        {"on a wall", small_camera({0.0, 1.0, 1.0}, {3.0, 1.0, 0.5})},
        {"in a corner", small_camera({0.0, 0.0, 0.0}, {3.0, 2.0, 2.0})},
        {"along a wall", small_camera({0.0, 0.0, 1.0}, {3.0, 0.0, 1.0})},
        {"on the lamp", small_camera({0.8, 1.0, 2.0}, {2.0, 1.0, 0.7})},
        {"on the opening's edge", small_camera({3.0, 0.0, 0.0}, {0.0, 1.0, 1.0})},
        {"outside, in front of the opening", small_camera({6.0, 1.0, 1.0}, {0.0, 1.0, 1.0})},
        {"outside, behind a wall", small_camera({-3.0, 1.0, 1.0}, {0.0, 1.0, 1.0})},
        {"outside, looking away", small_camera({6.0, 1.0, 1.0}, {9.0, 1.0, 1.0})},
        {"a kilometre away", small_camera({1000.0, 1.0, 1.0}, {0.0, 1.0, 1.0})},
    };
    for (const auto& renderer : render::renderers())
        for (const auto& [where, camera] : cameras) {
            INFO(renderer.name << ", " << where);
            const auto image =
                renderer.render(open_box(), camera, {.samples = 4}, radiosity::ProgressCallback());
            check_radiances(image);
            if (std::string_view(where) == "outside, looking away")
                for (const float v : image.find("beauty")->values)
                    CHECK(v == Approx(0.05));  // the sky
            if (std::string_view(where) == "inside") CHECK(test::over(image, "beauty").mean > 0.01);
        }
}

TEST_CASE("Fog that scatters forwards has no radiance below 0", "[picture][long]") {
    const auto camera = small_camera({0.3, 0.3, 1.0}, {2.0, 1.0, 0.4});
    for (const auto& renderer : render::renderers()) {
        INFO(renderer.name);
        check_radiances(
            renderer.render(open_box(0.5), camera, {.samples = 4}, radiosity::ProgressCallback()));
    }
}

TEST_CASE("An eye in a solid is refused by every renderer", "[picture]") {
    const auto camera = small_camera({2.0, 1.0, 0.3}, {0.0, 0.0, 1.0});
    for (const auto& renderer : render::renderers()) {
        INFO(renderer.name);
        CHECK_THROWS_AS(
            renderer.render(open_box(), camera, {.samples = 1}, radiosity::ProgressCallback()),
            mesh::InputError);
    }
}
