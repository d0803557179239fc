#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "mesh/input_error.h"
#include "render/camera.h"
#include "support/catch.h"

namespace {

using namespace tyndall;

constexpr double degree = std::numbers::pi / 180.0;

// The camera of the room with six windows; computed for this project, see docs/validation.
render::Camera window_shafts_camera() {
    render::Camera camera;
    camera.eye = {4.7, 0.3, 1.7};
    camera.target = {1.2, 2.5, 1.15};
    camera.fov_x = 75.0 * degree;
    camera.width = 320;
    camera.height = 240;
    return camera;
}

// Where the ray through a point of the picture meets the wall x = 0.
mesh::Point on_window_wall(const render::Camera& camera, double x, double y) {
    const auto ray = camera.ray(x, y);
    return ray.origin + (-ray.origin.x / ray.direction.x) * ray.direction;
}

}  // namespace

TEST_CASE("the middle of the picture is the target") {
    auto camera = window_shafts_camera();
    const auto ray = camera.ray(160.0, 120.0);
    const auto expected = glm::normalize(camera.target - camera.eye);
    CHECK(glm::length(ray.direction - expected) < 1e-15);  // rounding of one normalisation
    CHECK(glm::length(ray.direction) == Approx(1.0).epsilon(1e-15));
    CHECK(ray.origin == camera.eye);
    CHECK(ray.length == std::numeric_limits<double>::infinity());
}

TEST_CASE("x goes to the viewer's right and y down") {
    render::Camera camera;
    camera.target = {0, 1, 0};  // looks along y; x is to the right, z up
    camera.fov_x = 90.0 * degree;
    camera.width = 200;
    camera.height = 100;
    const auto corner = camera.ray(200.0, 0.0).direction;
    // tan 45° to the right, half as much up: pixels are square.
    CHECK(corner.x / corner.y == Approx(1.0));
    CHECK(corner.z / corner.y == Approx(0.5));
    CHECK(camera.ray(0.0, 100.0).direction.x < 0.0);
    CHECK(camera.ray(0.0, 100.0).direction.z < 0.0);
}

TEST_CASE("fov_x and fov_y describe the same camera") {
    render::Camera by_x;
    by_x.target = {1, 2, -0.5};
    by_x.fov_x = 75.0 * degree;
    auto by_y = by_x;
    by_y.fov_x.reset();
    by_y.fov_y = 2.0 * std::atan(std::tan(37.5 * degree) * 480.0 / 640.0);
    CHECK(glm::length(by_x.ray(17.5, 401.5).direction - by_y.ray(17.5, 401.5).direction) < 1e-14);
}

TEST_CASE("the windows are where the reference picture shows them") {
    const auto camera = window_shafts_camera();
    // Edges read off the reference picture, to half a pixel; a pixel there is at most 2.5 cm on the
    // wall.
    const double half_pixel = 0.0125;
    const auto top = on_window_wall(camera, 80.5, 65.9);  // upper edge of the upper left window
    CHECK(top.z == Approx(2.25).margin(half_pixel));
    CHECK(top.y > 1.0);
    CHECK(top.y < 1.5);
    const auto second = on_window_wall(camera, 103.0, 80.5);  // left edge of the second window
    CHECK(second.y == Approx(1.75).margin(half_pixel));
    const auto third = on_window_wall(camera, 134.0, 80.5);  // left edge of the third window
    CHECK(third.y == Approx(2.5).margin(half_pixel));
}

TEST_CASE("the view is the frame of the rays") {
    const auto camera = window_shafts_camera();
    const auto view = camera.view();
    CHECK(glm::dot(view.forward, view.right) == Approx(0.0).margin(1e-15));
    CHECK(glm::dot(view.forward, view.up) == Approx(0.0).margin(1e-15));
    CHECK(glm::length(glm::cross(view.right, view.forward) - view.up) < 1e-15);
    const auto corner = camera.ray(320.0, 240.0).direction;
    CHECK(glm::dot(corner, view.right) / glm::dot(corner, view.forward) == Approx(view.half_x));
    CHECK(glm::dot(corner, view.up) / glm::dot(corner, view.forward) == Approx(-view.half_y));
    CHECK(view.half_y == Approx(0.75 * view.half_x));
}

TEST_CASE("a camera that cannot be is refused with its name") {
    auto camera = window_shafts_camera();
    camera.name = "porch";
    const auto refused = [&](const char* why) {
        CHECK_THROWS_WITH(camera.ray(0, 0), Contains("porch") && Contains(why));
        CHECK_THROWS_AS(camera.view(), mesh::InputError);
    };
    SECTION("eye on target") {
        camera.target = camera.eye;
        refused("coincide");
    }
    SECTION("up along the view") {
        camera.up = 3.0 * (camera.target - camera.eye);
        refused("parallel");
    }
    SECTION("no up") {
        camera.up = {0, 0, 0};
        refused("zero or parallel");
    }
    SECTION("two angles") {
        camera.fov_y = 1.0;
        refused("both");
    }
    SECTION("no angle") {
        camera.fov_x.reset();
        refused("none");
    }
    SECTION("half turn") {
        camera.fov_x = 180.0 * degree;
        refused("180");
    }
    SECTION("not a number") {
        camera.eye.y = std::nan("");
        refused("finite");
    }
    SECTION("no pixels") {
        camera.height = 0;
        refused("empty");
    }
}

