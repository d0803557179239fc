// Cubes with a hot bottom wall: mean incident radiance and irradiance at points, after the whole
// chain of mesh, rows, solution, refinement and last gather. Figures computed for this project.
#include <cmath>

#include "mesh/catch.h"
#include "radiosity/adaptive.h"
#include "radiosity/direct_light.h"
#include "radiosity/gather.h"
#include "support/reference.h"
#include "support/rooms.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

Scene cube_scene(const nlohmann::json& c) {
    const auto& params = c["params"];
    const double reflectance = params["rho"];
    Scene scene;
    scene.materials = {test::material(reflectance), test::material(reflectance, 1.0)};
    test::add_surfaces(scene, "cube", mesh::room({0, 0, 0}, {1, 1, 1}), 0);
    scene.surfaces[test::surface_named(scene, "cube.floor")].material = 1;
    const auto& layers = c["geometry"]["layers_in_z"];
    for (const auto& layer : layers) {
        const double z0 = layer["z0"], z1 = layer["z1"];
        scene.media.push_back(
            test::medium(layer["kappa"], layer["omega"], Point(0.4, 0.3, 0.5 * (z0 + z1))));
        if (z0 > 0.0)
            test::add_surfaces(scene, "layer", mesh::rectangle({0, 0, z0}, {1, 0, 0}, {0, 1, 0}),
                               std::nullopt);
    }
    return scene;
}

// The wall of the unit cube that x lies on: the tet, the inward normal.
struct OnWall {
    mesh::WalkStart start;
    Direction normal{0.0};
};

OnWall wall_at(const Enclosure& enclosure, Point x) {
    const auto& mesh = enclosure.mesh;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        for (const Side side : {Side::front, Side::back}) {
            if (enclosure.facet_sides[f][side == Side::back] == none) continue;
            const auto& c = mesh.facets[f].corners;
            const Point a = mesh.points[c[0].value], b = mesh.points[c[1].value],
                        d = mesh.points[c[2].value];
            const auto n = mesh::normal(mesh, mesh::FacetId(f));
            if (std::abs(glm::dot(n, x - a)) > 1e-9) continue;
            if (glm::dot(n, glm::cross(b - a, x - a)) < -1e-9 ||
                glm::dot(n, glm::cross(d - b, x - b)) < -1e-9 ||
                glm::dot(n, glm::cross(a - d, x - d)) < -1e-9)
                continue;
            return {start_on(mesh, mesh::FacetId(f), side), side == Side::front ? n : -n};
        }
    throw std::runtime_error("no wall there");
}

// What the reference cases ask of a solution.
class Probe {
  public:
    explicit Probe(const Solution& solution)
        : solution_(solution),
          enclosure_(*solution.enclosure),
          light_(enclosure_),
          sources_(reflected_sources(solution)),
          points_(4096) {}

    double operator()(const nlohmann::json& c) const {
        const std::string name = c["name"];
        const auto& at = c["geometry"]["point"];
        const bool wall = name.find("/E_") != std::string::npos;
        if (at.is_null()) return wall ? face_mean(name) : volume_mean();
        return incident({at[0], at[1], at[2]}, wall);
    }

  private:
    double incident(Point x, bool wall) const {
        double direct = 0.0;
        Gathered indirect;
        GatherPoint point{x, {}, Direction(0.0)};
        if (wall) {
            const OnWall on = wall_at(enclosure_, x);
            point.start = on.start;
            point.normal = on.normal;
            light_.at_patch(x, on.normal, on.start.tet, {&direct, 1});
        } else {
            point.start = {mesh::locate(enclosure_.mesh, x)};
            light_.at_zone(x, point.start.tet, {&direct, 1});
        }
        gather({enclosure_, solution_.forest, sources_}, point, points_, 1, {&indirect, 1});
        return direct + indirect.mean;
    }

