#include "radiosity/pair_integral.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "mesh/visible_polygon.h"
#include "radiosity/closed_forms.h"
#include "radiosity/polygon_exchange.h"
#include "radiosity/spherical_cubature.h"

namespace tyndall::radiosity {
namespace {

// Centres this many times the sum of the radii apart, the kernel is smooth over two pieces.
constexpr double far_apart = 0.9;

// Optical depth across two pieces up to which integrals over faces do not cancel much.
constexpr double most_depth = 4.0;

// Pairs kept for subdivision: beyond, those with the smallest errors are settled.
constexpr std::size_t most_piece_pairs = 1u << 16;

std::span<const CubatureNode> rule_of(const Piece& piece, Degree degree) {
    return piece.solid ? tet_rule(degree) : triangle_rule(degree);
}

// The cosine that a ray has at a piece; 1 at a zone.
double cosine(const Piece& piece, Direction d) {
    return piece.solid ? 1.0 : glm::dot(piece.normal, d);
}

// Whether a plane through a face (dot(normal, p) = offset, p relative to the eye) is seen edge-on,
// to rounding, by an eye this far from it.
bool edge_on(const PieceFace& face, Point x, double offset) {
    return std::abs(offset) <= 1e-12 * (std::sqrt(face.area) + glm::distance(face.corners[0], x));
}

}  // namespace

// A rule's result, and what it would be more if nothing were hidden.
struct PairIntegral::Estimate {
    double value = 0.0, hidden = 0.0;  // [m^2]
    std::size_t rays = 0;

    // Edges of shadows: of n rays, a share of the order of 1/√n falls on the wrong side.
    double shadow_error() const {
        return rays > 0 ? std::min(value, hidden) / std::sqrt(static_cast<double>(rays)) : 0.0;
    }
};

// Pairs of pieces as a heap by error, and the sums over all of them.
struct PairIntegral::Work {
    std::vector<Pair> pairs;
    double value = 0.0, error = 0.0;                  // of all
    double settled_value = 0.0, settled_error = 0.0;  // of those no longer kept
    std::size_t rays = 0;

    static bool less(const Pair& a, const Pair& b) { return a.error < b.error; }

    void push(const Pair& pair) {
        value += pair.value;
        error += pair.error;
        pairs.push_back(pair);
        std::ranges::push_heap(pairs, less);
    }
    Pair pop() {
        std::ranges::pop_heap(pairs, less);
        const Pair pair = pairs.back();
        pairs.pop_back();
        value -= pair.value;
        error -= pair.error;
        return pair;
    }
    void settle(double of_value, double of_error) {
        settled_value += of_value;
        settled_error += of_error;
        value += of_value;
        error += of_error;
    }
    // Keeps the half with the larger errors.
    void shrink() {
        const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(pairs.size() / 2);
        std::nth_element(pairs.begin(), middle, pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.error > b.error; });
        for (auto pair = middle; pair != pairs.end(); ++pair) {
            settled_value += pair->value;
            settled_error += pair->error;
        }
        pairs.erase(middle, pairs.end());
        std::ranges::make_heap(pairs, less);
    }
    // Added up anew: without the rounding of all that was added and taken away.
    double sum() const {
        double result = settled_value;
        for (const Pair& pair : pairs) result += pair.value;
        return result;
    }
};

PairIntegral::PairIntegral(const Enclosure& enclosure, std::size_t band, double tolerance)
    : enclosure_(enclosure), tolerance_(tolerance) {
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        extinction_.push_back(enclosure.extinction(TetId(t), band));
}

double PairIntegral::operator()(std::span<const Piece> a, std::span<const Piece> b,
                                bool same) const {
    Work work;
    if (uniform(a, b, same))
        add_faces(boundary_of(a), boundary_of(b), 1.0, work);
    else
        add_members(a, b, same, work);
    work.rays = 0;
    while (!work.pairs.empty() && work.error > tolerance_ * work.value && work.rays < most_rays) {
        Pair pair = work.pop();
        if (pair.degree == Degree::two && (pair.kernel != Kernel::points || far(pair))) {
            raise(pair, work);
            work.push(pair);
            continue;
        }
        const bool first = longest_edge_squared(pair.a) >= longest_edge_squared(pair.b);
        for (const Piece& half : bisect(first ? pair.a : pair.b))
            add({first ? half : pair.a, first ? pair.b : half, pair.factor, pair.kernel}, work);
    }
    return work.sum();
}

