// Exchange areas by hemi-cube, full cube and single plane.
#include <tbb/global_control.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "mesh/input_error.h"
#include "radiosity/closed_forms.h"
#include "radiosity/cube_faces.h"
#include "radiosity/exchange_full_cube.h"
#include "radiosity/exchange_hemicube.h"
#include "radiosity/exchange_methods.h"
#include "radiosity/exchange_single_plane.h"
#include "radiosity/start_elements.h"
#include "support/catch.h"
#include "support/crowded_cube.h"
#include "support/cube.h"
#include "support/reference.h"

using namespace tyndall;
using namespace tyndall::radiosity;
using std::numbers::pi;

namespace {

ExchangeOptions cubes(std::size_t resolution, std::size_t centres = 1, bool random = false,
                      std::uint64_t seed = 1, Projection projection = Projection::z_buffer) {
    ExchangeOptions options;
    options.seed = seed;
    options.settings.resolution = resolution;
    options.settings.centres = centres;
    options.settings.random_offsets = random;
    options.settings.projection = projection;
    return options;
}

double sum_of(const std::vector<CubeFace>& faces) {
    double sum = 0.0;
    for (const auto& face : faces)
        for (const double weight : face.weights) sum += weight;
    return sum;
}

// Two unit cubes with an open face between them, a medium each: what the first exchanges with
// itself and with the second.
std::array<double, 2> two_cubes(double extinction, const ExchangeOptions& options) {
    auto enclosure = test::box_enclosure({{{0, 1, 2}, {0, 1}, {0, 1}}},
                                         [](mesh::Point c, int axis) -> std::optional<test::Face> {
                                             if (axis != 0 || c.x != 1.0) return std::nullopt;
                                             return test::Face{mesh::Opacity::interface};
                                         });
    enclosure.media = {{"first", {extinction}, {1.0}, {0.0}, {0.0}},
                       {"second", {extinction}, {1.0}, {0.0}, {0.0}}};
    REQUIRE(enclosure.mesh.region_count == 2);
    enclosure.region_medium = {0, 1};
    const Forest forest(enclosure.mesh);
    const auto elements = start_elements(enclosure, forest, Start::single_zone);
    const auto areas = all_rows(exchange_full_cube, {enclosure, forest, elements}, options);
    return {entry(areas, 0, 0), entry(areas, 0, 1)};
}

// A unit cube of 3³ cells, turned in space or not, with hardly any extinction. Root mean square,
// over some elements and the walls they see, of the error of what the wall is of the element's
// view.
class PointViews {
  public:
    explicit PointViews(bool turned)
        : enclosure_(test::cube_enclosure({.extinction = 1e-6, .cells = 3})) {
        if (turned)
            turn_ = glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(Point(1, 2, 3))));
        for (Point& p : enclosure_.mesh.points) p = turn_ * p;
        forest_ = Forest(enclosure_.mesh);
        elements_ = elements_of_leaves(enclosure_, forest_);
    }

    double error(ExchangeMethod method, bool zones, std::size_t resolution) const {
        std::vector<ElementId> rows;
        const std::size_t patches = elements_.patches.size();
        for (std::size_t i = zones ? patches : 0; i < (zones ? elements_.size() : patches); i += 7)
            rows.push_back(ElementId(i));
        double square = 0.0, count = 0.0;
        method({enclosure_, forest_, elements_}, rows, cubes(resolution), [&](const Row& row) {
            std::array<double, 6> seen{};
            for (std::size_t k = 0; k < row.columns.size(); ++k)
                if (row.columns[k] < patches)
                    seen[wall_of(row.columns[k])] +=
                        row.exchange_areas[k] / elements_.capacity[row.receiver.value];
            for (std::uint32_t wall = 0; wall < 6; ++wall) {
                if (!zones && wall == wall_of(row.receiver.value)) continue;
                // The single plane sees all of the opposite wall, but not all of the others.
                if (method == exchange_single_plane && wall != (wall_of(row.receiver.value) ^ 1u))
                    continue;
                square += std::pow(seen[wall] - exact(row.receiver.value, wall), 2);
                count += 1.0;
            }
        });
        return std::sqrt(square / count);
    }

    // The order of convergence with the resolution: slope of the last and the first error.
    double order(ExchangeMethod method, bool zones) const {
        const double coarse = error(method, zones, 16), fine = error(method, zones, 128);
        UNSCOPED_INFO(coarse << " " << fine);
        return std::log2(coarse / fine) / 3.0;
    }

  private:
    std::uint32_t wall_of(std::size_t patch) const {
        return side_of(enclosure_, forest_, elements_.patches[patch]);
    }

    double exact(std::size_t i, std::uint32_t wall) const {
        const bool patch = elements_.is_patch(i);
        const Point eye =
            patch ? forest_.centroid(elements_.patches[i]) : forest_.centroid(elements_.zone(i));
        std::vector<Point> corners;
        const int axis = static_cast<int>(wall / 2);
        for (int k = 0; k < 4; ++k) {
            Point corner(0.0);
            corner[axis] = wall % 2;
            corner[(axis + 1) % 3] = k == 1 || k == 2;
            corner[(axis + 2) % 3] = k >= 2;
            corners.push_back(turn_ * corner - eye);
        }
        if (!patch) return solid_angle(corners) / (4.0 * pi);
        return projected_solid_angle(corners, normal_of(forest_, elements_.patches[i])) / pi;
    }

    glm::dmat3 turn_{1.0};
    Enclosure enclosure_;
    Forest forest_;
    Elements elements_;
};