    // Of the recomputed fields: a leaf's mean is the value at its centroid.
    double face_mean(const std::string& name) const {
        const bool top = name.find("top") != std::string::npos;
        const bool bottom = name.find("bottom") != std::string::npos;
        const Forest& forest = solution_.forest;
        double sum = 0.0, area = 0.0;
        for (std::size_t p = 0; p < forest.patch_count(); ++p) {
            const PatchId patch(p);
            if (!forest.is_leaf(patch) || side_of(enclosure_, forest, patch) == none) continue;
            const Point x = forest.centroid(patch);
            if (top ? x.z < 1.0 - 1e-9 : bottom ? x.z > 1e-9 : x.x > 1e-9) continue;
            const double a = forest.area(patch);
            sum +=
                a * (solution_.direct.at(patch, 0).at(x) + solution_.indirect.at(patch, 0).at(x));
            area += a;
        }
        return sum / area;
    }

    double volume_mean() const {
        const Forest& forest = solution_.forest;
        double sum = 0.0, volume = 0.0;
        for (std::size_t z = 0; z < forest.zone_count(); ++z) {
            const ZoneId zone(z);
            if (!forest.is_leaf(zone) || medium_of(enclosure_, forest, zone) == none) continue;
            const Point x = forest.centroid(zone);
            const double v = forest.volume(zone);
            sum += v * (solution_.direct.at(zone, 0).at(x) + solution_.indirect.at(zone, 0).at(x));
            volume += v;
        }
        return sum / volume;
    }

    const Solution& solution_;
    const Enclosure& enclosure_;
    DirectLight light_;
    Fields sources_;
    PointSet points_;
};

std::vector<nlohmann::json> cases_of(const nlohmann::json& file, const std::string& cube) {
    std::vector<nlohmann::json> cases;
    for (const auto& c : file["cases"])
        if (std::string(c["name"]).rfind(cube + "/", 0) == 0) cases.push_back(c);
    REQUIRE(cases.size() == 13);
    return cases;
}

}  // namespace

TEST_CASE("Cubes with a hot wall: M and E at points within 1 %", "[solution]") {
    const auto file = test::reference("4def_cube_rte");
    const SolveOptions options{
        .refinement = Refinement::uniform, .element_size = 0.3, .rays = 256, .gather_rays = 256};
    for (const std::string cube :
         {"cube_black_tau0.5_omega1", "cube_black_tau1_omega0.7", "cube_black_tau2_omega1",
          "cube_gray_rho0.5_tau1_omega1", "cube_gray_rho0.5_tau2_omega0.7", "cube_layers1"}) {
        const auto cases = cases_of(file, cube);
        const auto solution = solve_adaptively(
            std::make_shared<const Enclosure>(make_enclosure(cube_scene(cases[0]))), options);
        const Probe probe(solution);
        for (const auto& c : cases) {
            const double value = c["value"], found = probe(c);
            INFO(c["name"] << ": " << found << " for " << value << ", relative error "
                           << found / value - 1.0);
            CHECK(found == Approx(value).epsilon(0.01));
        }
    }
}

TEST_CASE("Cube with a hot wall: finer elements and more rays, less error", "[solution]") {
    const auto file = test::reference("4def_cube_rte");
    const auto cases = cases_of(file, "cube_gray_rho0.5_tau2_omega1");
    const auto enclosure = std::make_shared<const Enclosure>(make_enclosure(cube_scene(cases[0])));
    std::vector<double> errors;
    for (const auto& [size, rays] : {std::pair{1.2, 64}, {0.6, 256}, {0.3, 1024}}) {
        const auto solution = solve_adaptively(enclosure, {.refinement = Refinement::uniform,
                                                           .element_size = size,
                                                           .rays = std::size_t(rays),
                                                           .gather_rays = 256});
        const Probe probe(solution);
        double sum = 0.0;
        for (const auto& c : cases) {
            const double error = probe(c) / double(c["value"]) - 1.0;
            sum += error * error / double(cases.size());
        }
        errors.push_back(std::sqrt(sum));
    }
    WARN("RMS errors: " << errors[0] << " " << errors[1] << " " << errors[2]);
    CHECK(errors[1] < errors[0]);
    CHECK(errors[2] < errors[1]);
}
