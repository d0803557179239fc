// Light does not leak through a thin wall that closes a room in two, whatever the level of detail.
#include <memory>

#include "radiosity/adaptive.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A 4 × 2 × 2 m room in haze. At x = 2 a wall without thickness, or a box of 1 mm, closes it in
// two; a lamp lights the left half.
Scene divided(bool box) {
    Scene scene;
    scene.materials = {test::material(0.7), test::material(0.0, 10.0)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {4, 2, 2}), 0);
    if (box)
        test::add_surfaces(scene, "wall", mesh::box({1.9995, 0, 0}, {2.0005, 2, 2}), 0);
    else
        test::add_surfaces(scene, "wall", mesh::rectangle({2, 0, 0}, {0, 2, 0}, {0, 0, 2}), 0);
    test::add_surfaces(scene, "lamp", mesh::rectangle({0.5, 0.8, 1.9}, {0, 0.4, 0}, {0.4, 0, 0}),
                       1);
    scene.media = {test::medium(0.4, 0.9)};
    return scene;
}

struct Mean {
    double lit = 0.0, dark = 0.0;
};

// Mean of the leaves' radiance on either side; of the coarse elements too, where they lie on one.
Mean means(const Solution& s) {
    Mean sum;
    std::size_t lit = 0, dark = 0;
    const auto add = [&](auto node) {
        const Point x = s.forest.centroid(node);
        const double radiance =
            emission_of(s, node, 0) +
            scatter_of(s, node, 0) * (s.direct.at(node, 0).at(x) + s.indirect.at(node, 0).at(x));
        (x.x < 2.0 ? sum.lit : sum.dark) += std::abs(radiance);
        ++(x.x < 2.0 ? lit : dark);
    };
    for (std::size_t z = 0; z < s.forest.zone_count(); ++z)
        if (s.forest.is_leaf(ZoneId(z)) && medium_of(*s.enclosure, s.forest, ZoneId(z)) != none)
            add(ZoneId(z));
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p)
        if (s.forest.is_leaf(PatchId(p)) && side_of(*s.enclosure, s.forest, PatchId(p)) != none)
            // A side of the partition belongs to the half that it faces.
            if (const Point c = s.forest.centroid(PatchId(p)); std::abs(c.x - 2.0) > 0.01)
                add(PatchId(p));
    REQUIRE(lit > 0);
    REQUIRE(dark > 0);
    return {sum.lit / double(lit), sum.dark / double(dark)};
}

}  // namespace

TEST_CASE("A 1 mm partition lit on one side stays dark on the other", "[leak][long]") {
    for (const bool box : {false, true}) {
        const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(divided(box)));
        for (const Start start : {Start::single_zone, Start::base})
            for (const double detail : {0.0, 2.0})
                for (const Refinement refinement : {Refinement::none, Refinement::adaptive}) {
                    const auto solution = solve_adaptively(enclosure, {.error = 0.1,
                                                                       .start = start,
                                                                       .refinement = refinement,
                                                                       .max_elements = 4000,
                                                                       .rays = 64,
                                                                       .row_detail = detail,
                                                                       .gather_rays = 32});
                    const Mean mean = means(solution);
                    INFO("box " << box << ", start " << int(start) << ", detail " << detail
                                << ", refinement " << int(refinement) << ": " << mean.lit << " "
                                << mean.dark);
                    CHECK(mean.lit > 0.01);
                    CHECK(mean.dark <= 1e-6 * mean.lit);
                }
    }
}
