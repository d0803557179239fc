// Rays that are aimed at bright places: at which, what they count, and what they gain.
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/wall_openings.h"
#include "radiosity/gather.h"
#include "radiosity/uneven_zones.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A room with haze and, from wall to wall across it, partitions at these x with slits in them.
Scene parted_room(const std::vector<double>& partitions) {
    Scene scene;
    scene.materials = {test::material(0.5)};
    test::add_surfaces(scene, "room", mesh::room({0, 0, 0}, {3, 2, 2}), 0);
    for (std::size_t k = 0; k < partitions.size(); ++k) {
        const std::string name = "wall" + std::to_string(k);
        auto faces = mesh::rectangle({partitions[k], 0, 0}, {0, 2, 0}, {0, 0, 2},
                                     {{"slit", {0.9, 0.5}, {0.04, 1.0}}});
        const std::vector<mesh::Face> slit{faces.back()};
        faces.pop_back();
        test::add_surfaces(scene, name, faces, 0);
        test::add_surfaces(scene, name, slit, std::nullopt);
    }
    scene.media = {test::medium(0.2, 0.9)};
    return scene;
}

GatherPoint gather_point(const Enclosure& enclosure, Point x, Direction normal) {
    const Point beside = x + 1e-9 * normal;
    return {beside, {mesh::locate(enclosure.mesh, beside)}, normal};
}

// Its light: the part before the first partition is bright, and varies; behind each partition it is
// dimmer.
struct LitRoom {
    Enclosure enclosure;
    Forest forest;
    Fields sources;

    explicit LitRoom(const std::vector<double>& partitions, double dim = 0.01)
        : LitRoom(partitions, parted_room(partitions), dim) {}
    LitRoom(const std::vector<double>& partitions, const Scene& scene, double dim = 0.01)
        : enclosure(make_enclosure(scene)), forest(enclosure.mesh) {
        sources.resize(forest, 1);
        const auto fill = [&](Affine& f, Point centre) {
            const auto behind = std::ranges::count_if(
                partitions, [&](double partition) { return centre.x > partition; });
            f = behind == 0 ? Affine{{0.2, -0.3, 0.1}, 1.0}
                            : Affine{{}, std::pow(dim, double(behind))};
        };
        for (std::size_t z = 0; z < forest.zone_count(); ++z)
            fill(sources.at(ZoneId(z), 0), forest.centroid(ZoneId(z)));
        for (std::size_t p = 0; p < forest.patch_count(); ++p) {
            const PatchId patch(p);
            if (side_of(enclosure, forest, patch) == none) continue;
            fill(sources.at(patch, 0), forest.centroid(patch) + 1e-3 * normal_of(forest, patch));
        }
    }
    GatherScene scene() const { return {enclosure, forest, sources}; }
    GatherPoint at(Point x, Direction normal = Direction(0.0)) const {
        return gather_point(enclosure, x, normal);
    }
};

// A room with a small lamp in haze that is as bright as a lamp there makes it.
struct RoomWithLamp {
    static constexpr Point lamp{0.9, 1.0, 1.1};
    Enclosure enclosure;
    Forest forest;
    Fields sources;

    explicit RoomWithLamp(const std::vector<mesh::Face>& screen = {})
        : enclosure(make_enclosure(scene_with_lamp(screen))), forest(enclosure.mesh) {
        std::vector<ZoneId> zones;
        for (std::size_t z = 0; z < forest.zone_count(); ++z) zones.emplace_back(z);
        for (std::size_t k = 0; k < zones.size(); ++k) {
            const ZoneId zone = zones[k];
            const double distance = glm::distance(forest.centroid(zone), lamp);
            if (forest[zone].longest_edge < std::max(0.02, 0.3 * distance)) continue;
            const auto [i, j] = forest.longest_edge(zone);
            const ZoneId first = forest.bisect(zone, i, j);
            zones.push_back(first);
            zones.emplace_back(first.value + 1ull);
        }
        sources.resize(forest, 1);
        for (std::size_t z = 0; z < forest.zone_count(); ++z) {
            const double distance = glm::distance(forest.centroid(ZoneId(z)), lamp);
            if (forest.is_leaf(ZoneId(z)))
                sources.at(ZoneId(z), 0).constant = 0.2 / (distance * distance);
        }
        for (Affine& wall : sources.patch) wall.constant = 0.05;
        coarsen(forest, sources);
    }
    static Scene scene_with_lamp(const std::vector<mesh::Face>& screen) {
        Scene scene = parted_room({});
        test::add_surfaces(scene, "screen", screen, 0);
        scene.lights = {{"lamp", PointLight{lamp, {1.0}}, {}}};
        return scene;
    }
};

