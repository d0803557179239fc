#include "radiosity/mean_transmittance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "radiosity/closed_forms.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t most_triangles = 1024;  // a polygon; then the rest is taken as it is
constexpr double narrow_spread =
    0.1;                            // spread, up to which cubature integrates the weights to 1e-6
constexpr double low_share = 0.02;  // of the step, up to which three points are enough
constexpr double flat_exponent =
    2e-4;  // variation, of the step, too small for the weights' shape to matter
// Variation of the exponent × spread of the weights, of the step: three points then err by 1e-6.
constexpr double little = 1e-5;
constexpr double some = 0.1;  // the same, up to which seven points err by about 1e-5
// Of the sum, what triangles that no rule is enough for may differ by between the two rules; seven
// points then err by far less.
constexpr double tolerance = 3e-4;

struct Node {
    double a, b, c, weight;  // barycentric
};

constexpr std::array<Node, 3> degree_2{{{2. / 3, 1. / 6, 1. / 6, 1. / 3},
                                        {1. / 6, 2. / 3, 1. / 6, 1. / 3},
                                        {1. / 6, 1. / 6, 2. / 3, 1. / 3}}};

// Radon (1948).
constexpr double p1 = 0.059715871789770, q1 = 0.470142064105115, w1 = 0.132394152788506;
constexpr double p2 = 0.797426985353087, q2 = 0.101286507323456, w2 = 0.125939180544827;
constexpr std::array<Node, 7> degree_5{{{1. / 3, 1. / 3, 1. / 3, 0.225},
                                        {p1, q1, q1, w1},
                                        {q1, p1, q1, w1},
                                        {q1, q1, p1, w1},
                                        {p2, q2, q2, w2},
                                        {q2, p2, q2, w2},
                                        {q2, q2, p2, w2}}};

struct Triangle {
    Point a, b, c;
    double area;
    double doubt = 0.0;  // bound of what it may be wrong by, of the sum of weight × τ
};

bool operator<(const Triangle& s, const Triangle& t) {
    return s.doubt < t.doubt;
}

struct PolygonScratch {
    std::vector<Triangle> open, heap;
    std::vector<double> depths;  // of a rule's nodes, bands within nodes
    std::vector<double> sum;     // of weight × τ, each band
};

// Halves a triangle across its longest edge.
std::array<Triangle, 2> bisect(const Triangle& t) {
    const double ab = glm::distance(t.a, t.b), bc = glm::distance(t.b, t.c),
                 ca = glm::distance(t.c, t.a);
    Point a = t.a, b = t.b, c = t.c;  // turned so that a b is the longest
    if (bc >= ab && bc >= ca)
        a = t.b, b = t.c, c = t.a;
    else if (ca >= ab && ca >= bc)
        a = t.c, b = t.a, c = t.b;
    const Point m = 0.5 * (a + b);
    return {Triangle{a, m, c, 0.5 * t.area}, Triangle{m, b, c, 0.5 * t.area}};
}

// Square of (longest edge / distance of the centroid): how much the weights vary.
double spread(const Triangle& t) {
    const Point centre = (t.a + t.b + t.c) / 3.0;
    const Point ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
    return std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)}) /
           glm::dot(centre, centre);
}

// Whether a rule is enough for a triangle over which the exponent varies so much.
bool three_do(double varies, double wide, double step) {
    return varies <= low_share * step && wide * varies <= little * step;
}

bool seven_do(double varies, double wide, double step) {
    if (wide >= 1.0 && varies >= flat_exponent * step) return false;
    return varies <= step && std::min(wide, 1.0) * varies <= some * step;
}

class Mean {
  public:
    Mean(const OpticalDepth& depth, const Receiver& receiver, const Hull* hull, double height,
         std::size_t bands, PolygonScratch& scratch)
        : depth_(depth),
          receiver_(receiver),
          hull_(hull),
          height_(height),
          bands_(bands),
          scratch_(scratch) {
        scratch_.sum.assign(bands, 0.0);
        scratch_.depths.resize(degree_5.size() * bands);
    }

