// The same bits at any number of threads.
#include <tbb/global_control.h>

#include <cstring>

#include "radiosity/adaptive.h"
#include "radiosity/exchange_walked.h"
#include "render/line_of_sight.h"
#include "support/catch.h"
#include "support/mirror_scenes.h"
#include "support/path_scenes.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

const SolveOptions small{.error = 0.1, .max_elements = 3000, .rays = 64, .gather_rays = 64};

struct Everything {
    ExchangeAreas areas;
    Solution solution;
    render::Image picture;
};

Everything at_threads(std::size_t threads, const Scene& scene, render::Camera camera) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(scene));
    Everything e;
    const Forest forest(enclosure->mesh);
    const auto elements = elements_of_leaves(*enclosure, forest);
    e.areas =
        all_rows(exchange_walked, {*enclosure, forest, elements}, {.rays = 256, .progress = {}});
    e.solution = solve_adaptively(enclosure, small, camera.view());
    e.picture = render::line_of_sight(e.solution, camera, {.samples = 4});
    return e;
}

bool same_bits(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Affine)) == 0);
}

void check_same(const Scene& scene, mesh::Point eye, mesh::Point target) {
    const auto camera = test::camera_at(eye, target, 1.2, 80, 60);
    const Everything one = at_threads(1, scene, camera), two = at_threads(2, scene, camera);
    CHECK(one.areas.starts == two.areas.starts);
    CHECK(one.areas.columns == two.areas.columns);
    CHECK(one.areas.values == two.areas.values);
    CHECK(one.solution.forest.zone_count() == two.solution.forest.zone_count());
    CHECK(one.solution.forest.patch_count() == two.solution.forest.patch_count());
    CHECK(one.solution.coarse.radiance == two.solution.coarse.radiance);
    CHECK(same_bits(one.solution.direct.zone, two.solution.direct.zone));
    CHECK(same_bits(one.solution.direct.patch, two.solution.direct.patch));
    CHECK(same_bits(one.solution.indirect.zone, two.solution.indirect.zone));
    CHECK(same_bits(one.solution.indirect.patch, two.solution.indirect.patch));
    REQUIRE(one.picture.layers.size() == two.picture.layers.size());
    for (std::size_t l = 0; l < one.picture.layers.size(); ++l) {
        INFO(one.picture.layers[l].name);
        CHECK(one.picture.layers[l].values == two.picture.layers[l].values);
    }
}

}  // namespace

TEST_CASE("Smoothed rows have the same bits at one thread and at two", "[threads][smoothing]") {
    const Enclosure enclosure = make_enclosure(test::slit_room());
    const Forest forest(enclosure.mesh);
    const auto elements = elements_of_leaves(enclosure, forest);
    const auto rows = [&](std::size_t threads, Smoothing smoothing) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return all_rows(exchange_walked, {enclosure, forest, elements},
                        {.rays = 64, .settings = {.smoothing = smoothing}, .progress = {}});
    };
    for (const auto smoothing : {Smoothing::least_squares, Smoothing::scaling}) {
        const ExchangeAreas one = rows(1, smoothing), two = rows(2, smoothing);
        CHECK(one.columns == two.columns);
        CHECK(one.values == two.values);
        CHECK(one.remainders == two.remainders);
        CHECK(one.smoothing->moved_mean == two.smoothing->moved_mean);
    }
}

TEST_CASE("Rows, fields and picture have the same bits at one thread and at two",
          "[threads][long]") {
    check_same(test::slit_room(), {2.8, 1.9, 1.0}, {0.5, 0.8, 1.0});
}

TEST_CASE("So they have where mirrors are, and lights in them", "[threads][long]") {
    Scene scene = test::mirrored_box(false);
    scene.lights = {{"bulb", PointLight{{0.3, 0.7, 0.6}, {2.0}}, ""}};
    check_same(scene, {0.1, 0.1, 0.5}, {1.0, 0.7, 0.4});
}
