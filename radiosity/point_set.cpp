#include "radiosity/point_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tyndall::radiosity {
namespace {

using DirectionNumbers = std::array<std::array<std::uint32_t, 32>, point_set_dimensions>;

// Joe & Kuo (2008): degree s, coefficients a and initial numbers m of the first dimensions.
constexpr DirectionNumbers make_direction_numbers() {
    struct Row {
        unsigned s, a;
        std::array<std::uint32_t, 3> m;
    };
    constexpr std::array<Row, point_set_dimensions - 1> rows{
        {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}}}};
    DirectionNumbers v{};
    for (unsigned k = 0; k < 32; ++k) v[0][k] = 1u << (31 - k);
    for (std::size_t d = 0; d < rows.size(); ++d) {
        const auto& [s, a, m] = rows[d];
        auto& numbers = v[d + 1];
        for (unsigned k = 0; k < 32; ++k) {
            if (k < s) {
                numbers[k] = m[k] << (31 - k);
                continue;
            }
            numbers[k] = numbers[k - s] ^ (numbers[k - s] >> s);
            for (unsigned j = 1; j < s; ++j)
                if (a >> (s - 1 - j) & 1) numbers[k] ^= numbers[k - j];
        }
    }
    return v;
}

constexpr DirectionNumbers direction_numbers = make_direction_numbers();

std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
}

// Nested uniform (Owen) scrambling by a hash whose bits depend on higher bits only.
std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

// Cells along four dimensions: the largest product up to `count`, of those the most even.
std::array<std::size_t, 4> grid_of(std::size_t count) {
    std::array<std::size_t, 4> best{1, 1, 1, 1};
    std::size_t most = 0, spread = 0;
    const double even = std::sqrt(std::sqrt(static_cast<double>(count)));
    const auto low = static_cast<std::size_t>(std::max(1.0, even / 2.0));
    const auto high = static_cast<std::size_t>(even * 1.5) + 1;
    for (std::size_t a = low; a <= high; ++a)
        for (std::size_t b = a; b <= high; ++b)
            for (std::size_t c = b; c <= high; ++c) {
                const std::size_t d = count / (a * b * c), product = a * b * c * d;
                if (d < c || product < most || (product == most && d - a >= spread)) continue;
                most = product;
                spread = d - a;
                best = {a, c, b, d};  // places and directions alike
            }
    return best;
}

// A permutation of 0 … count − 1 that depends on `seed`: bijections of the numbers below the next
// power of two, again and again until the number is below count.
std::size_t permuted(std::size_t index, std::size_t count, std::uint64_t seed) {
    const std::uint64_t mask = std::bit_ceil(count) - 1;
    const int half = std::max(1, static_cast<int>(std::bit_width(mask)) / 2);
    std::uint64_t x = index;
    do {
        for (std::uint64_t round = 0; round < 4; ++round) {
            const std::uint64_t key = hash_seed(seed, round);
            x = (x ^ key) & mask;
            x = (x * (key >> 20 | 1u)) & mask;
            x ^= x >> half;
        }
    } while (x >= count);
    return x;
}

// Uniform in [0, 1), one for every (seed, index).
double uniform_number(std::uint64_t seed, std::uint64_t index) {
    return 0x1p-53 * static_cast<double>(hash_seed(seed, index) >> 11);
}

}  // namespace

std::uint64_t hash_seed(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t h = seed * 0x9e3779b97f4a7c15ull + index + 0x632be59bd9b4e019ull;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
}

PointSet::PointSet(std::size_t count, PointSetKind kind) : kind_(kind), count_(count) {
    if (kind == PointSetKind::stratified) cells_ = grid_of(count);
    if (kind != PointSetKind::sobol) return;
    points_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t d = 0; d < point_set_dimensions; ++d) {
            std::uint32_t x = 0;
            for (unsigned k = 0; k < 32 && (i >> k) != 0; ++k)
                if (i >> k & 1) x ^= direction_numbers[d][k];
            points_[i][d] = x;
        }
}

std::array<double, point_set_dimensions> PointSet::operator()(std::size_t index,
                                                              std::uint64_t seed) const {
    if (kind_ == PointSetKind::sobol) return sobol(index, seed);
    if (kind_ == PointSetKind::stratified) return stratified(index, seed);
    Numbers result;
    const std::uint64_t own = hash_seed(seed, index);
    for (std::size_t d = 0; d < point_set_dimensions; ++d) result[d] = uniform_number(own, d);
    return result;
}

PointSet::Numbers PointSet::stratified(std::size_t index, std::uint64_t seed) const {
    Numbers result;
    const std::uint64_t own = hash_seed(seed, index);
    for (std::size_t d = 0; d < point_set_dimensions; ++d) result[d] = uniform_number(own, d);
    result[2] = (static_cast<double>(permuted(index, count_, seed)) + result[2]) /
                static_cast<double>(count_);
    std::size_t cell = index;
    if (index < cells_[0] * cells_[1] * cells_[2] * cells_[3])
        for (std::size_t k = 0; k < 4; ++k) {
            double& u = result[k < 2 ? k : k + 1];
            u = (static_cast<double>(cell % cells_[k]) + u) / static_cast<double>(cells_[k]);
            cell /= cells_[k];
        }
    // Rounding may reach 1.
    for (double& u : result) u = std::min(u, 1.0 - 0x1p-53);
    return result;
}

PointSet::Numbers PointSet::sobol(std::size_t index, std::uint64_t seed) const {
    Numbers result;
    for (std::size_t d = 0; d < point_set_dimensions; ++d)
        result[d] = 0x1p-32 * scramble(points_[index][d],
                                       static_cast<std::uint32_t>(hash_seed(seed, d) >> 32));
    return result;
}

mesh::Direction uniform_direction(double u, double v) {
    const double z = 1.0 - 2.0 * u, r = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double phi = 2.0 * std::numbers::pi * v;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

mesh::Direction cosine_direction(mesh::Direction n, double u, double v) {
    const double r = std::sqrt(u), phi = 2.0 * std::numbers::pi * v;
    const mesh::Direction axis =
        std::abs(n.x) < 0.6 ? mesh::Direction(1, 0, 0) : mesh::Direction(0, 1, 0);
    const auto a = glm::normalize(glm::cross(axis, n));
    const auto b = glm::cross(n, a);
    return glm::normalize(r * std::cos(phi) * a + r * std::sin(phi) * b +
                          std::sqrt(std::max(1e-12, 1.0 - u)) * n);
}

mesh::Direction direction_about(mesh::Direction axis, double cosine, double v) {
    const mesh::Direction other =
        std::abs(axis.x) < 0.6 ? mesh::Direction(1, 0, 0) : mesh::Direction(0, 1, 0);
    const auto a = glm::normalize(glm::cross(other, axis)), b = glm::cross(axis, a);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double turn = 2.0 * std::numbers::pi * v;
    return cosine * axis + sine * (std::cos(turn) * a + std::sin(turn) * b);
}

std::array<double, 3> uniform_in_triangle(double u, double v) {
    const double r = std::sqrt(u);
    return {1.0 - r, r * (1.0 - v), r * v};
}

std::array<double, 4> uniform_in_tet(double u, double v, double w) {
    const double c = std::cbrt(u), r = std::sqrt(v);
    return {1.0 - c, c * (1.0 - r), c * r * (1.0 - w), c * r * w};
}

}  // namespace tyndall::radiosity