    // Deposits a triangle if a rule is enough for it; returns what it may be wrong by otherwise.
    double try_deposit(const Triangle& t, double step) {
        const double wide = spread(t);
        if (three_do(look(t, wide, degree_2), wide, step)) {
            deposit(t, wide, degree_2.size());
            return 0.0;
        }
        const double by_three = mean(degree_2.size());
        const double varies = look(t, wide, degree_5);
        if (seven_do(varies, wide, step)) {
            deposit(t, wide, degree_5.size());
            return 0.0;
        }
        const double weight = exact_weight(t, wide, degree_5.size());
        const double doubt = varies > 1.0 || wide > 1.0
                                 ? most(t, degree_5)
                                 : std::abs(mean(degree_5.size()) - by_three);
        return weight * std::min(1.0, doubt);
    }

    // Deposits a triangle as the larger rule has it.
    void deposit(const Triangle& t) {
        const double wide = spread(t);
        look(t, wide, degree_5);
        deposit(t, wide, degree_5.size());
    }

    double total() const { return total_; }
    // The largest of the bands' sums.
    double sum() const { return *std::max_element(scratch_.sum.begin(), scratch_.sum.end()); }

  private:
    // Evaluates a rule's nodes; returns how much the optical depth varies: among them, and, as
    // nodes may happen to be equally far, as it would along straight paths over a triangle so wide.
    template <std::size_t n>
    double look(const Triangle& t, double wide, const std::array<Node, n>& rule) {
        for (std::size_t k = 0; k < n; ++k) {
            const Point p = rule[k].a * t.a + rule[k].b * t.b + rule[k].c * t.c;
            const double s = glm::length(p);
            const Direction unit = p / s;
            weights_[k] = rule[k].weight * t.area * receiver_.cosine(unit) / (s * s * s);
            const Direction path = hull_ ? unit * hull_->exit(receiver_.x, unit) : p;
            depth_(receiver_.x, receiver_.tet, path, {scratch_.depths.data() + k * bands_, bands_});
        }
        double widest = 0.0;
        for (std::size_t band = 0; band < bands_; ++band) {
            double low = std::numeric_limits<double>::infinity(), high = 0.0;
            for (std::size_t k = 0; k < n; ++k) {
                low = std::min(low, scratch_.depths[k * bands_ + band]);
                high = std::max(high, scratch_.depths[k * bands_ + band]);
            }
            widest = std::max({widest, high - low, 0.1 * high * wide});
        }
        return widest;
    }

    double sum_of_weights(std::size_t nodes) const {
        return std::accumulate(weights_.begin(), weights_.begin() + nodes, 0.0);
    }

    // The triangle's weight is its closed form; where it is narrow the nodes' sum is as good.
    double exact_weight(const Triangle& t, double wide, std::size_t nodes) const {
        const std::array<Point, 3> corners{t.a, t.b, t.c};
        return wide < narrow_spread   ? height_ * sum_of_weights(nodes)
               : receiver_.on_surface ? projected_solid_angle(corners, receiver_.normal)
                                      : solid_angle(corners);
    }

    // The mean of τ by the nodes looked at last, of the band that has most.
    double mean(std::size_t nodes) const {
        const double weights = sum_of_weights(nodes);
        if (weights <= 0.0) return 0.0;
        double most = 0.0;
        for (std::size_t band = 0; band < bands_; ++band) {
            double sum = 0.0;
            for (std::size_t k = 0; k < nodes; ++k)
                sum += weights_[k] * std::exp(-scratch_.depths[k * bands_ + band]);
            most = std::max(most, sum / weights);
        }
        return most;
    }