const std::vector<std::pair<Point, Direction>> about_the_lamp{{{0.9, 0.0, 1.0}, {0, 1, 0}},
                                                              {{0.6, 1.2, 0.0}, {0, 0, 1}},
                                                              {{3.0, 0.4, 1.2}, {-1, 0, 0}},
                                                              {{0.7, 1.3, 1.0}, {0, 0, 0}},
                                                              {{2.0, 0.7, 0.4}, {0, 0, 0}}};

double gathered(const GatherScene& scene, const OnPurpose& look, const GatherPoint& point,
                std::size_t rays, std::uint64_t seed) {
    Gathered value[1];
    gather(scene, look, point, PointSet(rays), seed, value);
    return value[0].mean;
}

// Relative deviations of gathers with 256 rays from what many find, over some throws.
struct Noises {
    static constexpr int throws = 32;
    double plain = 0.0, aimed = 0.0, bias = 0.0;

    Noises(const GatherScene& scene, const BrightPlaces& places, const GatherPoint& point) {
        const double exact = gathered(scene, {}, point, 1u << 18, 1);
        for (int k = 0; k < throws; ++k) {
            const double with = gathered(scene, {.bright = &places}, point, 256, k) / exact - 1.0;
            const double without = gathered(scene, {}, point, 256, k) / exact - 1.0;
            bias += with / throws;
            aimed += with * with / throws;
            plain += without * without / throws;
        }
        plain = std::sqrt(plain);
        aimed = std::sqrt(aimed);
    }
    // By what so many throws and the many rays leave.
    double may_be_biased() const { return 4.0 * aimed / std::sqrt(double(throws)) + 2e-3; }
};

const std::vector<std::pair<Point, Direction>> behind_slits{{{2.5, 0.0, 1.0}, {0, 1, 0}},
                                                            {{2.5, 1.5, 0.0}, {0, 0, 1}},
                                                            {{3.0, 0.4, 1.2}, {-1, 0, 0}},
                                                            {{2.6, 1.0, 1.0}, {0, 0, 0}},
                                                            {{1.8, 0.7, 0.4}, {0, 0, 0}}};

}  // namespace

TEST_CASE("Openings of walls: planar interfaces that opaque facets stand around", "[gather]") {
    const auto area = [](const Enclosure& e, const std::vector<FacetId>& group) {
        double sum = 0.0;
        for (const FacetId f : group) sum += mesh::area(e.mesh, f);
        return sum;
    };
    const Enclosure slits = make_enclosure(parted_room({1.0, 1.5}));
    const auto openings = mesh::wall_openings(slits.mesh);
    REQUIRE(openings.size() == 2);
    CHECK(area(slits, openings[0]) == Approx(0.04));
    CHECK(area(slits, openings[1]) == Approx(0.04));
    CHECK(mesh::has_interfaces(slits.mesh));

    // A box of another medium in mid-air is no hole in a wall; its faces are interfaces, though.
    Scene box = parted_room({});
    test::add_surfaces(box, "cloud", mesh::box({1, 0.5, 0.5}, {2, 1.5, 1.5}), std::nullopt);
    const Enclosure cloud = make_enclosure(box);
    CHECK(mesh::has_interfaces(cloud.mesh));
    CHECK(mesh::wall_openings(cloud.mesh).empty());
    CHECK_FALSE(mesh::has_interfaces(make_enclosure(test::slit_room()).mesh));
}

TEST_CASE("Openings are aimed at from where they are bright, and only from there", "[gather]") {
    const LitRoom room({1.0});
    const BrightPlaces openings(room.enclosure, room.scene(), {}, 1);
    REQUIRE(openings.all().size() == 1);
    BrightCones cones;
    for (const auto& [x, normal] : behind_slits) {
        cones.look(openings, room.at(x, normal), 256, 1);
        CHECK(cones.aimed().size() >= 32);
    }
    const auto not_aimed_at = [&](Point x, Direction normal) {
        cones.look(openings, room.at(x, normal), 256, 1);
        return cones.empty();
    };
    CHECK(not_aimed_at({0.5, 1.0, 1.0}, {0, 0, 0}));      // it is dark behind
    CHECK(not_aimed_at({1.0, 0.5, 1.0}, {1, 0, 0}));      // in its plane
    CHECK(not_aimed_at({1.5, 1.0, 2.0}, {0, 0, 1}));      // below the horizon
    CHECK(not_aimed_at({1.0, 0.92, 1.0}, {0, 0, 0}));     // in the slit itself
    CHECK(not_aimed_at({1.0001, 0.92, 1.0}, {0, 0, 0}));  // half of all directions
    // As bright on both sides: there is nothing to be gained.
    const LitRoom even({1.0}, 1.0);
    CHECK(BrightPlaces(even.enclosure, even.scene(), {}, 1).all().empty());
}

