#include "radiosity/error_estimate.h"

#include <cmath>

#include "radiosity/adaptive.h"
#include "support/catch.h"
#include "support/rooms.h"

using namespace tyndall;
using radiosity::ErrorParts;

namespace {

radiosity::Report report_of(const radiosity::SolveOptions& options,
                            const std::optional<radiosity::View>& view = {}) {
    const auto enclosure =
        std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(test::slit_room()));
    return radiosity::solve_adaptively(enclosure, options, view).report;
}

// Into the room beside the lamp, from a corner.
radiosity::View view() {
    radiosity::View v;
    v.eye = {2.9, 0.3, 1.0};
    v.forward = glm::normalize(mesh::Direction(-1.0, 0.6, 0.0));
    v.up = {0, 0, 1};
    v.right = glm::cross(v.forward, v.up);
    return v;
}

radiosity::SolveOptions few_rays() {
    radiosity::SolveOptions options;
    options.refinement = radiosity::Refinement::uniform;
    options.element_size = 1.5;
    options.rays = options.gather_rays = 16;
    return options;
}

}  // namespace

TEST_CASE("An error is carried through the rows as light is") {
    const auto enclosure = radiosity::make_enclosure(test::slit_room());
    const radiosity::Forest forest(enclosure.mesh);
    radiosity::SolveOptions options;
    options.rays = 64;
    radiosity::CoarseSolution solution(enclosure, forest, options, {});
    const std::size_t n = solution.elements().size();
    std::vector<double> incident(n), departure(n);
    for (std::size_t i = 0; i < n; ++i) {
        incident[i] = 1.0 + 0.1 * static_cast<double>(i % 7);
        departure[i] = 0.3 * std::sin(static_cast<double>(i));
    }
    solution.solve(incident);
    std::vector<double> before(n);
    for (std::size_t i = 0; i < n; ++i) before[i] = solution.indirect(i, 0);
    const auto carried = solution.carried(departure);
    // More incident light everywhere by the departure: indirect light rises by what is carried.
    for (std::size_t i = 0; i < n; ++i) incident[i] += departure[i];
    solution.solve(incident);
    double square = 0.0, off = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        square += carried[i] * carried[i];
        off += std::pow(solution.indirect(i, 0) - before[i] - carried[i], 2);
    }
    REQUIRE(square > 0.0);
    // `carried` solves to 1 %.
    CHECK(std::sqrt(off / square) < 0.02);
}

TEST_CASE("Errors are estimated whatever the refinement, of the picture where there is a camera") {
    auto options = few_rays();
    const auto uniform = report_of(options, view());
    REQUIRE(uniform.picture_error);
    CHECK(uniform.picture_error->elements > 0.0);
    CHECK(uniform.picture_error->gathers > 0.0);
    CHECK(uniform.picture_error->coarse > 0.0);
    // It refines for nothing: what counts is the solution.
    CHECK(uniform.estimated_error == uniform.solution_error.total());
    CHECK(!report_of(options).picture_error);
    options.refinement = radiosity::Refinement::view;
    options.error = 0.3;
    const auto seen = report_of(options, view());
    REQUIRE(seen.picture_error);
    CHECK(seen.estimated_error == seen.picture_error->total());
    CHECK(seen.picture_error->elements < uniform.picture_error->elements);
}

TEST_CASE("More rays leave less noise, finer elements less of what elements leave", "[long]") {
    auto options = few_rays();
    const ErrorParts few = report_of(options).solution_error;
    options.gather_rays = 256;
    const ErrorParts many = report_of(options).solution_error;
    // 16 times the rays: a quarter for independent ones. Half of that gain must be seen.
    CHECK(many.gathers < 0.5 * few.gathers);
    options.element_size = 0.75;
    const ErrorParts fine = report_of(options).solution_error;
    CHECK(fine.elements < 0.8 * many.elements);
}

TEST_CASE("Noise that keeps a run from its goal is told") {
    auto options = few_rays();
    options.refinement = radiosity::Refinement::adaptive;
    options.rays = options.gather_rays = 2;
    options.error = 0.08;
    options.max_elements = 4000;
    const auto report = report_of(options);
    const bool told = std::any_of(
        report.warnings.begin(), report.warnings.end(),
        [](const std::string& w) { return w.find("raise solve.gather_rays") != w.npos; });
    CHECK(told);
}

TEST_CASE("Estimates have the same bits at one thread and two") {
    auto options = few_rays();
    options.threads = 1;
    const auto one = report_of(options, view());
    options.threads = 2;
    const auto two = report_of(options, view());
    CHECK(one.picture_error->total() == two.picture_error->total());
    CHECK(one.solution_error.total() == two.solution_error.total());
}