void PairIntegral::add_members(std::span<const Piece> a, std::span<const Piece> b, bool same,
                               Work& work) const {
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (same && a[i].solid) add_faces(faces_of(a[i]), faces_of(a[i]), 1.0, work);
        for (std::size_t j = same ? i + 1 : 0; j < b.size(); ++j)
            add({a[i], b[j], same ? 2.0 : 1.0}, work);
    }
}

void PairIntegral::add_faces(std::span<const Piece> from, std::span<const Piece> to, double factor,
                             Work& work) const {
    for (const Piece& f : from)
        for (const Piece& g : to)
            add({f, g, factor, f.face ? Kernel::faces : Kernel::patch_face}, work);
}

bool PairIntegral::uniform(std::span<const Piece> a, std::span<const Piece> b, bool same) const {
    if (a.empty() || b.empty() || !b[0].solid || a.size() * b.size() == 1) return false;
    if (!same && a[0].solid) {
        const Ball one = ball_of(a), other = ball_of(b);
        // Far apart, faces cancel: member by member.
        if (glm::distance(one.centre, other.centre) > one.radius + other.radius) return false;
    }
    for (const Piece& one : a)
        for (const Piece& other : b) {
            if (one.extinction != other.extinction || straddles(one, other)) return false;
            const double expected = one.extinction * glm::distance(one.centre, other.centre);
            const double depth = optical_depth(one, one.centre, other, other.centre);
            if (!(std::abs(depth - expected) <= 1e-9 * expected)) return false;
        }
    return true;
}

bool PairIntegral::uniform(const Pair& pair) const {
    const Piece &a = pair.a, &b = pair.b;
    const double reach = glm::distance(a.centre, b.centre) + a.radius + b.radius;
    if (a.extinction != b.extinction || a.extinction * reach > most_depth) return false;
    if (straddles(a, b)) return false;
    for (const auto& p : rule_of(a, Degree::five))
        for (const auto& q : rule_of(b, Degree::five)) {
            const Point x = a.at(p.at), y = b.at(q.at);
            const double expected = a.extinction * glm::distance(x, y);
            // Also false if hidden.
            if (!(std::abs(optical_depth(a, x, b, y) - expected) <= 1e-9 * expected)) return false;
        }
    return true;
}

void PairIntegral::add(Pair pair, Work& work) const {
    if (pair.kernel == Kernel::points) {
        if (behind(pair.a, pair.b) || behind(pair.b, pair.a)) return;
        if (pair.a.solid && !pair.b.solid) std::swap(pair.a, pair.b);
        if (pair.b.solid && !far(pair) && uniform(pair))
            return add_faces(faces_of(pair.a), faces_of(pair.b), pair.factor, work);
    }
    const Estimate one = evaluate(pair, Degree::one), two = evaluate(pair, Degree::two);
    work.rays += one.rays + two.rays;
    pair.value = pair.factor * two.value;
    pair.first_difference = pair.factor * std::abs(two.value - one.value);
    pair.error = std::max(doubt(pair) * pair.first_difference, pair.factor * two.shadow_error());
    if (pair.error == 0.0) return work.settle(pair.value, 0.0);
    if (work.pairs.size() >= most_piece_pairs) work.shrink();
    work.push(pair);
}

void PairIntegral::raise(Pair& pair, Work& work) const {
    const Estimate five = evaluate(pair, Degree::five);
    work.rays += five.rays;
    const double value = pair.factor * five.value;
    const double difference = std::abs(value - pair.value);
    // That is the error of degree 2; that of degree 5 is smaller in proportion as it was for
    // degree 2 against 1.
    const double falls =
        far(pair) && pair.first_difference > difference ? difference / pair.first_difference : 1.0;
    pair.value = value;
    pair.error = std::max(doubt(pair) * falls * difference, pair.factor * five.shadow_error());
    pair.degree = Degree::five;
}

