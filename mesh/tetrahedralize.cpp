#include "mesh/tetrahedralize.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <set>

#include "mesh/base_mesh_build.h"
#include "mesh/input_error.h"
#include "mesh/tetgen_process.h"

namespace tyndall::mesh {

namespace {

using namespace tetgen;

// Mild quality first: bisection never mends slivers. It does not always come to an end on nearly
// coplanar facets, hence its short time. Then facets left as they are.
struct Attempt {
    const char* switches;
    double seconds;
};
constexpr Attempt attempts[] = {{"pq2.0Q", 20.0}, {"pYQ", 1e9}};

void check(const ConformingComplex& complex, const TetrahedralizeOptions& options) {
    if (complex.facets.empty()) {
        throw InputError("There are no surfaces to mesh. Add at least one.");
    }
    if (!(options.hull_margin >= 1e-6 && options.hull_margin <= 1e6)) {
        throw InputError(
            fmt::format("The hull's margin is {}. It must be at least 1e-6 (no surface "
                        "may lie on the hull) and at most 1e6.",
                        options.hull_margin));
    }
    if (!(options.max_seconds > 0.0)) {
        throw InputError(
            fmt::format("TetGen's time limit is {} s. It must be above 0.", options.max_seconds));
    }
    for (const auto& point : complex.points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) {
            throw InputError("A point of the complex is not finite. Check the coordinates.");
        }
    }
}

Hull hull_around(const ConformingComplex& complex, double margin) {
    Hull hull{complex.points.front(), complex.points.front()};
    for (const auto& point : complex.points) {
        hull.min = glm::min(hull.min, point);
        hull.max = glm::max(hull.max, point);
    }
    const Point grow(margin * glm::distance(hull.min, hull.max));
    return {hull.min - grow, hull.max + grow};
}

Input input_of(const ConformingComplex& complex, const Hull& hull) {
    Input input;
    input.points = complex.points;
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
        const auto& corners = complex.facets[f].corners;
        input.triangles.push_back({corners[0].value, corners[1].value, corners[2].value});
        input.triangle_markers.push_back(static_cast<std::int32_t>(f + 1));
    }
    const auto first = static_cast<std::uint32_t>(input.points.size());
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
        input.points.push_back({corner & 1 ? hull.max.x : hull.min.x,
                                corner & 2 ? hull.max.y : hull.min.y,
                                corner & 4 ? hull.max.z : hull.min.z});
    }
    const std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
    for (const auto& side : sides) {
        input.quads.push_back({first + side[0], first + side[1], first + side[2], first + side[3]});
        input.quad_markers.push_back(static_cast<std::int32_t>(complex.facets.size() + 1));
    }
    return input;
}

// Where TetGen stumbles: the facets that its own check finds crossing, or none.
std::vector<FacetId> diagnose(const std::filesystem::path& worker, const Input& input,
                              const ConformingComplex& complex, const Limits& limits) {
    const auto result = run(worker, "pdQ", input, {std::min(limits.seconds, 20.0), limits.bytes});
    std::set<FacetId> facets;
    if (result.outcome == Outcome::done && result.output.tets.empty()) {
        for (const auto marker : result.output.face_markers) {
            if (marker >= 1 && static_cast<std::size_t>(marker) <= complex.facets.size()) {
                facets.insert(FacetId(marker - 1));
            }
        }
    }
    return {facets.begin(), facets.end()};
}

std::string describe(const std::vector<FacetId>& facets, const ConformingComplex& complex,
                     std::span<const Polygon> polygons) {
    std::set<std::string> names;
    for (const auto facet : facets) {
        for (const auto polygon : complex.facets[facet.value].polygons) {
            const auto& name =
                polygon.value < polygons.size() ? polygons[polygon.value].name : std::string();
            names.insert(name.empty() ? fmt::format("polygon {}", polygon.value)
                                      : fmt::format("\"{}\"", name));
        }
    }
    std::string list;
    std::size_t listed = 0;
    for (const auto& name : names) {
        if (++listed > 6) {
            list += fmt::format(" and {} more", names.size() - 6);
            break;
        }
        list += (list.empty() ? "" : ", ") + name;
    }
    const auto& at = complex.points[complex.facets[facets.front().value].corners[0].value];
    return fmt::format("{} near ({:.6g}, {:.6g}, {:.6g})", list, at.x, at.y, at.z);
}

struct Failure {
    Outcome outcome;
    std::string message;
    FacetId facet;
};

class Mesher {
  public:
    Mesher(const ConformingComplex& complex, const TetrahedralizeOptions& options)
        : complex_(complex),
          options_(options),
          worker_(find_worker(options.worker)),
          hull_(hull_around(complex, options.hull_margin)),
          input_(input_of(complex, hull_)) {}

    // Nothing, and one more failure noted, if this attempt came to no mesh.
    std::optional<BaseMesh> attempt(const Attempt& attempt) {
        const double seconds = std::min(attempt.seconds, remaining());
        const auto result = run(worker_, attempt.switches, input_, {seconds, options_.max_bytes});
        if (result.outcome != Outcome::done) {
            failures_.push_back({result.outcome, result.message, {}});
            return {};
        }
        try {
            return build_base_mesh(result.output, complex_, hull_);
        } catch (const Fault& fault) {
            failures_.push_back({Outcome::refused, fault.what(), fault.facet});
            return {};
        }
    }

    [[noreturn]] void give_up(std::span<const Polygon> polygons) const {
        const auto& last = failures_.back();
        if (last.outcome == Outcome::out_of_memory) {
            throw InputError(
                fmt::format("Meshing {} facets needs more than the {:.3g} MB allowed ({}). Allow "
                            "more memory or "
                            "simplify the surfaces.",
                            complex_.facets.size(),
                            static_cast<double>(options_.max_bytes) / 1048576.0, last.message));
        }
        if (last.outcome == Outcome::out_of_time) {
            throw InputError(fmt::format(
                "Meshing {} facets takes more than the {:.3g} s allowed ({}). Allow more time or "
                "simplify the surfaces.",
                complex_.facets.size(), options_.max_seconds, last.message));
        }
        auto where = diagnose(worker_, input_, complex_, {20.0, options_.max_bytes});
        if (where.empty() && last.facet.valid()) {
            where.push_back(last.facet);
        }
        throw InputError(fmt::format(
            "TetGen cannot mesh these surfaces: {}. {}. Move surfaces that nearly touch apart, or "
            "let them coincide.",
            last.message,
            where.empty() ? "No single place was found"
                          : "Look at " + describe(where, complex_, polygons)));
    }

  private:
    double remaining() const {
        const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start_;
        return std::max(options_.max_seconds - used.count(), 0.0);
    }

    const ConformingComplex& complex_;
    const TetrahedralizeOptions& options_;
    std::filesystem::path worker_;
    Hull hull_;
    Input input_;
    std::vector<Failure> failures_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

BaseMesh tetrahedralize(const ConformingComplex& complex, std::span<const Polygon> polygons,
                        const TetrahedralizeOptions& options) {
    check(complex, options);
    Mesher mesher(complex, options);
    for (const auto& attempt : attempts) {
        if (auto mesh = mesher.attempt(attempt)) {
            return std::move(*mesh);
        }
    }
    mesher.give_up(polygons);
}

}  // namespace tyndall::mesh
