// Solution files keep every number to the last bit, and broken ones are told.
#include <unistd.h>

#include <filesystem>
#include <random>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/adaptive.h"
#include "radiosity/file_seal.h"
#include "radiosity/hdf5_file.h"
#include "radiosity/probe.h"
#include "radiosity/report_json.h"
#include "radiosity/solution_file.h"
#include "radiosity/start_elements.h"
#include "support/box_mesh.h"
#include "support/catch.h"

namespace {

using namespace tyndall;
using namespace tyndall::radiosity;
namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("tyndall_solution_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

// A foggy box of 1 m in two bands: its top emits, its walls reflect, every kind of light shines.
std::shared_ptr<const Enclosure> box() {
    const std::vector<double> lines{0.0, 0.5, 1.0};
    auto e = test::box_enclosure({lines, lines, lines}, [](mesh::Point c, int axis) {
        if (c[axis] == 0.0) return std::optional(test::Face{mesh::Opacity::opaque, 0, none});
        if (c[axis] == 1.0)
            return std::optional(
                test::Face{mesh::Opacity::opaque, none, axis == 2 ? std::uint32_t(1) : 0u});
        return std::optional<test::Face>();
    });
    e.bands = 2;
    e.sides = {{"walls+", 0, mesh::Side::front, {0.5, 0.3}, {0.0, 0.0}, 5.0},
               {"lämpe-", 1, mesh::Side::back, {0.1, 0.2}, {1.0 / 3.0, 2.0}, 1.0}};
    e.media = {{"fog", {0.7, 0.2}, {0.9, 0.5}, {0.0, 0.01}, {0.07, 0.1}}};
    e.region_medium.assign(e.region_medium.size(), 0);
    e.environment = {0.0, 0.25};
    e.lights = {{"point", PointLight{{0.3, 0.4, 0.5}, {0.1, 0.2}}, "a:1:2"},
                {"spot", SpotLight{{0.7, 0.4, 0.5}, {0, 0, -1}, {0.1, 0.2}, 0.5, 0.1}, ""},
                {"sun", Sun{{0.6, 0.0, -0.8}, {100.0, 50.0}, 0.01}, ""}};
    e.warnings = {"a warning"};
    return std::make_shared<const Enclosure>(std::move(e));
}

Solution small_solution(Radiance radiance = Radiance::linear) {
    SolveOptions options;
    options.radiance = radiance;
    options.error = 0.2;
    options.element_size = 0.6;
    options.rays = 16;
    options.gather_rays = 16;
    options.max_elements = 3000;
    return solve_adaptively(box(), options);
}

bool same(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Affine& f, const Affine& g) {
        return f.gradient == g.gradient && f.constant == g.constant;
    });
}

// Of leaves: those of inner nodes are not kept.
bool same(const std::vector<Bend>& a, const std::vector<Bend>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Bend& f, const Bend& g) {
        return f.second == g.second &&
               (f.second == std::array<double, 6>{} || (f.centre == g.centre && f.mean == g.mean));
    });
}

void check_same(const Forest& a, const Forest& b) {
    REQUIRE(a.vertex_count() == b.vertex_count());
    REQUIRE(a.zone_count() == b.zone_count());
    REQUIRE(a.patch_count() == b.patch_count());
    bool points = true, zones = true, patches = true;
    for (std::size_t v = 0; v < a.vertex_count(); ++v)
        points = points && a.point(VertexId(v)) == b.point(VertexId(v));
    for (std::size_t z = 0; z < a.zone_count(); ++z) {
        const auto &p = a[ZoneId(z)], &q = b[ZoneId(z)];
        zones = zones && p.corners == q.corners && p.first_child == q.first_child &&
                p.plane_normal == q.plane_normal && p.plane_offset == q.plane_offset &&
                p.longest_edge == q.longest_edge && p.level == q.level;
    }
    for (std::size_t k = 0; k < a.patch_count(); ++k)
        patches = patches && a[PatchId(k)].corners == b[PatchId(k)].corners;
    CHECK(points);
    CHECK(zones);
    CHECK(patches);
}