// Of all rows, by either projection: Σ|S − S'| over Σ S.
double projections_differ(const Discretization& d, ExchangeOptions options) {
    options.settings.projection = Projection::z_buffer;
    const auto drawn = all_rows(exchange_full_cube, d, options);
    std::atomic<std::size_t> lost = 0;
    options.lost_rays = &lost;
    options.settings.projection = Projection::walked;
    const auto walked = all_rows(exchange_full_cube, d, options);
    CHECK(lost == 0);
    double difference = 0.0, total = 0.0;
    for (std::size_t i = 0; i < d.elements.size(); ++i)
        for (std::uint32_t j = 0; j <= d.elements.outside(); ++j) {
            difference += std::abs(entry(drawn, i, j) - entry(walked, i, j));
            total += entry(walked, i, j);
        }
    return difference / total;
}

}  // namespace

TEST_CASE("Delta form factors are the integrals over their pixels", "[exchange]") {
    for (const std::size_t resolution : {2u, 7u, 64u}) {
        // Mixed differences telescope: what remains is rounding.
        CHECK(sum_of(hemicube_faces(resolution)) == Approx(1.0).epsilon(1e-12));
        CHECK(sum_of(full_cube_faces(resolution)) == Approx(1.0).epsilon(1e-12));
        const double s = std::sqrt(49.0 / 50.0);
        CHECK(sum_of(single_plane_faces(resolution)) ==
              Approx(4.0 / pi * s * std::atan(s)).epsilon(1e-12));
    }
    const auto check = [](const CubeFace& face, bool cosine) {
        for (std::size_t p = 0; p < face.weights.size(); ++p) {
            const std::size_t i = p % face.nu, j = p / face.nu;
            std::vector<Point> corners;
            for (int k = 0; k < 4; ++k) {
                Point corner = face.direction(i, j);
                corner[face.along_u] += (k == 1 || k == 2 ? 0.5 : -0.5) * face.u_step();
                corner[face.along_v] += (k >= 2 ? 0.5 : -0.5) * face.v_step();
                corners.push_back(corner);
            }
            const double exact = cosine ? projected_solid_angle(corners, {0, 0, 1}) / pi
                                        : solid_angle(corners) / (4.0 * pi);
            REQUIRE(face.weights[p] == Approx(exact).epsilon(1e-10));
        }
    };
    for (const auto& face : hemicube_faces(6)) check(face, true);
    for (const auto& face : single_plane_faces(6)) check(face, true);
    for (const auto& face : full_cube_faces(6)) check(face, false);
}

TEST_CASE("What a cube sees converges with its resolution", "[exchange]") {
    const PointViews straight(false), turned(true);
    // Where edges run along pixels, a whole row of them errs alike: order 1. For a patch in a room
    // that is so whichever way it is turned, as edges along its normal run along the sides' pixels.
    // Measured from 16 to 128 pixels: 0.97, 0.98, 0.96.
    CHECK(straight.order(exchange_full_cube, true) == Approx(1.0).margin(0.2));
    CHECK(straight.order(exchange_hemicube, false) == Approx(1.0).margin(0.2));
    CHECK(turned.order(exchange_hemicube, false) == Approx(1.0).margin(0.2));
    // Where edges cross pixels anyhow, the errors of n pixels of size 1/n² are independent: 3/2,
    // and the weight's curvature in a pixel has order 2. Measured: 1.57 of a full cube, 1.66 of a
    // single plane.
    CHECK(turned.order(exchange_full_cube, true) == Approx(1.5).margin(0.3));
    CHECK(turned.order(exchange_single_plane, false) == Approx(1.5).margin(0.3));
}