TEST_CASE("Rays of a gather that aims at openings count as they should", "[gather]") {
    // Two slits one behind the other: their cones overlap.
    const LitRoom room({1.0, 1.5});
    const BrightPlaces openings(room.enclosure, room.scene(), {}, 1);
    REQUIRE(openings.all().size() == 2);
    GatherRays rays;
    const PointSet points(1u << 16);
    for (const auto& [x, normal] : behind_slits) {
        CAPTURE(x.x, x.y, x.z);
        rays.spread(room.at(x, normal), &openings, points, 3);
        REQUIRE_FALSE(rays.cones().empty());
        double sum = 0.0, halves = 0.0, off_unit = 0.0;
        bool parted = true;
        Direction mean(0.0);
        std::array<double, 3> squares{};
        for (const GatherRay& ray : rays.all()) {
            const bool aimed = ray.lit_beyond < mesh::infinity;
            parted = parted && rays.cones().cover(ray.direction) == aimed;
            off_unit = std::max(off_unit, std::abs(glm::length(ray.direction) - 1.0));
            sum += ray.weight;
            halves += ray.half_weight;
            mean += ray.weight * ray.direction;
            for (int k = 0; k < 3; ++k)
                squares[k] += ray.weight * ray.direction[k] * ray.direction[k];
        }
        CHECK(parted);
        CHECK(off_unit < 1e-12);
        CHECK(sum == Approx(1.0).epsilon(1e-10));
        CHECK(std::abs(halves) < 1e-10);
        // Moments of directions: of the sphere, and cosine-weighted above a plane.
        CHECK(glm::distance(mean, 2.0 / 3.0 * normal) < 1e-3);
        for (int k = 0; k < 3; ++k)
            CHECK(squares[k] == Approx(normal == Direction(0.0)    ? 1.0 / 3.0
                                       : std::abs(normal[k]) > 0.5 ? 0.5
                                                                   : 0.25)
                                    .epsilon(2e-3));
    }
}

TEST_CASE("Rays aimed at an opening find what many rays find, with far less noise", "[gather]") {
    const bool behind_two = GENERATE(false, true);
    const LitRoom room(behind_two ? std::vector{1.0, 1.5} : std::vector{1.0});
    const GatherScene scene = room.scene();
    const BrightPlaces openings(room.enclosure, scene, {}, 1);
    for (const auto& [x, normal] : behind_slits) {
        const Noises noises(scene, openings, room.at(x, normal));
        CAPTURE(behind_two, x.x, x.y, x.z, noises.plain, noises.aimed);
        CHECK(std::abs(noises.bias) < noises.may_be_biased());
        CHECK(noises.aimed < 0.25 * noises.plain);
    }
}

TEST_CASE("Rays aimed at the haze about a lamp find what many rays find, with less noise",
          "[gather]") {
    const RoomWithLamp room;
    const GatherScene scene(room.enclosure, room.forest, room.sources);
    const BrightPlaces balls(room.enclosure, scene, {}, 1);
    REQUIRE(balls.all().size() >= 2);
    CHECK_FALSE(balls.all().front().is_opening());
    double gain = 1.0;
    for (const auto& [x, normal] : about_the_lamp) {
        const Noises noises(scene, balls, gather_point(room.enclosure, x, normal));
        CAPTURE(x.x, x.y, x.z, noises.plain, noises.aimed);
        CHECK(std::abs(noises.bias) < noises.may_be_biased());
        CHECK(noises.aimed < 0.8 * noises.plain);
        gain *= noises.plain / noises.aimed;
    }
    CHECK(gain > std::pow(2.0, double(about_the_lamp.size())));
}

