#include "mesh/tetrahedralize.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <set>

#include "mesh/base_mesh_build.h"
#include "mesh/input_error.h"
#include "mesh/tetgen_process.h"
#include "mesh/trouble.h"

namespace tyndall::mesh {

namespace {

struct Attempt {
    std::string switches;
    double cpu_seconds;
    bool turned = false;  // the input (see Turn)
};

// From the best mesh to the surest. Mild quality first: bisection never mends slivers. Small
// features and nearly coplanar facets would keep TetGen adding points for ever, so it may add only
// some (-S), and not take long; it counts its own seconds, for the result should not depend on what
// else runs. On symmetric input (a panel that floats in a room, all on round coordinates) an
// assertion of TetGen may fail: next the same, turned out of the axes. Then without merging facets
// on the same polygons (-M), then without quality, then facets left unsplit (-Y).
std::vector<Attempt> attempts(std::size_t facets) {
    const auto points = 500 + facets / 2;
    const double seconds = 6.0 + 1e-3 * static_cast<double>(facets);
    const auto quality = fmt::format("pq2.0S{}Q", points);
    return {{quality, seconds},
            {quality, seconds, true},
            {fmt::format("pq2.0MS{}Q", points), seconds},
            {"pQ", 3.0 * seconds},
            {"pMQ", 3.0 * seconds},
            {"pQ", 3.0 * seconds, true},
            {"pYMQ", 1e9}};
}

// A rotation about the hull's middle by an angle and an axis that no scene has by design.
class Turn {
  public:
    explicit Turn(const tetgen::Hull& hull) : centre_(0.5 * (hull.min + hull.max)) {
        const auto axis = glm::normalize(glm::dvec3(0.36, 0.71, 0.53));
        const auto u = glm::normalize(glm::cross(axis, glm::dvec3(1, 0, 0)));
        const auto v = glm::cross(axis, u);
        constexpr double angle = 0.6180339887;
        const glm::dmat3 frame(axis, u, v);
        const glm::dmat3 about_first(1, 0, 0, 0, std::cos(angle), std::sin(angle), 0,
                                     -std::sin(angle), std::cos(angle));
        matrix_ = frame * about_first * glm::transpose(frame);
    }

    tetgen::Input apply(tetgen::Input input) const {
        for (Point& p : input.points) p = centre_ + matrix_ * (p - centre_);
        return input;
    }
    // TetGen gives the input's points first, in order: they get their own coordinates to the last
    // bit.
    void undo(tetgen::Output& output, const tetgen::Input& input) const {
        const auto back = glm::transpose(matrix_);
        for (std::size_t k = 0; k < output.points.size(); ++k)
            output.points[k] = k < input.points.size()
                                   ? input.points[k]
                                   : centre_ + back * (output.points[k] - centre_);
    }

  private:
    Point centre_;
    glm::dmat3 matrix_;
};

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

tetgen::Hull hull_around(const ConformingComplex& complex, double margin) {
    tetgen::Hull hull{complex.points.front(), complex.points.front()};
    for (const auto& point : complex.points) {
        hull.min = glm::min(hull.min, point);
        hull.max = glm::max(hull.max, point);
    }
    const Point grow(margin * glm::distance(hull.min, hull.max));
    return {hull.min - grow, hull.max + grow};
}

tetgen::Input input_of(const ConformingComplex& complex, const FacetGroups& groups,
                       const tetgen::Hull& hull) {
    tetgen::Input input;
    input.points = complex.points;
    for (std::size_t f = 0; f < complex.facets.size(); ++f) {
        const auto& corners = complex.facets[f].corners;
        input.triangles.push_back({corners[0].value, corners[1].value, corners[2].value});
        input.triangle_markers.push_back(static_cast<std::int32_t>(groups.group(FacetId(f)) + 1));
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
        input.quad_markers.push_back(static_cast<std::int32_t>(groups.size() + 1));
    }
    return input;
}

// The facets that TetGen's own check finds crossing, or none.
std::vector<FacetId> diagnose(const std::filesystem::path& worker, const tetgen::Input& input,
                              const FacetGroups& groups, const tetgen::Limits& limits) {
    const auto result = tetgen::run(worker, "pdQ", input, limits);
    std::set<FacetId> facets;
    if (result.outcome == tetgen::Outcome::done && result.output.tets.empty()) {
        for (const auto marker : result.output.face_markers) {
            if (marker >= 1 && static_cast<std::size_t>(marker) <= groups.size()) {
                facets.insert(groups.members(marker - 1).front());
            }
        }
    }
    return {facets.begin(), facets.end()};
}

struct Failure {
    tetgen::Outcome outcome;
    std::string message;
    FacetId facet;
};

class Mesher {
  public:
    Mesher(const ConformingComplex& complex, const TetrahedralizeOptions& options)
        : complex_(complex),
          options_(options),
          worker_(tetgen::find_worker(options.worker)),
          hull_(hull_around(complex, options.hull_margin)),
          groups_(complex),
          input_(input_of(complex, groups_, hull_)),
          turn_(hull_) {}

