// Exchange areas of unit cubes and their faces, summed from walked rows, against exact figures.
#include <cmath>
#include <string>

#include "mesh/catch.h"
#include "support/cube.h"
#include "support/reference.h"

using namespace tyndall;

namespace {

std::string with(const std::string& name, const std::string& kappa) {
    return "unit_" + name + "_kappa" + kappa;
}

}  // namespace

TEST_CASE("Unit cube: V_kV_k, V_kS_j, S_iS_j of walked rows", "[exchange]") {
    const auto file = test::reference("3a_box_dea_extinction");
    struct Quantity {
        std::string name;
        std::size_t from, to;  // groups: walls 0 to 5, the cube 6
    };
    const std::vector<Quantity> quantities{
        {"SS_opposed_z", 4, 5},  {"SS_perp_x0_z0", 0, 4}, {"SS_perp_y0_z0", 2, 4},
        {"VS_ownface_x0", 6, 0}, {"VS_ownface_y0", 6, 2}, {"VS_ownface_z0", 6, 4},
        {"VS_ownface_x0", 0, 6}, {"VS_ownface_z0", 4, 6}, {"VV_self", 6, 6}};
    for (const std::string kappa : {"0.1", "0.5", "1", "2", "5"}) {
        // Two cells a side: 8 patches a wall and 48 tets, 256 rays each.
        const auto sums =
            test::group_exchange({.extinction = std::stod(kappa), .cells = 2}, 256, 1);
        for (const auto& q : quantities) {
            const double value = test::reference_value(file, with(q.name, kappa));
            const double error = sums[q.from][q.to] / value - 1.0;
            INFO(q.name << " at kappa " << kappa << ": relative error " << error);
            CHECK(std::abs(error) < 0.005);
        }
    }
}

TEST_CASE("Unit cubes apart: V_kV_m and V_kS_j of walked rows", "[exchange]") {
    const auto file = test::reference("3a_box_dea_extinction");
    struct Quantity {
        std::string name;
        std::array<int, 3> size;
        std::size_t from, to;
    };
    const auto cell = [](int x, int y, int z) { return 6u + x + 4 * (y + 2 * z); };
    const std::vector<Quantity> quantities{
        {"VV_face_adjacent_x", {4, 2, 2}, cell(0, 0, 0), cell(1, 0, 0)},
        {"VV_edge_adjacent_xy", {4, 2, 2}, cell(0, 0, 0), cell(1, 1, 0)},
        {"VV_vertex_adjacent", {4, 2, 2}, cell(0, 0, 0), cell(1, 1, 1)},
        {"VV_two_apart_x", {4, 2, 2}, cell(0, 0, 0), cell(2, 0, 0)},
        {"VV_offset_3_1_0", {4, 2, 2}, cell(0, 0, 0), cell(3, 1, 0)},
        {"VS_adjacent_farface_x2", {2, 1, 1}, 6, 1},
        {"VS_twoapart_farface_x3", {3, 1, 1}, 6, 1}};
    for (const std::string kappa : {"0.1", "1"})
        for (const auto& q : quantities) {
            const auto sums = test::group_exchange(
                {.extinction = std::stod(kappa), .size = q.size, .cells = 1}, 4096, 1);
            const double value = test::reference_value(file, with(q.name, kappa));
            const double error = sums[q.from][q.to] / value - 1.0;
            INFO(q.name << " at kappa " << kappa << ": relative error " << error);
            CHECK(std::abs(error) < 0.02);
        }
}
