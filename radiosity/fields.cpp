#include "radiosity/fields.h"

#include "radiosity/coarsen_nodes.h"

namespace tyndall::radiosity {

Affine interpolate(const std::array<Point, 4>& p, const std::array<double, 4>& f) {
    const auto a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
    const auto bc = glm::cross(b, c), ca = glm::cross(c, a), ab = glm::cross(a, b);
    const double determinant = glm::dot(a, bc);
    const double scale = glm::length(a) * glm::length(b) * glm::length(c);
    const double mean = 0.25 * (f[0] + f[1] + f[2] + f[3]);
    if (!(std::abs(determinant) > 1e-9 * scale)) return {Direction(0.0), mean};
    Affine result;
    result.gradient = ((f[1] - f[0]) * bc + (f[2] - f[0]) * ca + (f[3] - f[0]) * ab) / determinant;
    const Point centroid = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    result.constant = mean - glm::dot(result.gradient, centroid);
    return result;
}

Affine interpolate(const std::array<Point, 3>& p, const std::array<double, 3>& f) {
    const auto a = p[1] - p[0], b = p[2] - p[0];
    const auto n = glm::cross(a, b);
    const double square = glm::dot(n, n);
    const double mean = (f[0] + f[1] + f[2]) / 3.0;
    if (!(square > 1e-18 * glm::dot(a, a) * glm::dot(b, b))) return {Direction(0.0), mean};
    Affine result;
    result.gradient =
        ((f[1] - f[0]) * glm::cross(b, n) + (f[2] - f[0]) * glm::cross(n, a)) / square;
    const Point centroid = (p[0] + p[1] + p[2]) / 3.0;
    result.constant = mean - glm::dot(result.gradient, centroid);
    return result;
}

namespace {

template <std::size_t n>
Bend centred(const std::array<double, 6>& second, const std::array<Point, n>& corners) {
    Bend bend{second};
    for (const Point& corner : corners) bend.centre += corner / double(n);
    for (const Point& corner : corners)
        bend.mean += bend.along(corner - bend.centre) / double(n * (n + 1));
    return bend;
}

template <std::size_t n>
std::array<double, 6> second_of(const std::array<Point, n>& corners,
                                const std::array<double, n*(n - 1) / 2>& departures) {
    std::array<Direction, n> slopes;  // ∇λ
    for (std::size_t i = 0; i < n; ++i) {
        std::array<double, n> one{};
        one[i] = 1.0;
        slopes[i] = interpolate(corners, one).gradient;
    }
    std::array<double, 6> second{};
    std::size_t edge = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j, ++edge) {
            const Direction a = 4.0 * departures[edge] * slopes[i], b = slopes[j];
            const std::array<double, 6> one{2.0 * a.x * b.x,       2.0 * a.y * b.y,
                                            2.0 * a.z * b.z,       a.x * b.y + a.y * b.x,
                                            a.x * b.z + a.z * b.x, a.y * b.z + a.z * b.y};
            for (std::size_t k = 0; k < 6; ++k) second[k] += one[k];
        }
    return second;
}

template <std::size_t n>
LeafFunction interpolated(const std::array<Point, n>& corners, std::array<double, n> values,
                          const std::array<double, n*(n - 1) / 2>& departures) {
    const Bend bend = bend_of(corners, departures);
    for (std::size_t k = 0; k < n; ++k) values[k] -= bend.at(corners[k]);
    return {interpolate(corners, values), bend};
}

}  // namespace

Bend bend_with(const std::array<double, 6>& second, const std::array<Point, 4>& corners) {
    return centred(second, corners);
}

Bend bend_with(const std::array<double, 6>& second, const std::array<Point, 3>& corners) {
    return centred(second, corners);
}

Bend bend_of(const std::array<Point, 4>& corners, const std::array<double, 6>& departures) {
    return centred(second_of(corners, departures), corners);
}

Bend bend_of(const std::array<Point, 3>& corners, const std::array<double, 3>& departures) {
    return centred(second_of(corners, departures), corners);
}

LeafFunction interpolate(const std::array<Point, 4>& corners, const std::array<double, 4>& values,
                         const std::array<double, 6>& departures) {
    return interpolated(corners, values, departures);
}

LeafFunction interpolate(const std::array<Point, 3>& corners, const std::array<double, 3>& values,
                         const std::array<double, 3>& departures) {
    return interpolated(corners, values, departures);
}

Affine with_mean(const Affine& function, Point centroid, double mean) {
    const double present = function.at(centroid);
    if (!(present > 0.0)) return {Direction(0.0), mean};
    return {function.gradient * (mean / present), function.constant * (mean / present)};
}

void extend(const Forest& forest, Fields& fields) {
    const std::size_t zones = fields.zone.size() / fields.bands;
    const std::size_t patches = fields.patch.size() / fields.bands;
    fields.resize(forest, fields.bands);
    for (std::size_t b = 0; b < fields.bands; ++b) {
        for (std::size_t z = zones; z < forest.zone_count(); ++z)
            fields.at(ZoneId(z), b) = fields.at(forest[ZoneId(z)].parent, b);
        for (std::size_t p = patches; p < forest.patch_count(); ++p)
            fields.at(PatchId(p), b) = fields.at(forest[PatchId(p)].parent, b);
    }
}

void flatten(const Forest& forest, Fields& fields) {
    const auto to_constant = [&](auto node) {
        if (!forest.is_leaf(node)) return;
        for (std::size_t b = 0; b < fields.bands; ++b)
            fields.at(node, b) = {Direction(0.0), fields.at(node, b).at(forest.centroid(node))};
    };
    for (std::size_t z = 0; z < forest.zone_count(); ++z) to_constant(ZoneId(z));
    for (std::size_t p = 0; p < forest.patch_count(); ++p) to_constant(PatchId(p));
}

void coarsen(const Forest& forest, Fields& fields) {
    coarsen_nodes<ZoneId>(forest, forest.zone_count(), fields);
}

}  // namespace tyndall::radiosity
