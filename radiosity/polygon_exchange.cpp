#include "radiosity/polygon_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>

#include "radiosity/closed_forms.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// Gauss-Legendre on [0, 1], ten points.
constexpr std::array<double, 10> gauss_nodes{
    0.013046735741414128, 0.06746831665550773, 0.16029521585048778, 0.2833023029353764,
    0.4255628305091844,   0.5744371694908156,  0.7166976970646236,  0.8397047841495122,
    0.9325316833444923,   0.9869532642585859};
constexpr std::array<double, 10> gauss_weights{
    0.03333567215434407, 0.07472567457529030, 0.1095431812579910, 0.1346333596549982,
    0.1477621123573764,  0.1477621123573764,  0.1346333596549982, 0.1095431812579910,
    0.07472567457529030, 0.03333567215434407};

// ∫ f over [from, to] by ten points a piece. The integrands here have their poles π/2 beside the
// real axis: pieces of 2 leave 1e-11. In thick media they fall like e^{−u cosh z}, as a Gauss curve
// of width 1/√u, of which a piece holds four widths at most.
template <class F>
double integrate(double from, double to, double depth, F&& f) {
    const double longest = 2.0 / std::max(1.0, 0.5 * std::sqrt(depth));
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / longest)));
    const double piece = (to - from) / pieces;
    double sum = 0.0;
    for (int k = 0; k < pieces; ++k)
        for (std::size_t n = 0; n < gauss_nodes.size(); ++n)
            sum += gauss_weights[n] * f(from + piece * (k + gauss_nodes[n]));
    return piece * sum;
}

// A point above q's plane, and the cosine at the point: n_p·d / s with d = r e_φ + h n.
struct Foot {
    double height;      // h [m]
    double extinction;  // [1/m]
    DepthKernel kernel;
    double upright;    // n_p · n
    glm::dvec2 along;  // n_p in the plane
    bool cosine;       // whether there is a cosine at the point
    // From where on sectors count [m]: what lies nearer cancels over the edges of a polygon beside
    // the foot. Not where it is lower than wide, for there it would make the edges' integrals
    // rough.
    double nearest;
};

// ∫ K (n_p·d/s) h/s³ r' dr' from the nearest to r in the direction of e: r' = h sinh z, s = h cosh
// z.
double radial(const Foot& foot, double r, glm::dvec2 e) {
    const double slope = glm::dot(foot.along, e);
    return integrate(std::asinh(foot.nearest / foot.height), std::asinh(r / foot.height),
                     foot.extinction * foot.height, [&](double z) {
                         const double grown = std::exp(z), shrunk = 1.0 / grown;
                         const double cosh = 0.5 * (grown + shrunk), sinh = 0.5 * (grown - shrunk);
                         const double cosine =
                             foot.cosine ? (slope * sinh + foot.upright) / cosh : 1.0;
                         return kernel_value(foot.kernel, foot.extinction * foot.height * cosh) *
                                cosine * sinh / (cosh * cosh);
                     });
}

// Of a convex polygon; 0 inside.
double distance_from_origin(const std::vector<glm::dvec2>& corners) {
    double least = std::numeric_limits<double>::max();
    bool left = false, right = false;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
        const glm::dvec2 edge = b - a;
        const double turn = a.x * b.y - a.y * b.x, square = glm::dot(edge, edge);
        left = left || turn > 0.0;
        right = right || turn < 0.0;
        if (square == 0.0) continue;
        const double t = std::clamp(-glm::dot(a, edge) / square, 0.0, 1.0);
        least = std::min(least, glm::length(a + t * edge));
    }
    return left && right ? least : 0.0;
}

// The part between the foot and the edge from a to b, signed as they turn: dφ = d dl / r², with
// l = ρ sinh v along the edge, ρ the distance of the edge's line.
double sector(const Foot& foot, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 edge = b - a;
    const double length = glm::length(edge);
    if (length == 0.0) return 0.0;
    const glm::dvec2 t = edge / length;
    const glm::dvec2 n(t.y, -t.x);
    const double d = glm::dot(n, a);
    if (d == 0.0) return 0.0;
    const double rho = std::hypot(d, foot.height);
    return integrate(
        std::asinh(glm::dot(t, a) / rho), std::asinh(glm::dot(t, b) / rho),
        foot.nearest > 0.0 ? std::max(16.0, foot.extinction * rho) : foot.extinction * rho,
        [&](double v) {
            const double l = rho * std::sinh(v), r = std::hypot(d, l);
            const glm::dvec2 e = (d * n + l * t) / r;
            return d * rho * std::cosh(v) / (r * r) * radial(foot, r, e);
        });
}

// Calls add(point, weight) ... an integral over a convex polygon as one over squares: a
// quadrilateral by its bilinear map, others by triangles from the first corner.
template <class F>
Integral integrate_polygon(std::span<const Point> c, F&& f, const CubatureOptions& options) {
    Integral total;
    const auto quad = [&](const Point& a, const Point& b, const Point& c2, const Point& d) {
        const Integral part = integrate_square(
            [&](double u, double v) {
                const Point low = a + u * (b - a), high = d + u * (c2 - d);
                const Point du = (1.0 - v) * (b - a) + v * (c2 - d), dv = high - low;
                const double area = glm::length(glm::cross(du, dv));
                return area == 0.0 ? 0.0 : area * f(low + v * dv);
            },
            options);
        total.value += part.value;
        total.error += part.error;
        total.reached = total.reached && part.reached;
    };
    if (c.size() == 4) {
        quad(c[0], c[1], c[2], c[3]);
    } else {
        for (std::size_t k = 2; k < c.size(); ++k) quad(c[0], c[k - 1], c[k], c[0]);
    }
    return total;
}