    // The largest τ that a point of the triangle may have, by the extinction towards the nodes.
    template <std::size_t n>
    double most(const Triangle& t, const std::array<Node, n>& rule) const {
        const Point centre = (t.a + t.b + t.c) / 3.0;
        const double radius = std::max(
            {glm::distance(t.a, centre), glm::distance(t.b, centre), glm::distance(t.c, centre)});
        const double nearest = std::max(height_, glm::length(centre) - radius);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < n; ++k) {
            const Point p = rule[k].a * t.a + rule[k].b * t.b + rule[k].c * t.c;
            for (std::size_t band = 0; band < bands_; ++band)
                least = std::min(least, scratch_.depths[k * bands_ + band] / glm::length(p));
        }
        return std::exp(-least * nearest);
    }

    void deposit(const Triangle& t, double wide, std::size_t nodes) {
        const double sum = sum_of_weights(nodes);
        if (sum <= 0.0) return;
        const double exact = exact_weight(t, wide, nodes);
        total_ += exact;
        for (std::size_t k = 0; k < nodes; ++k)
            for (std::size_t band = 0; band < bands_; ++band)
                scratch_.sum[band] +=
                    exact / sum * weights_[k] * std::exp(-scratch_.depths[k * bands_ + band]);
    }

    const OpticalDepth& depth_;
    const Receiver& receiver_;
    const Hull* hull_;
    double height_;  // of the receiver over the polygon's plane
    std::size_t bands_;
    PolygonScratch& scratch_;
    std::array<double, 7> weights_{};
    double total_ = 0.0;
};

// Bisects what no rule is enough for, the most doubtful first, until all doubts together are small
// against the sum: in a thick medium the near parts of a polygon matter, and nothing else.
void integrate(Mean& mean, const std::vector<Triangle>& open, std::vector<Triangle>& heap,
               double step) {
    heap.clear();
    double doubts = 0.0;
    const auto take = [&](Triangle t) {
        t.doubt = mean.try_deposit(t, step);
        if (!(t.doubt > 0.0)) return;
        doubts += t.doubt;
        heap.push_back(t);
        std::push_heap(heap.begin(), heap.end());
    };
    for (const Triangle& t : open) take(t);
    for (std::size_t count = open.size(); !heap.empty() && count < most_triangles; ++count) {
        if (doubts <= tolerance * mean.sum()) break;
        std::pop_heap(heap.begin(), heap.end());
        const Triangle t = heap.back();
        heap.pop_back();
        doubts -= t.doubt;
        for (const Triangle& half : bisect(t)) take(half);
    }
    for (const Triangle& t : heap) mean.deposit(t);
}

}  // namespace

double Hull::exit(Point x, Direction unit) const {
    double t = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (unit[axis] == 0.0) continue;
        t = std::min(t, ((unit[axis] > 0.0 ? high : low)[axis] - x[axis]) / unit[axis]);
    }
    return std::max(t, 0.0);
}

void mean_transmittance(const OpticalDepth& depth, const Receiver& receiver,
                        std::span<const Point> corners, const Hull* hull, double step,
                        std::span<double> mean) {
    std::fill(mean.begin(), mean.end(), 1.0);
    if (depth.transparent() || corners.size() < 3) return;
    thread_local PolygonScratch scratch;
    auto& open = scratch.open;
    open.clear();
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        open.push_back(
            {corners[0], corners[k], corners[k + 1],
             0.5 * glm::length(glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]))});
    // Over all corners: the first three may lie on one line.
    Direction normal(0.0);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        normal += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return;  // a part without area sends nothing
    Mean sum(depth, receiver, hull, std::abs(glm::dot(normal, corners[0])) / length, mean.size(),
             scratch);
    integrate(sum, open, scratch.heap, step);
    if (sum.total() <= 0.0) return;
    for (std::size_t band = 0; band < mean.size(); ++band)
        mean[band] = scratch.sum[band] / sum.total();
}

}  // namespace tyndall::radiosity