TEST_CASE("Nothing is aimed at where a wall hides it, or where it is all around", "[gather]") {
    // A screen before the lamp, from floor to ceiling and not from wall to wall.
    const RoomWithLamp room(mesh::rectangle({1.5, 0.2, 0}, {0, 1.6, 0}, {0, 0, 2}));
    const BrightPlaces balls(room.enclosure, GatherScene(room.enclosure, room.forest, room.sources),
                             {}, 1);
    REQUIRE_FALSE(balls.all().empty());
    BrightCones cones;
    const auto aims = [&](Point x, Direction normal) {
        cones.look(balls, gather_point(room.enclosure, x, normal), 256, 1);
        return !cones.empty();
    };
    CHECK(aims({1.4, 1.0, 1.0}, {0, 0, 0}));
    CHECK_FALSE(aims({1.6, 1.0, 1.0}, {0, 0, 0}));  // behind the screen
    CHECK_FALSE(aims({2.5, 1.0, 1.0}, {0, 0, 0}));
    CHECK_FALSE(aims(RoomWithLamp::lamp, {0, 0, 0}));  // it is all around
    CHECK_FALSE(aims({0.0, 1.0, 1.1}, {-1, 0, 0}));    // below the horizon
}

TEST_CASE("Where it is as bright everywhere, aimed rays leave no noise", "[gather]") {
    LitRoom room({1.0});
    const BrightPlaces openings(room.enclosure, room.scene(), {}, 1);
    for (Affine& f : room.sources.zone) f = {{}, 1.0};
    for (Affine& f : room.sources.patch) f = {{}, 1.0};
    for (const auto& [x, normal] : behind_slits) {
        Gathered value[1];
        gather(room.scene(), {.bright = &openings}, room.at(x, normal), PointSet(64), 5, value);
        CHECK(value[0].mean == Approx(1.0).epsilon(1e-6));
        CHECK(std::abs(value[0].half_difference) < 1e-6);
    }
}

TEST_CASE("Uneven zones never stand for their leaves", "[gather]") {
    const RoomWithLamp room;
    const auto uneven = uneven_zones(room.enclosure, room.forest, room.sources);
    REQUIRE_FALSE(uneven.empty());
    // Those that hold the lamp are, from the base tetrahedron on.
    const TetId tet = mesh::locate(room.enclosure.mesh, RoomWithLamp::lamp);
    CHECK(std::ranges::count(uneven, mesh::root_zone(tet)) == 1);
    // A linear function has nothing that a zone could not stand for.
    Fields linear = room.sources;
    for (Affine& f : linear.zone) f = {{0.1, 0.2, 0.3}, 1.0};
    CHECK(uneven_zones(room.enclosure, room.forest, linear).empty());

    // With the coarsest detail a gather still finds what one finds that sees all leaves.
    const GatherScene leaves(room.enclosure, room.forest, room.sources);
    const GatherScene coarse(room.enclosure, room.forest, room.sources, 1.0);
    for (const auto& [x, normal] : about_the_lamp) {
        const GatherPoint point = gather_point(room.enclosure, x, normal);
        CAPTURE(x.x, x.y, x.z);
        CHECK(gathered(coarse, {}, point, 1u << 14, 1) ==
              Approx(gathered(leaves, {}, point, 1u << 14, 1)).epsilon(0.005));
    }
}

TEST_CASE("Light that lit patches send through an opening is counted once", "[gather]") {
    // A screen stands between some of the points and the slit, lit as well.
    const bool screen = GENERATE(false, true);
    Scene scene = parted_room({1.0});
    if (screen)
        test::add_surfaces(scene, "screen",
                           mesh::rectangle({1.7, 0.3, 0.2}, {0, 0.9, 0}, {0, 0, 0.9}), 0);
    LitRoom room({1.0}, scene);
    Fields lit, rest = room.sources;
    lit.resize(room.forest, 1);
    for (std::size_t p = 0; p < room.forest.patch_count(); ++p) {
        const PatchId patch(p);
        Affine& all = room.sources.at(patch, 0);
        if (side_of(room.enclosure, room.forest, patch) == none) continue;
        if (std::abs(room.forest.centroid(patch).x - 1.7) < 1e-9) all.constant = 2.0;
        lit.at(patch, 0) = {0.5 * all.gradient, 0.5 * all.constant};
        rest.at(patch, 0) = lit.at(patch, 0);
    }
    GatherScene seen(room.enclosure, room.forest, rest);
    seen.set_lit(lit.patch);
    const LitPatches patches(room.enclosure, room.forest, lit);
    const BrightPlaces openings(room.enclosure, seen, {.lit = &patches}, 1);
    for (const auto& [x, normal] : behind_slits) {
        const GatherPoint point = room.at(x, normal);
        const double exact = gathered(room.scene(), {}, point, 1u << 18, 1);
        double mean = 0.0;
        for (int k = 0; k < 16; ++k)
            mean += gathered(seen, {&patches, &openings}, point, 1024, k) / 16.0;
        CAPTURE(screen, x.x, x.y, x.z);
        CHECK(mean == Approx(exact).epsilon(0.01));
    }
}
