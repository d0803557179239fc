#include "mesh/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"

namespace tyndall::mesh {
namespace {

// A part of a rectangle, in metres along its axes.
struct Piece {
    double s0, s1, t0, t1;  // [m]
};

// An opening as a piece; edges that miss the rectangle's by rounding are put on them.
Piece piece_of(const Opening& opening, double length_s, double length_t) {
    const double slack = 1e-9 * std::max(length_s, length_t);  // rounding of corner + size
    const auto range = [&](int axis, double length, const char* axis_name) {
        const double low = opening.corner[axis], high = low + opening.size[axis];
        if (!(opening.size[axis] > slack)) {
            throw InputError(
                fmt::format("opening \"{}\" has size {} m along {}. Give a size above 0.",
                            opening.name, opening.size[axis], axis_name));
        }
        if (!(low >= -slack && high <= length + slack)) {
            throw InputError(
                fmt::format("opening \"{}\" reaches from {} to {} m along {}, beyond its face, "
                            "which ends at {} m. "
                            "Move or shrink it.",
                            opening.name, low, high, axis_name, length));
        }
        return std::array<double, 2>{low <= slack ? 0.0 : low,
                                     high >= length - slack ? length : high};
    };
    const auto s = range(0, length_s, "the first axis");
    const auto t = range(1, length_t, "the second axis");
    return {s[0], s[1], t[0], t[1]};
}

void check_overlaps(const std::vector<Opening>& openings, const std::vector<Piece>& holes,
                    double slack) {
    for (std::size_t i = 0; i < holes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (openings[i].name == openings[j].name) {
                throw InputError(fmt::format(
                    "two openings are named \"{}\". Give every opening a name of its own.",
                    openings[i].name));
            }
            const Piece &a = holes[i], &b = holes[j];
            const double s = std::min(a.s1, b.s1) - std::max(a.s0, b.s0);
            const double t = std::min(a.t1, b.t1) - std::max(a.t0, b.t0);
            if (s > slack && t > slack) {
                throw InputError(
                    fmt::format("openings \"{}\" and \"{}\" overlap by {} × {} m. Move them apart "
                                "or make one of them.",
                                openings[j].name, openings[i].name, s, t));
            }
        }
    }
}

// What is left of the rectangle around the holes: strips between the holes' edges along t.
// Edges nearer than `slack` are one.
std::vector<Piece> around(const std::vector<Piece>& holes, double length_s, double length_t,
                          double slack) {
    std::vector<double> cuts{0.0, length_t};
    for (const Piece& hole : holes) {
        cuts.push_back(hole.t0);
        cuts.push_back(hole.t1);
    }
    std::sort(cuts.begin(), cuts.end());
    const auto same = [&](double a, double b) { return b - a <= slack; };
    cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
    cuts.back() = length_t;

    std::vector<Piece> pieces;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        std::vector<std::array<double, 2>> gaps;
        for (const Piece& hole : holes) {
            if (hole.t0 <= cuts[k] + slack && hole.t1 >= cuts[k + 1] - slack)
                gaps.push_back({hole.s0, hole.s1});
        }
        std::sort(gaps.begin(), gaps.end());
        double s = 0.0;
        for (const auto& gap : gaps) {
            if (gap[0] > s + slack) pieces.push_back({s, gap[0], cuts[k], cuts[k + 1]});
            s = std::max(s, gap[1]);
        }
        if (s < length_s - slack) pieces.push_back({s, length_s, cuts[k], cuts[k + 1]});
    }
    return pieces;
}

// The face and its openings. `at` maps (s, t) [m] to space; `flip` turns the front to −(s axis × t
// axis).
template <class At>
void add_face(std::vector<Face>& faces, std::vector<Face>& openings_out, std::string name,
              double length_s, double length_t, const std::vector<Opening>& openings, bool flip,
              At&& at) {
    const auto polygon = [&](const Piece& p, Opacity opacity) {
        Polygon result{
            {at(p.s0, p.t0), at(p.s1, p.t0), at(p.s1, p.t1), at(p.s0, p.t1)}, opacity, {}};
        if (flip) std::reverse(result.corners.begin(), result.corners.end());
        return result;
    };
    std::vector<Piece> holes;
    for (const Opening& opening : openings) holes.push_back(piece_of(opening, length_s, length_t));
    const double slack = 1e-9 * std::max(length_s, length_t);  // rounding of corner + size
    check_overlaps(openings, holes, slack);

    Face face{std::move(name), {}};
    for (const Piece& piece : around(holes, length_s, length_t, slack)) {
        face.polygons.push_back(polygon(piece, Opacity::opaque));
    }
    if (!face.polygons.empty()) faces.push_back(std::move(face));  // an opening may take it all
    for (std::size_t i = 0; i < holes.size(); ++i) {
        openings_out.push_back({openings[i].name, {polygon(holes[i], Opacity::interface)}});
    }
}

// A face of an axis-aligned cuboid: normal along `axis`, on its low or high end.
struct CuboidFace {
    const char* name;
    int axis;
    bool high;
};

void check_cuboid(Point min, Point max) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(min[axis] < max[axis])) {
            throw InputError(
                fmt::format("min {0} is not below max {1} along {2}. Give a max above min.",
                            min[axis], max[axis], "xyz"[axis]));
        }
    }
}