double area_of(std::span<const Point> c) {
    Direction twice(0.0);
    for (std::size_t k = 2; k < c.size(); ++k) twice += glm::cross(c[k - 1] - c[0], c[k] - c[0]);
    return 0.5 * glm::length(twice);
}

std::vector<Point> relative(std::span<const Point> polygon, Point x) {
    std::vector<Point> result(polygon.begin(), polygon.end());
    for (Point& p : result) p -= x;
    return result;
}

// The same from one point where the optical depth is whatever `depth` says.
double through_media(std::span<const Point> q, Point x, const PolygonPair& pair, const Obstacles& o,
                     DepthKernel kernel, const CubatureOptions& options) {
    std::vector<double> depths(o.enclosure.bands);
    // Beside p, on q's side.
    const TetId tet = mesh::locate(o.enclosure.mesh, x + 1e-9 * (q[0] + q[1] + q[2]));
    const auto value = [&](Point path) {
        const double square = glm::dot(path, path), s = std::sqrt(square);
        o.depth(x, tet, path, depths);
        return kernel_value(kernel, depths[o.band]) *
               std::abs(glm::dot(pair.p_normal, path) * glm::dot(pair.q_normal, path)) /
               (square * square) * (s > 0.0);
    };
    return integrate_polygon(q, value, options).value;
}

}  // namespace

double kernel_value(DepthKernel kernel, double depth) {
    switch (kernel) {
        case DepthKernel::transmittance:
            return std::exp(-depth);
        case DepthKernel::first:
            return std::expm1(-depth);
        case DepthKernel::second:
            break;
    }
    // The series where the difference would lose digits.
    if (depth < 0.02)
        return depth * depth *
               (0.5 -
                depth * (1.0 / 6.0 - depth * (1.0 / 24.0 - depth * (1.0 / 120.0 - depth / 720.0))));
    return std::expm1(-depth) + depth;
}

double exchange_from_point(std::span<const Point> q, Direction q_normal, Direction p_normal,
                           double extinction, DepthKernel kernel) {
    if (q.size() < 3) return 0.0;
    const bool cosine = glm::dot(p_normal, p_normal) > 0.0;
    if (extinction == 0.0) {
        if (kernel != DepthKernel::transmittance) return 0.0;
        return cosine ? projected_solid_angle(q, p_normal) : solid_angle(q);
    }
    double height = glm::dot(q_normal, q[0]);
    const Direction n = height < 0.0 ? -q_normal : q_normal;
    height = std::abs(height);
    if (height == 0.0) return 0.0;
    const Direction axis = std::abs(n.x) < 0.6 ? Direction(1, 0, 0) : Direction(0, 1, 0);
    const Direction e1 = glm::normalize(glm::cross(axis, n)), e2 = glm::cross(n, e1);
    std::vector<glm::dvec2> corners;
    for (const Point& p : q) corners.push_back({glm::dot(p, e1), glm::dot(p, e2)});
    const double beside = distance_from_origin(corners);
    const Foot foot{height,
                    extinction,
                    kernel,
                    glm::dot(p_normal, n),
                    {glm::dot(p_normal, e1), glm::dot(p_normal, e2)},
                    cosine,
                    beside > height ? beside : 0.0};
    double sum = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k)
        sum += sector(foot, corners[k], corners[k + 1 == corners.size() ? 0 : k + 1]);
    // Corners may run either way round; the kernels keep their sign.
    return kernel == DepthKernel::first ? -std::abs(sum) : std::abs(sum);
}

Integral exchange_in_sight(const PolygonPair& pair, double extinction, DepthKernel kernel,
                           const CubatureOptions& options) {
    return integrate_polygon(
        pair.p,
        [&](Point x) {
            return exchange_from_point(relative(pair.q, x), pair.q_normal, pair.p_normal,
                                       extinction, kernel) /
                   pi;
        },
        options);
}

Integral exchange_past(const PolygonPair& pair, const Obstacles& o, DepthKernel kernel,
                       const CubatureOptions& options) {
    mesh::VisibleScratch scratch;
    // A tenth of what is left to both integrals.
    const CubatureOptions inner{0.1 * options.relative,
                                0.1 * options.absolute * pi / area_of(pair.p), 200'000};
    return integrate_polygon(
        pair.p,
        [&](Point x) {
            std::vector<Point> q = relative(pair.q, x);
            const Direction n = glm::cross(q[1] - q[0], q[2] - q[0]);
            if (glm::dot(n, q[0]) > 0.0) std::ranges::reverse(q);  // counter-clockwise from x
            double sum = 0.0;
            const auto seen = o.occluders.look(x, {.corners = q},
                                               {.occluders = 1u << 20, .parts = 1u << 20}, scratch);
            if (seen == mesh::Visibility::none) return 0.0;
            for (std::size_t k = 0; k < scratch.visible.size(); ++k)
                sum += o.extinction ? exchange_from_point(scratch.visible[k], pair.q_normal,
                                                          pair.p_normal, *o.extinction, kernel)
                                    : through_media(scratch.visible[k], x, pair, o, kernel, inner);
            return sum / pi;
        },
        options);
}

}  // namespace tyndall::radiosity