    // Nothing, and one more failure noted, if this attempt came to no mesh.
    std::optional<BaseMesh> attempt(const Attempt& attempt) {
        if (!failures_.empty() && remaining() <= 0.0) {
            return {};
        }
        auto result =
            tetgen::run(worker_, attempt.switches, attempt.turned ? turn_.apply(input_) : input_,
                        {remaining(), attempt.cpu_seconds, options_.max_bytes});
        if (attempt.turned && result.outcome == tetgen::Outcome::done)
            turn_.undo(result.output, input_);
        if (result.outcome != tetgen::Outcome::done) {
            failures_.push_back({result.outcome, result.message, {}});
            return {};
        }
        try {
            return tetgen::build_base_mesh(result.output, complex_, groups_, hull_);
        } catch (const tetgen::Fault& fault) {
            failures_.push_back({tetgen::Outcome::refused, fault.what(), fault.facet});
            return {};
        }
    }

    [[noreturn]] void give_up(std::span<const Polygon> polygons) const {
        const auto& last = failures_.back();
        if (last.outcome == tetgen::Outcome::out_of_memory) {
            throw InputError(
                fmt::format("Meshing {} facets needs more than the {:.3g} MB allowed ({}). Allow "
                            "more memory or "
                            "simplify the surfaces.",
                            complex_.facets.size(),
                            static_cast<double>(options_.max_bytes) / 1048576.0, last.message));
        }
        if (last.outcome == tetgen::Outcome::out_of_time) {
            throw InputError(fmt::format(
                "Meshing {} facets takes more than the {:.3g} s allowed ({}). Allow more time or "
                "simplify the surfaces.",
                complex_.facets.size(), options_.max_seconds, last.message));
        }
        throw InputError(fmt::format(
            "TetGen cannot mesh these surfaces: {}. {} Move surfaces that nearly touch apart, or "
            "let them coincide.",
            last.message, place(polygons, last.facet)));
    }

  private:
    // The best guess at where: an exact crossing, TetGen's own finding, the facet that failed a
    // check, the narrowest gap.
    std::string place(std::span<const Polygon> polygons, FacetId failed) const {
        const auto trouble = find_trouble(complex_);
        const auto at = [](Point x) {
            return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x, x.y, x.z);
        };
        const auto names = [&](std::span<const FacetId> facets) {
            return names_of(facets, complex_, polygons);
        };
        if (trouble && trouble->gap == 0.0) {
            const FacetId pair[] = {trouble->first, trouble->second};
            return fmt::format("{} cross or overlap near {}.", names(pair), at(trouble->where));
        }
        auto found = diagnose(worker_, input_, groups_, {20.0, 20.0, options_.max_bytes});
        if (found.empty() && failed.valid()) {
            found.push_back(failed);
        }
        if (!found.empty()) {
            const auto corner = complex_.facets[found.front().value].corners[0];
            return fmt::format("Look at {} near {}.", names(found),
                               at(complex_.points[corner.value]));
        }
        if (trouble) {
            const FacetId pair[] = {trouble->first, trouble->second};
            return fmt::format("{} come within {:.3g} m of each other near {}.", names(pair),
                               trouble->gap, at(trouble->where));
        }
        return "No single place was found.";
    }

    double remaining() const {
        const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start_;
        return std::max(options_.max_seconds - used.count(), 0.0);
    }

    const ConformingComplex& complex_;
    const TetrahedralizeOptions& options_;
    std::filesystem::path worker_;
    tetgen::Hull hull_;
    FacetGroups groups_;
    tetgen::Input input_;
    Turn turn_;
    std::vector<Failure> failures_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

BaseMesh tetrahedralize(const ConformingComplex& complex, std::span<const Polygon> polygons,
                        const TetrahedralizeOptions& options) {
    check(complex, options);
    Mesher mesher(complex, options);
    for (const auto& attempt : attempts(complex.facets.size())) {
        if (auto mesh = mesher.attempt(attempt)) {
            return std::move(*mesh);
        }
    }
    mesher.give_up(polygons);
}

}  // namespace tyndall::mesh