TEST_CASE("Unit cube: exchange areas of cubes on several points against exact figures",
          "[exchange]") {
    const auto file = test::reference("3a_box_dea_extinction");
    struct Quantity {
        std::string name;
        std::size_t from, to;
        double tolerance;
    };
    const std::vector<Quantity> quantities{{"SS_opposed_z", 4, 5, 0.002},
                                           {"SS_perp_x0_z0", 0, 4, 0.04},
                                           {"VS_ownface_x0", 6, 0, 0.02},
                                           {"VS_ownface_z0", 4, 6, 0.002},
                                           {"VV_self", 6, 6, 0.005}};
    for (const std::string kappa : {"0.1", "5"}) {
        const auto sums = test::group_exchange({.extinction = std::stod(kappa), .cells = 2},
                                               exchange_full_cube, cubes(32, 16));
        for (const auto& q : quantities) {
            const double value = test::reference_value(file, "unit_" + q.name + "_kappa" + kappa);
            INFO(q.name << " at kappa " << kappa << ": " << sums[q.from][q.to] / value - 1.0);
            CHECK(std::abs(sums[q.from][q.to] / value - 1.0) < q.tolerance);
        }
    }
}

TEST_CASE("Parallel squares by hemi-cubes and by single planes", "[exchange]") {
    const double exact = 0.199824895698387;  // Howell's catalogue, C-11
    const auto error = [&](ExchangeMethod method, const ExchangeOptions& options) {
        return test::group_exchange({.extinction = 0.0, .cells = 2}, method, options)[4][5] /
                   exact -
               1.0;
    };
    const double one = error(exchange_hemicube, cubes(64)),
                 many = error(exchange_hemicube, cubes(64, 32)),
                 coarse = error(exchange_single_plane, cubes(64, 32, true)),
                 fine = error(exchange_single_plane, cubes(256, 32, true));
    INFO(one << " " << many << " " << coarse << " " << fine);
    // One point of each of 8 triangles: 2.3 %, which more pixels do not lessen; 32 points: 0.03 %.
    CHECK(std::abs(one) < 0.03);
    CHECK(std::abs(one) > 0.015);
    CHECK(std::abs(many) < 0.002);
    // A plane's pixels are 7 times as large: 0.5 % with 64 along its edge, 0.01 % with 256.
    CHECK(std::abs(coarse) < 0.01);
    CHECK(std::abs(fine) < 0.001);
}

TEST_CASE("One cube at a zone's centroid does not do for its neighbours", "[exchange]") {
    const auto file = test::reference("3a_box_dea_extinction");
    const double self = test::reference_value(file, "unit_VV_self_kappa1"),
                 beside = test::reference_value(file, "unit_VV_face_adjacent_x_kappa1");
    // From the centroid V_kV_k is 38 % too large and V_kV_m 26 % too small at any resolution.
    for (const std::size_t resolution : {16u, 64u, 256u}) {
        const auto areas = two_cubes(1.0, cubes(resolution));
        INFO(areas[0] / self - 1.0 << " " << areas[1] / beside - 1.0);
        CHECK(areas[0] / self - 1.0 == Approx(0.376).margin(0.003));
        CHECK(areas[1] / beside - 1.0 == Approx(-0.255).margin(0.003));
    }
    // With more centres both converge.
    const auto error = [&](std::size_t centres) {
        return two_cubes(1.0, cubes(32, centres))[1] / beside - 1.0;
    };
    const double few = std::abs(error(8)), many = std::abs(error(512));
    INFO(few << " " << many);
    CHECK(std::log(few / many) / std::log(64.0) > 0.5);
    CHECK(many < 0.005);
    CHECK(two_cubes(1.0, cubes(32, 512))[0] == Approx(self).epsilon(0.005));
}

TEST_CASE("Rows of cubes close; those of single planes lack what the plane leaves out",
          "[exchange]") {
    const auto enclosure = test::crowded_cube();
    Forest forest(enclosure.mesh);
    test::bisect_some(forest, 60);
    const auto elements = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, elements};
    for (const auto projection : {Projection::z_buffer, Projection::walked})
        // Single precision of the entries, as of walked rows.
        CHECK(closure_error(all_rows(exchange_full_cube, d, cubes(16, 2, false, 1, projection)),
                            elements, 0) < 1e-7);
    const double s = std::sqrt(49.0 / 50.0), missing = 1.0 - 4.0 / pi * s * std::atan(s);
    std::vector<ElementId> patches;
    for (std::size_t i = 0; i < elements.patches.size(); ++i) patches.push_back(ElementId(i));
    std::size_t next = 0;
    exchange_single_plane(d, patches, cubes(16), [&](const Row& row) {
        REQUIRE(row.receiver == patches[next++]);
        double sum = 0.0;
        for (const double area : row.exchange_areas) sum += area;
        REQUIRE(1.0 - sum / elements.capacity[row.receiver.value] == Approx(missing).margin(1e-9));
    });
    CHECK(next == patches.size());
}

