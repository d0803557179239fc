#include "mesh/conform_check.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"

namespace tyndall::mesh::conforming {

namespace {

// How far a corner may be off its polygon's plane, relative to the polygon's extent: what single
// precision files and coordinates written with six digits need.
constexpr double flatness = 1e-5;

std::string label(const Polygon& polygon, std::size_t number) {
    return polygon.name.empty() ? fmt::format("polygon {}", number)
                                : fmt::format("surface \"{}\" (polygon {})", polygon.name, number);
}

std::string text(Point x) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x, x.y, x.z);
}

bool finite(Point x) {
    return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
}

double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether the open segments ab and cd cross, each end clearly beside the other segment.
bool cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d, double tolerance) {
    const double ab = tolerance * glm::distance(a, b), cd = tolerance * glm::distance(c, d);
    const auto apart = [](double s, double t, double limit) {
        return (s > limit && t < -limit) || (s < -limit && t > limit);
    };
    return apart(turn(a, b, c), turn(a, b, d), ab) && apart(turn(c, d, a), turn(c, d, b), cd);
}

void check_crossings(const Soup& soup, const std::vector<Index>& loop, const Plane& plane,
                     const Polygon& polygon, Index number) {
    const auto n = loop.size();
    std::vector<glm::dvec2> flat;
    for (const auto i : loop) {
        flat.push_back(plane.flatten(soup.at(i)));
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = i + 2; k < n; ++k) {
            if (cross(flat[i], flat[(i + 1) % n], flat[k], flat[(k + 1) % n], soup.tolerance)) {
                throw InputError(fmt::format(
                    "{} crosses itself: its edge from {} to {} and its edge from {} to {}. Order "
                    "the corners along the boundary, or split the polygon.",
                    label(polygon, number), text(soup.at(loop[i])),
                    text(soup.at(loop[(i + 1) % n])), text(soup.at(loop[k])),
                    text(soup.at(loop[(k + 1) % n]))));
            }
        }
    }
}

}  // namespace

double check_corners(std::span<const Polygon> polygons, double tolerance) {
    if (!(tolerance > 0.0 && tolerance < 0.01)) {
        throw InputError(fmt::format(
            "The tolerance of conform is {}. It must be above 0 and below 0.01.", tolerance));
    }
    Point low(INFINITY), high(-INFINITY);
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        const auto& corners = polygons[p].corners;
        if (corners.size() < 3) {
            throw InputError(fmt::format("{} has {} corners. Give at least three.",
                                         label(polygons[p], p), corners.size()));
        }
        for (std::size_t k = 0; k < corners.size(); ++k) {
            if (!finite(corners[k])) {
                throw InputError(fmt::format("{}: corner {} is {}. Give finite coordinates.",
                                             label(polygons[p], p), k, text(corners[k])));
            }
            low = glm::min(low, corners[k]);
            high = glm::max(high, corners[k]);
        }
    }
    const double diagonal = glm::distance(low, high);
    if (!std::isfinite(diagonal) || diagonal <= 0.0) {
        throw InputError(fmt::format("The scene extends from {} to {}: it has no usable size.",
                                     text(low), text(high)));
    }
    return diagonal;
}

void check_loop(const Soup& soup, const std::vector<Index>& loop, const Polygon& polygon,
                Index number) {
    const auto plane = fit_plane(soup, loop);
    if (!plane) {
        throw InputError(fmt::format(
            "{} has no area: its corners lie on a line within {:.3g} m, near {}. Move the corners "
            "or leave the polygon out.",
            label(polygon, number), soup.tolerance, text(polygon.corners[0])));
    }
    double extent = 0.0;
    for (const auto i : loop) {
        extent = std::max(extent, glm::distance(soup.at(i), soup.at(loop[0])));
    }
    const double limit = std::max(flatness * extent, soup.tolerance);
    for (const auto i : loop) {
        const double off = std::abs(plane->above(soup.at(i)));
        if (off > limit) {
            throw InputError(fmt::format(
                "{} is not planar: corner {} is {:.3g} m off the plane of the others (at most "
                "{:.3g} m). Split it into triangles.",
                label(polygon, number), text(soup.at(i)), off, limit));
        }
    }
    check_crossings(soup, loop, *plane, polygon, number);
    const double area = std::abs(glm::dot(area_vector(soup, loop), plane->normal));
    if (area <= soup.tolerance * extent) {
        throw InputError(
            fmt::format("{} has no area ({:.3g} m^2), near {}: its boundary runs back "
                        "along itself. Order the corners along the boundary.",
                        label(polygon, number), area, text(soup.at(loop[0]))));
    }
}

namespace {

glm::dvec3 area_vector(std::span<const Point> corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    }
    return 0.5 * sum;
}

}  // namespace

void check_areas(const ConformingComplex& complex, std::span<const Polygon> polygons,
                 double tolerance) {
    std::vector<double> areas(polygons.size(), 0.0);
    for (const auto& facet : complex.facets) {
        const Point corners[] = {complex.points[facet.corners[0].value],
                                 complex.points[facet.corners[1].value],
                                 complex.points[facet.corners[2].value]};
        for (const auto polygon : facet.polygons) {
            areas[polygon.value] += glm::length(area_vector(corners));
        }
    }
    for (std::size_t p = 0; p < polygons.size(); ++p) {
        const auto& corners = polygons[p].corners;
        const double wanted = glm::length(area_vector(corners));
        double boundary = glm::distance(corners.back(), corners.front());
        for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
            boundary += glm::distance(corners[k], corners[k + 1]);
        }
        // Points move by a few tolerances; a polygon within `flatness` of flat becomes triangles.
        const double allowed = 8.0 * tolerance * boundary + 1e-8 * wanted;
        if (std::abs(areas[p] - wanted) > allowed) {
            throw InputError(
                fmt::format("{} covers {:.9g} m^2, but its boundary goes around {:.9g} m^2, near "
                            "{}: the boundary "
                            "overlaps itself. Split the polygon.",
                            label(polygons[p], p), areas[p], wanted, text(corners[0])));
        }
    }
}

void throw_crossing(std::span<const Polygon> polygons, std::span<const Owner> first,
                    std::span<const Owner> second, Point where) {
    const auto p = first.front().polygon, q = second.front().polygon;
    throw InputError(fmt::format(
        "{} and {} meet near {} in a way that cannot be cut apart: they are nearly in contact over "
        "a stretch. Move them apart or let them coincide.",
        label(polygons[p], p), label(polygons[q], q), text(where)));
}

}  // namespace tyndall::mesh::conforming