void check_same(const Enclosure& a, const Enclosure& b) {
    CHECK(a.bands == b.bands);
    CHECK(a.mesh.points == b.mesh.points);
    CHECK(a.mesh.tets == b.mesh.tets);
    CHECK(a.mesh.neighbours == b.mesh.neighbours);
    CHECK(a.mesh.tet_facets == b.mesh.tet_facets);
    CHECK(a.mesh.regions == b.mesh.regions);
    CHECK(a.mesh.hull_max == b.mesh.hull_max);
    REQUIRE(a.mesh.facets.size() == b.mesh.facets.size());
    for (std::size_t f = 0; f < a.mesh.facets.size(); ++f) {
        CHECK(a.mesh.facets[f].corners == b.mesh.facets[f].corners);
        CHECK(a.mesh.facets[f].tets == b.mesh.facets[f].tets);
        CHECK(a.mesh.facets[f].opacity == b.mesh.facets[f].opacity);
    }
    CHECK(a.facet_sides == b.facet_sides);
    CHECK(a.region_medium == b.region_medium);
    CHECK(a.region_solid == b.region_solid);
    CHECK(a.environment == b.environment);
    CHECK(a.warnings == b.warnings);
    REQUIRE(a.sides.size() == b.sides.size());
    CHECK(a.sides[1].name == b.sides[1].name);
    CHECK(a.sides[1].emission == b.sides[1].emission);
    CHECK(a.sides[1].side == b.sides[1].side);
    CHECK(a.media.at(0).emission == b.media.at(0).emission);
    REQUIRE(a.lights.size() == b.lights.size());
    CHECK(std::get<PointLight>(b.lights[0].source).position ==
          std::get<PointLight>(a.lights[0].source).position);
    CHECK(std::get<SpotLight>(b.lights[1].source).soft_edge == 0.1);
    CHECK(std::get<Sun>(b.lights[2].source).irradiance ==
          std::get<Sun>(a.lights[2].source).irradiance);
}

}  // namespace

TEST_CASE("a solution comes back from its file to the last bit") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    const auto radiance = GENERATE(Radiance::linear, Radiance::quadratic);
    Solution solution = small_solution(radiance);
    solution.report.net_power = {{"walls+", {1.5, -0.1}}};
    write_solution(path, solution, R"({"scene": "title = \"Nebel – ü\""})");
    const auto file = read_solution(path);
    const Solution& back = file.solution;
    CHECK(file.attachments == R"({"scene": "title = \"Nebel – ü\""})");
    check_same(*solution.enclosure, *back.enclosure);
    check_same(solution.forest, back.forest);
    CHECK(same(solution.direct.zone, back.direct.zone));
    CHECK(same(solution.direct.patch, back.direct.patch));
    CHECK(same(solution.indirect.zone, back.indirect.zone));
    CHECK(same(solution.indirect.patch, back.indirect.patch));
    CHECK(solution.direct.zone_bend.empty() == (radiance == Radiance::linear));
    CHECK(same(solution.direct.zone_bend, back.direct.zone_bend));
    CHECK(same(solution.indirect.patch_bend, back.indirect.patch_bend));
    CHECK(solution.zone_error == back.zone_error);
    CHECK(solution.patch_error == back.patch_error);
    CHECK(solution.coarse.radiance == back.coarse.radiance);
    CHECK(solution.coarse.incident_direct == back.coarse.incident_direct);
    CHECK(solution.coarse.elements.of_zone == back.coarse.elements.of_zone);
    CHECK(solution.direct_light == back.direct_light);
    CHECK(report_to_json(solution.report, Costs::left_out) ==
          report_to_json(back.report, Costs::left_out));

    // Written again: the same bytes. Nothing else is left in the folder.
    write_solution(folder.path / "again", back, file.attachments);
    CHECK(mesh::read_file(path) == mesh::read_file(folder.path / "again"));
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 2);

    // What is computed from it is the same, too.
    const auto a = Probe(solution, {64, 1}).in_space({0.3, 0.6, 0.2});
    const auto b = Probe(back, {64, 1}).in_space({0.3, 0.6, 0.2});
    CHECK(a.source == b.source);
    CHECK(a.incident == b.incident);
}