// What an estimate from two rules is multiplied by: near by, where the integrand has no derivatives
// at common edges, rules may agree by chance.
double PairIntegral::doubt(const Pair& pair) {
    return far(pair) ? 1.0 : 3.0;
}

bool PairIntegral::far(const Pair& pair) {
    return glm::distance(pair.a.centre, pair.b.centre) >
           far_apart * (pair.a.radius + pair.b.radius);
}

PairIntegral::Estimate PairIntegral::evaluate(const Pair& pair, Degree degree) const {
    return pair.kernel != Kernel::points || far(pair) ? by_points(pair, degree)
                                                      : by_directions(pair, degree);
}

PairIntegral::Estimate PairIntegral::by_points(const Pair& pair, Degree degree) const {
    const Piece &a = pair.a, &b = pair.b;
    Estimate result;
    double whole = a.measure * b.measure / std::numbers::pi;
    if (a.solid) whole *= a.extinction;
    if (b.solid) whole *= b.extinction;
    for (const auto& p : rule_of(a, degree)) {
        const Point x = a.at(p.at);
        for (const auto& q : rule_of(b, degree)) {
            const Point y = b.at(q.at);
            const double s = glm::distance(x, y);
            if (s == 0.0) continue;  // one face of two neighbours: its cosines are 0
            const Direction d = (y - x) / s;
            const double at_x = cosine(a, d), at_y = cosine(b, -d);
            const double share = whole * p.weight * q.weight * at_x * at_y / (s * s);
            ++result.rays;
            if (pair.kernel == Kernel::faces) {
                result.value += share * kernel_value(DepthKernel::second, a.extinction * s);
                continue;
            }
            if (pair.kernel == Kernel::patch_face) {
                result.value += std::max(at_x, 0.0) == 0.0
                                    ? 0.0
                                    : share * kernel_value(DepthKernel::first, a.extinction * s);
                continue;
            }
            if (at_x <= 0.0 || at_y <= 0.0) continue;
            const double depth = optical_depth(a, x, b, y);
            if (depth < infinity)
                result.value += share * std::exp(-depth);
            else
                result.hidden += share;
        }
    }
    return result;
}

// What a point of a pair's first piece sees of the second: cones that enter by one face of it and
// leave by another, so that the chord is smooth over each.
class PairIntegral::Look {
  public:
    Look(const PairIntegral& integral, const Pair& pair, std::span<const CubatureNode> rule,
         Estimate& result)
        : integral_(integral), a_(pair.a), b_(pair.b), rule_(rule), result_(result) {
        if (b_.solid) faces_ = outward_faces(b_);
    }

    // Adds `share` times ∫ τ (1 − e^{−κ b}) k dω from x, k the cosine at a patch, 1 in a zone.
    void from(Point x, double share) {
        x_ = x;
        share_ = share;
        if (b_.solid) return from_faces();
        const double offset = glm::dot(b_.normal, x - b_.centre);
        if (offset <= 1e-12 * (b_.radius + glm::distance(x, b_.centre))) return;
        begin(std::span(b_.corners).first(3));
        add({-b_.normal, offset}, nullptr);
    }

  private:
    struct Plane {
        Direction normal;
        double offset;  // dot(normal, p), p relative to x [m]
        double distance(Direction d) const { return offset / glm::dot(normal, d); }
    };

