// Rows of exchange areas whose rays go on at mirrors.
#include <algorithm>
#include <cmath>

#include "radiosity/adaptive.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/exchange_walked.h"
#include "radiosity/gather.h"
#include "support/catch.h"
#include "support/crowded_cube.h"
#include "support/mirror_scenes.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

struct MirroredRows {
    Enclosure enclosure;
    Forest forest;
    Elements elements;

    explicit MirroredRows(const Scene& scene)
        : enclosure(make_enclosure(scene)),
          forest(enclosure.mesh),
          elements((test::bisect_some(forest, 60), elements_of_leaves(enclosure, forest))) {}
    ExchangeAreas made(std::size_t rays, RowLegs legs = RowLegs::all,
                       Radiance radiance = Radiance::constant) const {
        return all_rows(exchange_walked, {enclosure, forest, elements},
                        {.rays = rays, .radiance = radiance, .progress = {}, .legs = legs});
    }
};

Scene mirror_room(double specular, double extinction) {
    Scene scene;
    scene.materials = {test::material(0.5), test::mirror(specular), test::mirror(0.5, 0.2)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
    scene.surfaces[test::surface_named(scene, "room.x1")].material = 1;
    scene.surfaces[test::surface_named(scene, "room.x0")].material = 1;
    scene.surfaces[test::surface_named(scene, "room.floor")].material = 2;
    if (extinction > 0.0) scene.media = {test::medium(extinction, 0.9)};
    return scene;
}

}  // namespace

TEST_CASE("Rows with mirrors close, and become reciprocal with the rays", "[exchange]") {
    const double specular = GENERATE(0.8, 1.0);
    const MirroredRows rows(mirror_room(specular, 0.4));
    const auto few = rows.made(64), many = rows.made(1024);
    CAPTURE(specular);
    // What rays keep at the end is spread like the rest of the row: they close as others do, to
    // the rounding of the last entry.
    CHECK(closure_error(few, rows.elements, 0) < 1e-7);
    CHECK(closure_error(many, rows.elements, 0) < 1e-7);
    const double first = reciprocity_error(few, rows.elements);
    const double last = reciprocity_error(many, rows.elements);
    INFO("reciprocity errors " << first << " and " << last);
    // At the least as independent rays would, 16 times as many: by four, and some less for luck.
    CHECK(last < 0.35 * first);
    CHECK(*std::ranges::min_element(many.values) >= 0.0f);
}

TEST_CASE("A mirror's capacity is what it does not mirror, and its element is spread over it",
          "[exchange]") {
    const MirroredRows rows(mirror_room(0.8, 0.0));
    const Elements& e = rows.elements;
    for (std::size_t i = 0; i < e.patches.size(); ++i) {
        const auto& side = rows.enclosure.sides[side_of(rows.enclosure, rows.forest, e.patches[i])];
        const double area = rows.forest.area(e.patches[i]);
        const double mirrored = side.mirrored(0);
        REQUIRE(e.capacity[i] == Approx(area * (1.0 - mirrored)).epsilon(1e-14));
        REQUIRE(e.scatter[i] * (1.0 - mirrored) == Approx(side.diffuse(0)).margin(1e-15));
        REQUIRE(e.seen(i, 0) == 1.0 - mirrored);
    }
}

TEST_CASE("Two mirrors that face each other make a corridor without end", "[exchange]") {
    // The floor's share on the wall y = 0, which runs along the corridor: of two strips that meet
    // at a right angle, infinitely long, one a unit wide: (1 + 1 − √2)/2 (Hottel's strings).
    Scene scene = mirror_room(1.0, 0.0);
    scene.surfaces[test::surface_named(scene, "room.floor")].material = 0;
    const MirroredRows rows(scene);
    const auto areas = rows.made(1024);
    double found = 0.0;
    for (std::size_t i = 0; i < areas.rows(); ++i)
        for (std::size_t k = areas.starts[i]; k < areas.starts[i + 1]; ++k) {
            const auto name = [&](std::size_t element) {
                return name_of(rows.enclosure, rows.forest, rows.elements, ElementId(element));
            };
            if (name(i) == "room.floor+" && name(areas.columns[k]) == "room.y0+")
                found += areas.values[k];
        }
    // 1024 rays from each of some dozen elements.
    CHECK(found == Approx(1.0 - std::sqrt(0.5)).epsilon(0.003));
}

