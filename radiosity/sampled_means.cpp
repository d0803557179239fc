#include "radiosity/sampled_means.h"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>

#include "radiosity/open_places.h"
#include "radiosity/point_set.h"
#include "radiosity/quadratic.h"

namespace tyndall::radiosity {
namespace {

// A net of 32 points finds the lit share of a leaf to a tenth or better; what is left has either
// sign from leaf to leaf.
const PointSet& net_points() {
    static const PointSet set(32);
    return set;
}

// Ten numbers ask for more.
const PointSet& more_points() {
    static const PointSet set(64);
    return set;
}

// Lagrange functions at the place with these barycentric coordinates, linear and quadratic.
void functions_at(const std::array<double, 4>& w, Eigen::Vector4d& phi) {
    phi = Eigen::Map<const Eigen::Vector4d>(w.data());
}

void functions_at(const std::array<double, 4>& w, Eigen::Matrix<double, 10, 1>& phi) {
    phi = Eigen::Map<const Eigen::Matrix<double, 10, 1>>(lagrange(w).data());
}

// The function that has these values there.
LeafFunction function_with(const std::array<Point, 4>& corners, const Eigen::Vector4d& h) {
    return {interpolate(corners, {h[0], h[1], h[2], h[3]}), {}};
}

LeafFunction function_with(const std::array<Point, 4>& corners,
                           const Eigen::Matrix<double, 10, 1>& h) {
    std::array<double, 6> departures;
    for (int i = 0, edge = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j, ++edge)
            departures[edge] = h[4 + edge] - 0.5 * (h[i] + h[j]);
    return interpolate(corners, {h[0], h[1], h[2], h[3]}, departures);
}

// Streams of their own for zones and patches, so that no leaf has the points of another.
constexpr std::uint64_t zone_seed = 0x7a6f6e65, patch_seed = 0x70617463;

}  // namespace

template <int functions>
void SampledMeans::fit(ZoneId zone, std::size_t place) {
    using Vector = Eigen::Matrix<double, functions, 1>;
    using Matrix = Eigen::Matrix<double, functions, functions>;
    std::array<Point, 4> corners;
    for (int c = 0; c < 4; ++c) corners[c] = forest_.point(forest_[zone].corners[c]);
    const TetId tet = forest_.base_tet(zone);
    const std::size_t bands = enclosure_.bands;
    const PointSet& points = functions == 4 ? net_points() : more_points();
    std::vector<double> incident(bands);
    // Σ_k φ φᵀ, and of each band Σ_k φ H.
    Matrix squares = Matrix::Zero();
    std::vector<Vector> products(bands, Vector::Zero());
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto u = points(k, hash_seed(zone_seed, zone.value));
        const auto w = uniform_in_tet(u[0], u[1], u[2]);
        Point x(0.0);
        for (int c = 0; c < 4; ++c) x += w[c] * corners[c];
        const OpenPlace open = open_place(enclosure_, x, tet);
        light_.at_zone(open.x, open.tet, incident);
        Vector phi;
        functions_at(w, phi);
        squares += phi * phi.transpose();
        for (std::size_t b = 0; b < bands; ++b) {
            zones_.means[place + b] += incident[b] / static_cast<double>(points.size());
            products[b] += incident[b] * phi;
        }
    }
    const Eigen::LDLT<Matrix> system(squares);
    for (std::size_t b = 0; b < bands; ++b) {
        const Vector h = system.solve(products[b]);
        LeafFunction& fit = fits_[place + b];
        fit = function_with(corners, h);
        fit.constant += zones_.means[place + b] - fit.Affine::at(forest_.centroid(zone));
    }
}

void SampledMeans::evaluate(PatchId patch, std::size_t place) {
    const auto& corners = forest_[patch].corners;
    const TetId tet =
        mesh::tet_before(enclosure_.mesh, forest_.base_facet_side(patch), forest_.centroid(patch));
    const Direction normal = normal_of(forest_, patch);
    std::vector<double> incident(enclosure_.bands);
    for (std::size_t k = 0; k < net_points().size(); ++k) {
        const auto u = net_points()(k, hash_seed(patch_seed, patch.value));
        const auto w = uniform_in_triangle(u[0], u[1]);
        Point x(0.0);
        for (int c = 0; c < 3; ++c) x += w[c] * forest_.point(corners[c]);
        light_.at_patch(x, normal, tet, incident);
        for (std::size_t b = 0; b < incident.size(); ++b)
            patches_.means[place + b] += incident[b] / static_cast<double>(net_points().size());
    }
}

template <class Node>
void SampledMeans::add(const std::vector<Node>& nodes, Sampled& sampled) {
    std::vector<Node> fresh;
    for (const Node node : nodes) {
        if (node.value >= sampled.place.size()) sampled.place.resize(node.value + 1ull, none);
        if (sampled.place[node.value] != none) continue;
        sampled.place[node.value] = static_cast<std::uint32_t>(sampled.means.size());
        sampled.means.resize(sampled.means.size() + enclosure_.bands, 0.0);
        fresh.push_back(node);
    }
    if constexpr (std::is_same_v<Node, ZoneId>) fits_.resize(sampled.means.size());
    tbb::parallel_for(std::size_t(0), fresh.size(),
                      [&](std::size_t k) { evaluate(fresh[k], sampled.place[fresh[k].value]); });
}

template void SampledMeans::add(const std::vector<ZoneId>&, Sampled&);
template void SampledMeans::add(const std::vector<PatchId>&, Sampled&);

}  // namespace tyndall::radiosity