    void from_faces() {
        std::array<Plane, 4> planes;
        std::array<int, 4> sides{};  // 1: rays leave by it, −1: enter; 0: edge-on
        bool inside = true;
        for (int k = 0; k < 4; ++k) {
            const PieceFace& face = faces_[k];
            planes[k] = {face.normal, glm::dot(face.normal, face.corners[0] - x_)};
            if (!edge_on(face, x_, planes[k].offset)) sides[k] = planes[k].offset > 0.0 ? 1 : -1;
            inside = inside && sides[k] >= 0;
        }
        for (int g = 0; g < 4; ++g) {
            if (sides[g] != 1) continue;
            if (inside) {
                begin(faces_[g].corners);
                add(planes[g], nullptr);
            }
            for (int h = 0; h < 4; ++h) {
                if (sides[h] != -1) continue;
                begin(faces_[g].corners);
                for (int k = 0; k < 3; ++k)
                    cut(glm::cross(faces_[h].corners[(k + 1) % 3] - x_, faces_[h].corners[k] - x_));
                add(planes[g], &planes[h]);
            }
        }
    }

    void begin(std::span<const Point> corners) {
        polygon_.clear();
        for (const Point& corner : corners) polygon_.push_back(corner - x_);
        if (!a_.solid) cut(a_.normal);
    }

    void cut(Direction normal) {
        next_.clear();
        if (polygon_.size() >= 3) mesh::clip(polygon_, normal, 0.0, next_);
        std::swap(polygon_, next_);
    }

    // The cone over the polygon, between two planes, or from x (or b's own plane) on.
    void add(const Plane& leave, const Plane* enter) {
        if (polygon_.size() < 3) return;
        const double whole =
            a_.solid ? solid_angle(polygon_) : projected_solid_angle(polygon_, a_.normal);
        if (!(whole > 0.0)) return;
        double weights = 0.0, values = 0.0, hidden = 0.0;
        over_directions(polygon_, rule_, [&](Direction d, double solid_angle) {
            const double weight = solid_angle * cosine(a_, d);
            const double far = leave.distance(d);
            const double near = enter ? std::clamp(enter->distance(d), 0.0, far) : 0.0;
            weights += weight;
            ++result_.rays;
            double value = weight, middle = far, within = 0.0;
            if (b_.solid) {
                // To the chord's middle: no wall, on which a face may lie, is there.
                middle = 0.5 * (near + far);
                within = b_.extinction * (far - near);
                value *= -std::expm1(-within);
            }
            const double depth = integral_.optical_depth(a_, x_, b_, x_ + middle * d);
            if (depth == infinity)
                hidden += value;
            else
                values += value * std::exp(-std::max(0.0, depth - 0.5 * within));
        });
        if (!(weights > 0.0)) return;  // a sliver, edge-on to rounding
        result_.value += share_ * whole * values / weights;
        result_.hidden += share_ * whole * hidden / weights;
    }

    const PairIntegral& integral_;
    const Piece &a_, &b_;
    std::span<const CubatureNode> rule_;
    Estimate& result_;
    std::array<PieceFace, 4> faces_{};
    Point x_{0};
    double share_ = 0.0;
    std::vector<Point> polygon_, next_;  // relative to x
};

PairIntegral::Estimate PairIntegral::by_directions(const Pair& pair, Degree degree) const {
    const Piece& a = pair.a;
    Estimate result;
    Look look(*this, pair, triangle_rule(degree), result);
    const double whole = a.measure / std::numbers::pi * (a.solid ? a.extinction : 1.0);
    for (const auto& p : rule_of(a, degree)) look.from(a.at(p.at), whole * p.weight);
    return result;
}

double PairIntegral::optical_depth(const Piece& a, Point x, const Piece& b, Point y) const {
    const double s = glm::distance(x, y);
    const TetId target = b.start.tet;
    if (a.start.tet == target || s == 0.0) return s * extinction_[target.value];
    double depth = 0.0;
    bool there = false;
    const mesh::Ray ray{x, (y - x) / s, s};
    const auto end =
        mesh::walk(enclosure_.mesh, ray, a.start, [&](TetId at, double in, double out) {
            // Within the target's tet nothing is in the way.
            there = at == target;
            depth += extinction_[at.value] * ((there ? s : out) - in);
            return !there;
        });
    // A walk that passes beside the target's tet by rounding ends at its length all the same.
    return there || end.arrival == mesh::Arrival::ended ? depth : infinity;
}

}  // namespace tyndall::radiosity