TEST_CASE("The part of rows that comes by way of mirrors is a part of them", "[exchange]") {
    const auto radiance = GENERATE(Radiance::constant, Radiance::linear);
    const MirroredRows rows(mirror_room(0.8, 0.4));
    const auto all = rows.made(128, RowLegs::all, radiance);
    const auto part = rows.made(128, RowLegs::in_mirrors, radiance);
    REQUIRE(part.rows() == all.rows());
    double sum = 0.0, whole = 0.0;
    bool of_patches = true, a_part = true;
    for (std::size_t i = 0; i < part.rows(); ++i)
        for (std::size_t k = part.starts[i]; k < part.starts[i + 1]; ++k) {
            of_patches = of_patches && rows.elements.is_patch(part.columns[k]);
            const double in_row = entry(all, i, part.columns[k]);
            // To the rounding of what is kept, as above.
            a_part = a_part && double(part.values[k]) <= in_row * (1.0 + 1e-5) + 1e-9;
            sum += part.values[k];
            whole += in_row;
        }
    CHECK(of_patches);
    CHECK(a_part);
    CHECK(sum > 0.05 * whole);
    CHECK(sum < 0.6 * whole);
}

TEST_CASE("Rows with level of detail go on at mirrors", "[exchange]") {
    const MirroredRows rows(mirror_room(0.8, 0.4));
    const auto areas = all_rows(exchange_walked, {rows.enclosure, rows.forest, rows.elements},
                                {.rays = 64, .detail = 4.0, .progress = {}});
    REQUIRE(!areas.levels.empty());
    CHECK(closure_error(areas, rows.elements, 0) < 1e-7);
}

TEST_CASE("A ray that two perfect mirrors send to and fro for ever brings nothing", "[gather]") {
    const MirroredRows rows(mirror_room(1.0, 0.0));
    Fields sources;
    sources.resize(rows.forest, 1);
    for (std::size_t p = 0; p < rows.forest.patch_count(); ++p) {
        const auto side = side_of(rows.enclosure, rows.forest, PatchId(p));
        if (side != none && rows.enclosure.sides[side].mirrored(0) < 0.9)  // these send nothing
            sources.patch[p].constant = 1.0;
    }
    const Point x{0.5, 0.3, 0.4};
    double radiance = -1.0;
    radiance_along(GatherScene(rows.enclosure, rows.forest, sources), {x, {1.0, 0.0, 0.0}},
                   {mesh::locate(rows.enclosure.mesh, x)}, {&radiance, 1});
    CHECK(radiance == 0.0);
}

TEST_CASE("Other methods say that they do not follow mirrors", "[exchange]") {
    const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(mirror_room(0.8, 0.4)));
    for (const auto& method : exchange_methods()) {
        CAPTURE(method.name);
        if (method.mirrors)
            CHECK_NOTHROW(require_mirrors(method, *enclosure));
        else
            CHECK_THROWS_WITH(require_mirrors(method, *enclosure),
                              Contains("does not follow light that \"room.floor+\" mirrors"));
    }
    CHECK_THROWS_WITH(solve_adaptively(enclosure, {.exchange = "full_cube"}),
                      Contains("Set exchange to walked, or mirrors to scattered"));
    const auto scattered = make_enclosure(mirror_room(0.8, 0.4), {.mirrors = Mirrors::scattered});
    CHECK(!scattered.has_mirrors());
    CHECK(scattered.sides[0].specular == Spectrum{0.5});
}
