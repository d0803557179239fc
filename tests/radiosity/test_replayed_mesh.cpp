// A solve of a mesh as it was kept, of which nothing is bisected.
#include "radiosity/adaptive.h"
#include "support/catch.h"
#include "support/rooms.h"
#include "support/solution_difference.h"

using namespace tyndall;
using namespace tyndall::radiosity;

// Light that a sunbeam's spot throws back bends over the first elements: it is gathered wherever it
// was, not at these alone.
TEST_CASE("A mesh taken as it is gives the solution that it was made for", "[replay]") {
    Scene scene;
    scene.materials = {test::material(0.7), test::material(0.0)};
    scene.materials[0].back = 1;
    for (const auto& face : mesh::room({0, 0, 0}, {4, 3, 3}, {{"x0", {"window", {1, 1}, {1, 1}}}}))
        test::add_surfaces(scene, "room", {face},
                           face.name == "window" ? std::optional<std::size_t>() : 0);
    scene.media = {test::medium(0.2, 0.9, Point(3.0, 1.4, 0.5))};
    scene.lights = {{"sun", Sun{{0.8, 0.1, -0.4}, {100.0}, 0.0}}};
    SolveOptions options;
    options.error = 0.03;
    options.rays = 256;
    options.gather_rays = 256;
    options.element_size = 0.8;
    const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(scene));
    const Solution made = solve_adaptively(enclosure, options);
    Passes passes;
    passes.begin_with =
        std::make_shared<const KeptMesh>(KeptMesh{enclosure->mesh, Forest(made.forest)});
    passes.frozen = true;
    const Solution again = solve_adaptively(enclosure, options, {}, {}, passes);
    CHECK(again.report.patches == made.report.patches);
    CHECK(again.report.zones == made.report.zones);
    const double difference = test::relative_difference(again, made);
    CAPTURE(difference);
    // Found: 0.0015, and 0.014 with indirect light of the first elements alone.
    CHECK(difference < 0.005);
}