void check_faces(const std::array<CuboidFace, 6>& cuboid,
                 const std::vector<FaceOpening>& openings) {
    for (std::size_t i = 0; i < openings.size(); ++i) {
        const auto& [face, opening] = openings[i];
        const auto named = [](const std::string& name) {
            return [&name](const CuboidFace& f) { return f.name == name; };
        };
        if (std::none_of(cuboid.begin(), cuboid.end(), named(face))) {
            throw InputError(
                fmt::format("opening \"{}\" lies in face \"{}\", which there is not. The faces are "
                            "{}, {}, x0, x1, y0, y1.",
                            opening.name, face, cuboid[0].name, cuboid[1].name));
        }
        const bool taken =
            std::any_of(cuboid.begin(), cuboid.end(), named(opening.name)) ||
            std::any_of(openings.begin(), openings.begin() + i,
                        [&](const auto& other) { return other.opening.name == opening.name; });
        if (taken) {
            throw InputError(fmt::format(
                "the name \"{}\" of an opening is taken. Give every opening a name of its own.",
                opening.name));
        }
    }
}

std::vector<Face> cuboid(const std::array<CuboidFace, 6>& names, Point min, Point max, bool inward,
                         const std::vector<FaceOpening>& openings) {
    check_cuboid(min, max);
    check_faces(names, openings);
    std::vector<Face> faces, holes;
    for (const CuboidFace& face : names) {
        const int s_axis = face.axis == 0 ? 1 : 0, t_axis = face.axis == 2 ? 1 : 2;
        std::vector<Opening> here;
        for (const FaceOpening& opening : openings) {
            if (opening.face == face.name) here.push_back(opening.opening);
        }
        const double length_s = max[s_axis] - min[s_axis], length_t = max[t_axis] - min[t_axis];
        // The far ends are max itself: faces that meet share their corners to the last bit.
        const auto at = [&](double s, double t) {
            Point p;
            p[face.axis] = face.high ? max[face.axis] : min[face.axis];
            p[s_axis] = s == length_s ? max[s_axis] : min[s_axis] + s;
            p[t_axis] = t == length_t ? max[t_axis] : min[t_axis] + t;
            return p;
        };
        const bool up = face.axis != 1;  // y × z = x, x × y = z, but x × z = −y
        const bool wants_up = face.high != inward;
        add_face(faces, holes, face.name, length_s, length_t, here, up != wants_up, at);
    }
    faces.insert(faces.end(), holes.begin(), holes.end());
    return faces;
}

}  // namespace

std::vector<Face> room(Point min, Point max, const std::vector<FaceOpening>& openings) {
    return cuboid({{{"floor", 2, false},
                    {"ceiling", 2, true},
                    {"x0", 0, false},
                    {"x1", 0, true},
                    {"y0", 1, false},
                    {"y1", 1, true}}},
                  min, max, true, openings);
}

std::vector<Face> box(Point min, Point max, const std::vector<FaceOpening>& openings) {
    return cuboid({{{"bottom", 2, false},
                    {"top", 2, true},
                    {"x0", 0, false},
                    {"x1", 0, true},
                    {"y0", 1, false},
                    {"y1", 1, true}}},
                  min, max, false, openings);
}

std::vector<Face> rectangle(Point corner, glm::dvec3 u, glm::dvec3 v,
                            const std::vector<Opening>& openings) {
    const double length_s = glm::length(u), length_t = glm::length(v);
    if (!(length_s > 0.0 && length_t > 0.0)) {
        throw InputError(fmt::format("the sides u and v are {} and {} m long. Give sides above 0.",
                                     length_s, length_t));
    }
    const double cosine = glm::dot(u, v) / (length_s * length_t);
    if (!(std::abs(cosine) <= 1e-6)) {
        throw InputError(
            fmt::format("u and v are not perpendicular: they meet at {:.6g} degrees. Correct one "
                        "of them, or use polygons.",
                        std::acos(cosine) * 180.0 / M_PI));
    }
    const auto at = [&](double s, double t) {
        const double a = s == length_s ? 1.0 : s / length_s, b = t == length_t ? 1.0 : t / length_t;
        return corner + a * u + b * v;
    };
    std::vector<Face> faces, holes;
    add_face(faces, holes, "", length_s, length_t, openings, false, at);
    faces.insert(faces.end(), holes.begin(), holes.end());
    return faces;
}

void check_polygon(const Polygon& polygon) {
    const auto& corners = polygon.corners;
    if (corners.size() < 3) {
        throw InputError(fmt::format("has {} corner{}. Give at least three.", corners.size(),
                                     corners.size() == 1 ? "" : "s"));
    }
    Point low = corners[0], high = corners[0];
    for (const Point& p : corners) {
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) {
            throw InputError("has a corner that is not finite. Give finite coordinates.");
        }
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double size = glm::length(high - low);
    glm::dvec3 normal(0.0);  // Newell: twice the area vector, about corner 0 to keep digits
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    }
    const double twice_area = glm::length(normal);
    if (!(twice_area > 1e-12 * size * size) || !(size > 0.0)) {
        throw InputError(fmt::format(
            "has no area: its corners lie on one line or it crosses itself (area {} m²). "
            "Move a corner or leave it out.",
            twice_area / 2));
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double off = std::abs(glm::dot(corners[i] - corners[0], normal)) / twice_area;
        if (off > 1e-6 * size) {
            throw InputError(
                fmt::format("is not planar: corner {} lies {:.3g} m off the plane of the others. "
                            "Correct it or cut the polygon into triangles.",
                            i + 1, off));
        }
    }
}

}  // namespace tyndall::mesh