TEST_CASE("a solution from a single zone comes back with its clusters") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    Solution solution = small_solution();
    auto& coarse = solution.coarse;
    coarse.elements = start_elements(*solution.enclosure, solution.forest, Start::single_zone);
    for (auto* values : {&coarse.radiance, &coarse.incident, &coarse.incident_direct})
        values->assign(coarse.elements.capacity.size(), 0.25);
    REQUIRE(coarse.elements.members.size() > coarse.elements.size());
    write_solution(path, solution);
    const auto back = read_solution(path).solution.coarse.elements;
    CHECK(back.member_starts == coarse.elements.member_starts);
    CHECK(back.members == coarse.elements.members);
    CHECK(back.member_ends == coarse.elements.member_ends);
    CHECK(back.of_patch == coarse.elements.of_patch);
    // Members that do not exist are refused.
    coarse.elements.members.back() = 1u << 30;
    write_solution(path, solution);
    CHECK_THROWS_AS(read_solution(path), mesh::InputError);
}

TEST_CASE("files that are no solutions, or not all of one, are refused") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    CHECK_THROWS_WITH(read_solution(path), Contains("there is no file"));
    mesh::write_file(path, "format = 1");
    CHECK_THROWS_WITH(read_solution(path), Contains("not a solution file"));
    write_solution(path, small_solution());
    const std::string bytes = mesh::read_file(path);
    for (int k = 0; k < 40; ++k) {
        // Near the end every length, before that at even steps.
        const std::size_t length = k < 20 ? bytes.size() - 1 - k : bytes.size() * (k - 20) / 20;
        CAPTURE(length);
        mesh::write_file(path, bytes.substr(0, length));
        CHECK_THROWS_AS(read_solution(path), mesh::InputError);
    }
    CHECK_THROWS_WITH(write_solution(folder.path / "none" / "s", small_solution()),
                      Contains("does not exist"));
}

TEST_CASE("a solution file of another format is refused, and its number is told") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    for (const int format : {1, solution_format + 1}) {
        Hdf5Writer file;
        file.group("/tyndall");
        file.attribute("/tyndall", "format", std::vector<std::int64_t>{format});
        const std::string bytes = file.finish();
        // Format 1 had no seal.
        mesh::write_file(path, format == 1 ? bytes.substr(0, bytes.size() - 16) : bytes);
        CHECK_THROWS_WITH(read_solution(path),
                          Contains("its format is " + std::to_string(format)) &&
                              Contains("reads format " + std::to_string(solution_format)) &&
                              Contains("Solve the scene again"));
    }
    Hdf5Writer other;
    other.group("/other");
    mesh::write_file(path, other.finish());
    CHECK_THROWS_WITH(read_solution(path), Contains("another program wrote it"));
}

TEST_CASE("a solution file with a wrong byte anywhere is refused") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    write_solution(path, small_solution());
    const std::string bytes = mesh::read_file(path);
    std::mt19937 random(12345);
    for (int n = 0; n < 300; ++n) {
        const std::size_t place = random() % bytes.size();
        std::string damaged = bytes;
        damaged[place] ^= char(1 + random() % 255);
        CAPTURE(place);
        mesh::write_file(path, damaged);
        CHECK_THROWS_WITH(read_solution(path), Contains("solution.vtkhdf"));
    }
    mesh::write_file(path, bytes);
    CHECK_NOTHROW(read_solution(path));
}

TEST_CASE("wrong bytes under a right seal are read right or refused, never more") {
    const Folder folder;
    const auto path = folder.path / "solution.vtkhdf";
    write_solution(path, small_solution());
    const std::string bytes = mesh::read_file(path);
    const std::string sealed = bytes.substr(0, bytes.size() - 16);
    CHECK(sealed + seal_of(sealed) == bytes);
    const auto message = [&](std::size_t place, int bit) -> std::string {
        std::string damaged = sealed;
        damaged[place] ^= char(1 << bit);
        mesh::write_file(path, damaged + seal_of(damaged));
        try {
            read_solution(path);
        } catch (const mesh::InputError& error) {
            return error.what();
        }
        return "";
    };
    std::mt19937 random(12345);
    std::size_t refused = 0;
    for (int n = 0; n < 60; ++n) refused += !message(random() % sealed.size(), n % 8).empty();
    CHECK(refused > 10);  // what viewers alone read is not looked at

    // The number that stands for the leaves' order follows its name within a hundred bytes.
    std::size_t of_other_order = 0;
    const std::size_t name = sealed.find("leaf_order");
    REQUIRE(name != std::string::npos);
    for (std::size_t place = name + 10; place < name + 100; ++place)
        of_other_order += message(place, 0).find("numbers leaves") != std::string::npos;
    CHECK(of_other_order >= 8);  // its bytes; some of its type change how it is read, too
}
