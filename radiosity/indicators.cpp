#include "radiosity/indicators.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "mesh/walk.h"

namespace tyndall::radiosity {
namespace {

// How far beyond a face the neighbour is looked for, of the way from the leaf's centroid.
constexpr double beyond = 1e-4;
// Of optical thickness: see thickness_error.
constexpr double thick_rate = 0.29;

// The index of the corner whose barycentric coordinate is the most negative at x; −1 if none is.
int outside_of(const std::array<Point, 4>& p, Point x) {
    const auto volume = [](Point a, Point b, Point c, Point d) {
        return glm::dot(glm::cross(b - a, c - a), d - a);
    };
    const double whole = volume(p[0], p[1], p[2], p[3]);
    const std::array<double, 4> w{
        volume(x, p[1], p[2], p[3]) / whole, volume(p[0], x, p[2], p[3]) / whole,
        volume(p[0], p[1], x, p[3]) / whole, volume(p[0], p[1], p[2], x) / whole};
    const auto least = std::min_element(w.begin(), w.end());
    return *least < 0.0 ? static_cast<int>(least - w.begin()) : -1;
}

// The leaf at x, just beyond a face of `zone`, if it is of the same medium and nothing opaque lies
// between.
ZoneId leaf_beyond(const JudgedElement& e, ZoneId zone, Point x) {
    const auto& base = e.enclosure.mesh;
    const TetId tet = e.forest.base_tet(zone);
    std::array<Point, 4> corners;
    for (int c = 0; c < 4; ++c) corners[c] = base.points[base.tets[tet.value][c].value];
    const int face = outside_of(corners, x);
    if (face < 0) return e.forest.leaf_at(mesh::root_zone(tet), x);
    const auto facet = base.tet_facets[tet.value][face];
    if (facet.valid() && base.facets[facet.value].opacity == mesh::Opacity::opaque) return {};
    const TetId next = base.neighbours[tet.value][face];
    if (!next.valid()) return {};
    const ZoneId root = mesh::root_zone(next);
    if (medium_of(e.enclosure, e.forest, root) != medium_of(e.enclosure, e.forest, zone)) return {};
    return e.forest.leaf_at(root, x);
}

// Mean over bands of the square of what two leaves' functions differ by at x.
template <class Node>
double squared_difference(const Fields& fields, Node one, Node other, Point x) {
    double sum = 0.0;
    for (std::size_t b = 0; b < fields.bands; ++b)
        sum += std::abs(fields.at(one, b).at(x) - fields.at(other, b).at(x));
    sum /= static_cast<double>(fields.bands);
    return sum * sum;
}

double jump_of(const JudgedElement& e, ZoneId zone) {
    const auto& vertices = e.forest[zone].corners;
    const Point centroid = e.forest.centroid(zone);
    double sum = 0.0;
    int count = 0;
    for (const auto& face : mesh::face_corners) {
        const std::array<VertexId, 3> corners{vertices[face[0]], vertices[face[1]],
                                              vertices[face[2]]};
        if (e.mesh.on_one_shadow(corners)) continue;
        Point middle(0.0);
        for (const VertexId v : corners) middle += e.forest.point(v) / 3.0;
        const ZoneId other = leaf_beyond(e, zone, middle + beyond * (middle - centroid));
        if (!other.valid() || other == zone) continue;
        sum += squared_difference(e.radiance, zone, other, middle);
        ++count;
    }
    return count > 0 ? 0.5 * std::sqrt(sum / count) : 0.0;
}

double jump_of(const JudgedElement& e, PatchId patch) {
    const auto& vertices = e.forest[patch].corners;
    const Direction normal = normal_of(e.forest, patch);
    const auto neighbours = e.mesh.neighbours(patch);
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < 3; ++k) {
        const PatchId other = neighbours[k];
        const std::array<VertexId, 2> ends{vertices[(k + 1) % 3], vertices[(k + 2) % 3]};
        if (!other.valid() || e.mesh.on_one_shadow(ends)) continue;
        if (glm::dot(normal, normal_of(e.forest, other)) < 1.0 - mesh::coplanar) continue;
        const Point middle = 0.5 * (e.forest.point(ends[0]) + e.forest.point(ends[1]));
        sum += squared_difference(e.radiance, patch, other, middle);
        ++count;
    }
    return count > 0 ? 0.5 * std::sqrt(sum / count) : 0.0;
}

float checked(double error, const char* kind, std::uint32_t index) {
    if (std::isfinite(error) && error >= 0.0) return static_cast<float>(error);
    throw mesh::InputError(
        fmt::format("an error indicator returned {} for {} {}: an error is finite and not negative "
                    "[W/m^2/sr].",
                    error, kind, index));
}

}  // namespace

double jump_error(const JudgedElement& element) {
    return std::visit([&](auto node) { return jump_of(element, node); }, element.node);
}

double thickness_error(const JudgedElement& element) {
    const auto* zone = std::get_if<ZoneId>(&element.node);
    if (!zone) return 0.0;
    const std::size_t bands = element.enclosure.bands;
    const double size = std::cbrt(element.forest.volume(*zone));
    double sum = 0.0;
    for (std::size_t b = 0; b < bands; ++b) {
        const double extinction = extinction_in(element.enclosure, element.forest, *zone, b).mean;
        sum -= std::expm1(-thick_rate * extinction * size) * size *
               glm::length(element.radiance.at(*zone, b).gradient);  // (28)
    }
    return sum / static_cast<double>(bands);
}

const std::vector<NamedIndicator>& indicators() {
    static const std::vector<NamedIndicator> table{{"direct", {}},
                                                   {"shadow_boundary", {}},
                                                   {"indirect", {}},
                                                   {"jump", jump_error},
                                                   {"optical_thickness", thickness_error}};
    return table;
}

bool asks_for(const SolveOptions& options, std::string_view name) {
    return std::find(options.indicators.begin(), options.indicators.end(), name) !=
           options.indicators.end();
}

void check_indicators(const SolveOptions& options) {
    std::string known;
    for (const auto& indicator : indicators()) known += fmt::format(" \"{}\"", indicator.name);
    for (const std::string& name : options.indicators)
        if (std::none_of(indicators().begin(), indicators().end(),
                         [&](const auto& known_one) { return known_one.name == name; }))
            throw mesh::InputError(
                fmt::format("there is no error indicator \"{}\". There are:{}.", name, known));
    if (!(options.optical_thickness > 0.0))
        throw mesh::InputError(
            fmt::format("optical_thickness {} is not above 0. Give one such as "
                        "0.5.",
                        options.optical_thickness));
}

IndicatedErrors indicated_errors(const std::vector<Indicator>& asked, const Enclosure& enclosure,
                                 const ElementMesh& mesh, const Fields& radiance) {
    const Forest& forest = mesh.forest();
    IndicatedErrors errors;
    errors.zone.resize(forest.zone_count());
    errors.patch.resize(forest.patch_count());
    for (const Indicator& indicator : asked) {
        for (const ZoneId z : mesh.zones())
            if (forest.is_leaf(z))
                errors.zone[z.value] = std::max(
                    errors.zone[z.value],
                    checked(indicator({enclosure, mesh, forest, radiance, z}), "zone", z.value));
        for (const PatchId p : mesh.patches())
            if (forest.is_leaf(p))
                errors.patch[p.value] = std::max(
                    errors.patch[p.value],
                    checked(indicator({enclosure, mesh, forest, radiance, p}), "patch", p.value));
    }
    return errors;
}

}  // namespace tyndall::radiosity