TEST_CASE("The z-buffer finds what walks through the pixels find", "[exchange]") {
    const auto enclosure = test::crowded_cube();
    Forest forest(enclosure.mesh);
    const auto whole = start_elements(enclosure, forest, Start::single_zone);
    const double of_whole = projections_differ({enclosure, forest, whole}, cubes(33, 2, true));
    // More pixels than one tile of the buffer holds.
    const double tiles = projections_differ({enclosure, forest, whole}, cubes(150, 1, true));
    test::bisect_some(forest, 100);
    const auto leaves = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, leaves};
    // Cubes turned by chance have no pixel on an edge: single precision of the walk's lengths.
    const double turned = projections_differ(d, cubes(17, 2, true));
    // Cubes along the axes have pixels on diagonals of cells: either projection may give them to
    // the one or the other side.
    const double straight = projections_differ(d, cubes(32));
    INFO(of_whole << " " << turned << " " << tiles << " " << straight);
    CHECK(of_whole < 1e-6);
    CHECK(turned < 1e-6);
    CHECK(tiles < 1e-6);
    CHECK(straight < 0.02);
}

TEST_CASE("Random offsets are right in the mean over seeds", "[exchange]") {
    const auto file = test::reference("3a_box_dea_extinction");
    struct Quantity {
        std::string name;
        std::size_t from, to;
        double sum = 0.0, squares = 0.0;
    };
    std::vector<Quantity> quantities{{"SS_opposed_z", 4, 5},
                                     {"SS_perp_x0_z0", 0, 4},
                                     {"VS_ownface_z0", 4, 6},
                                     {"VS_ownface_x0", 6, 0},
                                     {"VV_self", 6, 6}};
    constexpr int seeds = 32;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto sums = test::group_exchange(
            {}, exchange_full_cube,
            cubes(32, 8, true, static_cast<std::uint64_t>(seed), Projection::walked));
        for (auto& q : quantities) {
            const double error =
                sums[q.from][q.to] / test::reference_value(file, "unit_" + q.name + "_kappa1") -
                1.0;
            q.sum += error;
            q.squares += error * error;
        }
    }
    for (const auto& q : quantities) {
        const double mean = q.sum / seeds;
        const double deviation = std::sqrt((q.squares / seeds - mean * mean) / (seeds - 1));
        INFO(q.name << ": " << mean << " ± " << deviation);
        // Turns about the normal leave a patch's pixels at their angles from it: a bias of the
        // second order in the resolution, here about 0.1 % at 32, under the deviation. Zones have
        // none.
        CHECK(std::abs(mean) < 3.0 * deviation);
    }
}

TEST_CASE("Projections onto cubes have the same bits at one thread and at two", "[exchange]") {
    const auto enclosure = test::crowded_cube();
    const Forest forest(enclosure.mesh);
    const auto elements = elements_of_leaves(enclosure, forest);
    const auto at = [&](std::size_t threads, Projection projection) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return all_rows(exchange_full_cube, {enclosure, forest, elements},
                        cubes(16, 2, true, 1, projection));
    };
    for (const auto projection : {Projection::z_buffer, Projection::walked}) {
        const auto one = at(1, projection), two = at(2, projection);
        CHECK(one.starts == two.starts);
        CHECK(one.columns == two.columns);
        CHECK(one.values == two.values);
    }
}

TEST_CASE("Hemi-cube and single plane refuse rows of media, and say what can make them",
          "[exchange]") {
    const auto enclosure = test::cube_enclosure({});
    const Forest forest(enclosure.mesh);
    const auto elements = elements_of_leaves(enclosure, forest);
    const Discretization d{enclosure, forest, elements};
    const auto message = [&](std::string_view name) -> std::string {
        const auto& method = exchange_method(name);
        CHECK(!method.moments);
        CHECK(!method.detail);
        try {
            all_rows(method.method, d, cubes(8));
        } catch (const mesh::InputError& error) {
            return error.what();
        }
        return "";
    };
    CHECK(message("full_cube") == "");
    for (const std::string name : {"hemicube", "single_plane"})
        for (const std::string part : {name.c_str(), "haze", "full_cube", "walked"})
            CHECK_THAT(message(name), Contains(part));
    CHECK_THAT(message("single_plane"), Contains("grazing"));
    // Rows of patches see media all the same, as the full cube's do.
    const std::vector<ElementId> patches{ElementId(0), ElementId(5)};
    std::vector<double> areas;
    exchange_hemicube(d, patches, cubes(8), [&](const Row& row) {
        areas.insert(areas.end(), row.exchange_areas.begin(), row.exchange_areas.end());
    });
    std::size_t k = 0;
    exchange_full_cube(d, patches, cubes(8), [&](const Row& row) {
        for (const double area : row.exchange_areas) CHECK(area == areas.at(k++));
    });
    CHECK(k == areas.size());
}
