// The hierarchy over facets against the walk through tetrahedra: two ways that share nothing.
#include "mesh/entry.h"
#include "radiosity/facet_hits.h"
#include "support/catch.h"
#include "support/random_rays.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// A room with a partition that has a slit, a box that is solid, a bank of fog in haze.
Enclosure busy_room() {
    Scene scene = test::slit_room();
    test::add_surfaces(scene, "block", mesh::box({0.2, 0.2, 0.0}, {0.6, 0.7, 0.5}), 0);
    test::add_surfaces(scene, "bank", mesh::box({1.8, 0.3, 0.4}, {2.6, 1.6, 1.3}), {});
    scene.media[0].name = "haze";
    scene.media.push_back(test::medium(2.0, 0.5, mesh::Point(2.2, 1.0, 0.8)));
    scene.media[1].name = "fog";
    return make_enclosure(scene);
}

// Length of each medium on a ray, by index.
std::vector<double> lengths(const std::vector<Stretch>& stretches, std::size_t media) {
    std::vector<double> sum(media, 0.0);
    for (const Stretch& s : stretches) sum[s.medium] += s.end - s.begin;
    return sum;
}

}  // namespace

TEST_CASE("Rays meet what the walk meets, and pass the same media") {
    const Enclosure e = busy_room();
    REQUIRE(e.media.size() == 2);
    const FacetHits hits(e);
    test::Random random(5);
    Sight sight;
    std::size_t other = 0;
    constexpr std::size_t rays = 20000;
    for (std::size_t k = 0; k < rays; ++k) {
        const mesh::Point x(test::uniform(random, 0, 3), test::uniform(random, 0, 2),
                            test::uniform(random, 0, 2));
        const mesh::TetId tet = mesh::locate(e.mesh, x);
        if (!tet.valid() || e.solid(tet)) continue;
        const mesh::Direction d = test::random_direction(random);
        std::vector<Stretch> walked;
        const auto end = mesh::walk(e.mesh, {x, d}, {tet}, [&](TetId t, double in, double out) {
            if (!e.solid(t) && e.medium_of(t) != none) walked.push_back({e.medium_of(t), in, out});
            return true;
        });
        REQUIRE(end.arrival == mesh::Arrival::struck);
        hits.look(x, d, none, sight);
        REQUIRE(sight.end == SightEnd::surface);
        // Single precision finds another facet where a ray passes an edge within 1e-6 of the room.
        if (sight.facet != end.facet || sight.side != end.side) {
            ++other;
            continue;
        }
        CHECK(sight.distance == Approx(end.distance).margin(1e-5));
        CHECK(sight.surface == e.facet_sides[end.facet.value][end.side == Side::back]);
        CHECK(sight.medium == (e.solid(end.tet) ? none : e.medium_of(end.tet)));
        const auto ours = lengths(sight.stretches, 2), theirs = lengths(walked, 2);
        for (int m = 0; m < 2; ++m) CHECK(ours[m] == Approx(theirs[m]).margin(1e-4));
    }
    CHECK(other <= rays / 2000);
}

TEST_CASE("Two points see each other, or something is in between") {
    const Enclosure e = busy_room();
    const FacetHits hits(e);
    std::vector<Stretch> way;
    // Through the slit, and through the bank of fog beyond it.
    REQUIRE(hits.sees({0.5, 1.0, 0.8}, {2.8, 1.0, 0.8}, 0, way));
    REQUIRE(way.size() == 3);
    CHECK(way[1].medium == 1);
    CHECK(way[1].end - way[1].begin == Approx(0.8).margin(1e-5));
    CHECK(way[0].begin == 0.0);
    CHECK(way[2].end == Approx(2.3).epsilon(1e-12));
    CHECK_FALSE(hits.sees({0.5, 0.5, 0.8}, {2.8, 0.5, 0.8}, 0, way));  // the partition
    CHECK_FALSE(hits.sees({0.1, 0.4, 0.2}, {0.7, 0.4, 0.2}, 0, way));  // the block
    CHECK_FALSE(hits.sees_out({0.5, 1.0, 0.8}, {0, 0, 1}, 0, way));
}

TEST_CASE("An open scene is left through its hull, and looked into from outside") {
    Scene scene;
    scene.materials = {test::material(0.5)};
    test::add_surfaces(scene, "floor", mesh::rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), 0);
    test::add_surfaces(scene, "bank", mesh::box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.0}), {});
    scene.media = {test::medium(1.0, 0.5, mesh::Point(1, 1, 0.7))};
    const Enclosure e = make_enclosure(scene);
    const FacetHits hits(e);
    Sight sight;
    hits.look({1, 1, 9}, {0, 0, -1}, none, sight);
    REQUIRE(sight.end == SightEnd::surface);
    CHECK(sight.distance == Approx(9.0).epsilon(1e-6));
    REQUIRE(sight.stretches.size() == 1);
    CHECK(sight.stretches[0].begin == Approx(8.0).epsilon(1e-6));
    CHECK(sight.stretches[0].end == Approx(8.5).epsilon(1e-6));
    hits.look({1, 1, 0.7}, {0, 0, 1}, 0, sight);
    CHECK(sight.end == SightEnd::outside);
    CHECK(sight.stretches.size() == 1);
    std::vector<Stretch> way;
    CHECK(hits.sees_out({1, 1, 0.7}, {1, 0, 0}, 0, way));
}