TEST_CASE("An orthographic camera's rays are parallel, a length apart") {
    render::Camera camera;
    camera.projection = radiosity::PictureProjection::orthographic;
    camera.eye = {1, 2, 3};
    camera.target = {1, 5, 3};  // looks along y; x is to the right, z up
    camera.extent_y = 4.0;
    camera.width = 300;
    camera.height = 200;
    const auto corner = camera.ray(300.0, 0.0), middle = camera.ray(150.0, 100.0);
    CHECK(middle.origin == camera.eye);
    CHECK(glm::length(corner.origin - mesh::Point(1 + 3, 2, 3 + 2)) < 1e-12);
    CHECK(glm::length(corner.direction - mesh::Direction(0, 1, 0)) < 1e-15);
    // Areas: of the picture, of what a square metre covers of it.
    const auto view = camera.view();
    CHECK(view.extent() == Approx(6.0 * 4.0));
    CHECK(view.covered({1, 50, 3}, 1.0, 0.1) == 1.0);
    CHECK(view.sees({3.9, 50, 3}, 0.0));
    CHECK_FALSE(view.sees({4.1, 50, 3}, 0.05));
    CHECK_FALSE(view.sees({1, -50, 3}, 1.0));
}

TEST_CASE("A panorama shows all around, level wherever its middle is") {
    render::Camera camera;
    camera.projection = radiosity::PictureProjection::panorama;
    camera.target = {0, 1, -0.7};  // its middle is level all the same
    camera.width = 400;
    camera.height = 200;
    const auto towards = [&](double x, double y) { return camera.ray(x, y).direction; };
    CHECK(glm::length(towards(200, 100) - mesh::Direction(0, 1, 0)) < 1e-12);
    CHECK(glm::length(towards(300, 100) - mesh::Direction(1, 0, 0)) < 1e-12);  // to the right
    CHECK(glm::length(towards(0, 100) - mesh::Direction(0, -1, 0)) < 1e-12);   // behind
    CHECK(glm::length(towards(123, 0) - mesh::Direction(0, 0, 1)) < 1e-12);    // the zenith
    CHECK(glm::length(towards(200, 150) - mesh::Direction(0, 1, -1) / std::sqrt(2.0)) < 1e-12);
    CHECK(camera.view().extent() == Approx(4.0 * std::numbers::pi));
    CHECK(camera.view().sees({0, -5, 0}, 0.0));
    camera.height = 150;
    CHECK_THROWS_WITH(camera.view(), Contains("twice as wide as high"));
}

TEST_CASE("Through a lens all rays of a point of the sharp plane meet there") {
    auto camera = window_shafts_camera();
    camera.lens = render::Lens{0.2, 3.0};
    const render::CameraRays rays(camera);
    const auto pinhole = rays(40.0, 200.0);
    const auto forward = camera.view().forward;
    const mesh::Point sharp =
        pinhole.origin + 3.0 / glm::dot(pinhole.direction, forward) * pinhole.direction;
    CHECK(pinhole.origin == camera.eye);
    mesh::Point mean(0.0);
    constexpr int across = 40;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < across; ++j) {
            const auto ray = rays(40.0, 200.0, {(i + 0.5) / across, (j + 0.5) / across});
            const auto off = ray.origin - camera.eye;
            CHECK(glm::length(off) <= 0.1);
            CHECK(std::abs(glm::dot(off, forward)) < 1e-12);
            const double t = glm::dot(sharp - ray.origin, ray.direction);
            CHECK(glm::length(ray.origin + t * ray.direction - sharp) < 1e-12);
            mean += off / double(across * across);
        }
    CHECK(glm::length(mean) < 1e-12);  // places are even about the middle
    camera.lens->focus = 0.0;
    CHECK_THROWS_WITH(camera.view(), Contains("focus above 0"));
    camera.lens->focus = 1.0;
    camera.projection = radiosity::PictureProjection::panorama;
    CHECK_THROWS_WITH(camera.view(), Contains("only a perspective picture"));
}

TEST_CASE("A cropped camera's pixels are those of the whole picture") {
    const auto camera = window_shafts_camera();
    const auto part = camera.cropped(100, 50, 64, 48);
    CHECK(part.width == 64);
    CHECK(part.ray(3.5, 7.5).direction == camera.ray(103.5, 57.5).direction);
    CHECK(part.cropped(10, 10, 5, 5).ray(0.5, 0.5).direction == camera.ray(110.5, 60.5).direction);
    // It is solved for the whole.
    CHECK(part.view().half_x == camera.view().half_x);
    CHECK_THROWS_WITH(camera.cropped(300, 0, 21, 10), Contains("Give a part of it"));
    CHECK_THROWS_WITH(camera.cropped(0, 240, 1, 1), Contains("Give a part of it"));
    CHECK_THROWS_WITH(camera.cropped(0, 0, 0, 1), Contains("Give a part of it"));
}
