#include "radiosity/cube_centres.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tyndall::radiosity {
namespace {

// About z = the unit vector n, turned by an angle [rad]; without one, as cosine_direction has it.
glm::dmat3 axes_about(Direction n, double angle) {
    const Direction axis = std::abs(n.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
    const Direction a = glm::normalize(glm::cross(axis, n)), b = glm::cross(n, a);
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * a + s * b, c * b - s * a, n};
}

double angle_of(double u) {
    return 2.0 * std::numbers::pi * u;
}

// A number in [0, 1) from the last stream of a hash.
double uniform(std::uint64_t seed, std::uint64_t index) {
    return 0x1p-53 * static_cast<double>(hash_seed(seed ^ 0x7475726eull, index) >> 11);
}

// Whether x, in the plane of a patch, lies in it, or x in a zone; rims count.
bool holds(const Forest& forest, PatchId patch, Point x) {
    constexpr double rim = -1e-9;  // of the triangle's area, far above rounding
    const auto& c = forest[patch].corners;
    const Point a = forest.point(c[0]), b = forest.point(c[1]), d = forest.point(c[2]);
    const Direction n = glm::cross(b - a, d - a);
    const double least =
        std::min({glm::dot(n, glm::cross(b - a, x - a)), glm::dot(n, glm::cross(d - b, x - b)),
                  glm::dot(n, glm::cross(a - d, x - d))});
    return least >= rim * glm::dot(n, n);
}

bool holds(const Forest& forest, ZoneId zone, Point x) {
    constexpr double rim = -1e-9;
    const auto& c = forest[zone].corners;
    for (int k = 0; k < 4; ++k) {
        const auto& f = mesh::face_corners[k];
        const Point a = forest.point(c[f[0]]);
        const Direction n =
            glm::cross(forest.point(c[f[1]]) - a, forest.point(c[f[2]]) - a);  // outward
        const double height = glm::dot(n, forest.point(c[k]) - a);             // negative
        if (glm::dot(n, x - a) / height < rim) return false;
    }
    return true;
}

// The centroid of an element and the member that it lies in; of the nearest member, should it lie
// in none.
template <class Node>
std::pair<std::uint32_t, Point> centroid_of(const Discretization& d, std::size_t element) {
    const auto members = d.elements.members_of(element);
    if (members.size() == 1) return {members[0], d.forest.centroid(Node(members[0]))};
    const auto ends = std::span(d.elements.member_ends)
                          .subspan(d.elements.member_starts[element], members.size());
    Point centroid(0.0);
    for (std::size_t k = 0; k < members.size(); ++k)
        centroid += (ends[k] - (k > 0 ? ends[k - 1] : 0.0)) * d.forest.centroid(Node(members[k]));
    std::uint32_t nearest = members[0];
    const auto distance = [&](std::uint32_t member) {
        return glm::distance(d.forest.centroid(Node(member)), centroid);
    };
    for (const std::uint32_t member : members) {
        if (holds(d.forest, Node(member), centroid)) return {member, centroid};
        if (distance(member) < distance(nearest)) nearest = member;
    }
    return {nearest, d.forest.centroid(Node(nearest))};
}

}  // namespace

CubeCentres::CubeCentres(const Discretization& discretization, const ExchangeSettings& settings,
                         std::uint64_t seed)
    : d_(discretization), settings_(settings), seed_(seed), points_(settings.centres) {}

CubeCentre CubeCentres::operator()(std::size_t element, std::size_t index) const {
    if (settings_.random_offsets) return at_point(element, index, hash_seed(seed_, element));
    return count() == 1 ? at_centroid(element) : at_point(element, index, 0);
}

CubeCentre CubeCentres::on(std::size_t element, std::uint32_t member, Point place) const {
    CubeCentre centre{.place = place};
    if (d_.elements.is_patch(element)) {
        const std::uint32_t facet_side = d_.forest.base_facet_side(PatchId(member));
        centre.at = mesh::start_on(d_.enclosure.mesh, FacetId(facet_side / 2),
                                   facet_side % 2 ? Side::back : Side::front);
        centre.axes = axes_about(normal_of(d_.forest, PatchId(member)), 0.0);
    } else {
        centre.at = {d_.forest.base_tet(ZoneId(member))};
    }
    return centre;
}

CubeCentre CubeCentres::at_centroid(std::size_t element) const {
    const auto [member, place] = d_.elements.is_patch(element) ? centroid_of<PatchId>(d_, element)
                                                               : centroid_of<ZoneId>(d_, element);
    return on(element, member, place);
}

CubeCentre CubeCentres::at_point(std::size_t element, std::size_t index, std::uint64_t seed) const {
    auto u = points_(index, seed);
    const std::uint32_t member = d_.elements.pick_member(element, u[0]);
    const bool patch = d_.elements.is_patch(element);
    Point place(0.0);
    const auto add = [&](const auto& corners, const auto& weights) {
        for (std::size_t k = 0; k < corners.size(); ++k)
            place += weights[k] * d_.forest.point(corners[k]);
    };
    if (patch)
        add(d_.forest[PatchId(member)].corners, uniform_in_triangle(u[0], u[1]));
    else
        add(d_.forest[ZoneId(member)].corners, uniform_in_tet(u[0], u[1], u[2]));
    CubeCentre centre = on(element, member, place);
    if (!settings_.random_offsets) return centre;
    const Direction z = patch ? centre.axes[2] : uniform_direction(u[3], u[4]);
    centre.axes = axes_about(z, angle_of(patch ? u[3] : uniform(seed, index)));
    return centre;
}

}  // namespace tyndall::radiosity
