#include "radiosity/error_estimate.h"

#include <cmath>

namespace tyndall::radiosity {
namespace {

// The halves of a scrambled net are nets themselves. Where what is integrated has edges, the error
// of a net in two dimensions falls as N^(−2/3), not as N^(−1/2) (He & Wang 2015): all rays are
// better than the difference of their halves says, by this factor.
const double whole_net = std::pow(2.0, -1.0 / 6.0);

double square(double x) {
    return x * x;
}

// Mean square deviation of a linear function from its mean over a leaf.
template <class Node>
double variance(const Forest& forest, Node leaf, const Affine& f) {
    const auto& corners = forest[leaf].corners;
    const double mean = f.at(forest.centroid(leaf));
    double sum = 0.0;
    for (const VertexId corner : corners) sum += square(f.at(forest.point(corner)) - mean);
    return sum / (std::is_same_v<Node, ZoneId> ? 20.0 : 12.0);
}

// H of the coarse elements less the mean of what has been gathered over them, and what the mean of
// direct light may be wrong by.
std::vector<double> level_difference(const ElementMesh& mesh, DirectRefiner& direct,
                                     const LeafLight& leaf_light, const CoarseSolution& coarse,
                                     const Fields& gathered) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh.forest();
    std::vector<double> sum(e.size() * e.bands, 0.0), measure(e.size() * e.bands, 0.0);
    const auto add = [&](auto leaf, std::uint32_t element) {
        for (std::size_t b = 0; b < e.bands; ++b) {
            const WeighedMean one = leaf_light.weighed(leaf, b, gathered.at(leaf, b));
            measure[element * e.bands + b] += one.measure;
            sum[element * e.bands + b] +=
                one.measure * (one.mean - direct.mean_difference(leaf, b));
        }
    };
    for (const ZoneId z : mesh.zones())
        if (forest.is_leaf(z)) add(z, leaf_light.element_above(z, e.of_zone));
    for (const PatchId p : mesh.patches())
        if (forest.is_leaf(p)) add(p, leaf_light.element_above(p, e.of_patch));
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = i * e.bands + b;
            sum[k] = measure[k] > 0.0 ? coarse.indirect(i, b) - sum[k] / measure[k] : 0.0;
        }
    return sum;
}

double scattered_of(const Solution& s, ZoneId zone, std::size_t band) {
    return scatter_of(s, zone, band);
}

// Σ c δx² over the leaves by causes, and Σ c x².
class SolutionSums {
  public:
    template <class Node>
    void add(const Solution& s, const LeafErrors& errors, Node leaf, double departure, double split,
             double capacity, std::size_t b) {
        const double a = scattered_of(s, leaf, b), weight = capacity * a * a;
        const Point x = s.forest.centroid(leaf);
        elements_ += weight * square(departure);
        gathers_ += weight * square(errors.gathers.at(leaf, b).at(x));
        coarse_ += weight * square(errors.coarse.at(leaf, b).at(x));
        const double h = s.direct.at(leaf, b).Affine::at(x) + s.indirect.at(leaf, b).Affine::at(x);
        whole_ += capacity * square(emission_of(s, leaf, b) - split + a * h);
    }
    ErrorParts parts() const {
        if (!(whole_ > 0.0)) return {};
        return {std::sqrt(elements_ / whole_), std::sqrt(gathers_ / whole_),
                std::sqrt(coarse_ / whole_)};
    }

  private:
    double elements_ = 0.0, gathers_ = 0.0, coarse_ = 0.0, whole_ = 0.0;
};

// Error of a leaf's x, mean over bands of all causes.
template <class Node>
double leaf_error(const Solution& s, const LeafErrors& errors, Node leaf, double departure) {
    const Point x = s.forest.centroid(leaf);
    double sum = 0.0;
    for (std::size_t b = 0; b < errors.gathers.bands; ++b)
        sum += scattered_of(s, leaf, b) *
               std::sqrt(square(departure) + square(errors.gathers.at(leaf, b).at(x)) +
                         square(errors.coarse.at(leaf, b).at(x)));
    return sum / static_cast<double>(errors.gathers.bands);
}

}  // namespace

std::vector<double> coarse_errors(const ElementMesh& mesh, DirectRefiner& direct,
                                  const LeafLight& leaf_light, const CoarseSolution& coarse,
                                  const Fields& gathered) {
    direct.light_middles();
    return coarse.carried(level_difference(mesh, direct, leaf_light, coarse, gathered));
}

LeafErrors leaf_errors(const Enclosure& enclosure, ElementMesh& mesh, DirectRefiner& direct,
                       IndirectRefiner& indirect, LeafLight& leaf_light,
                       const CoarseSolution& coarse, const std::vector<double>& coarse_errors,
                       Radiance radiance) {
    const Forest& forest = mesh.forest();
    const Elements& e = coarse.elements();
    const std::size_t bands = enclosure.bands;
    LeafErrors errors;
    errors.gathers.resize(forest, bands);
    errors.coarse.resize(forest, bands);
    errors.zone_elements.resize(forest.zone_count());
    errors.patch_elements.resize(forest.patch_count());
    errors.patch_direct.resize(forest.patch_count());
    direct.light_middles();
    // Squares of what leaves hold too coarsely, of direct and of indirect light.
    const auto fill = [&](auto leaf, std::uint32_t element) {
        double of_direct = square(direct.error(leaf)), of_indirect = square(indirect.error(leaf));
        constexpr bool is_zone = std::is_same_v<decltype(leaf), ZoneId>;
        const double seen = square(is_zone ? chord_share : 1.0) / static_cast<double>(bands);
        for (std::size_t b = 0; b < bands; ++b) {
            Affine noise = indirect.noise(leaf, b);
            noise = {whole_net * noise.gradient, whole_net * noise.constant};
            errors.gathers.at(leaf, b) = noise;
            errors.coarse.at(leaf, b).constant = coarse_errors[element * bands + b];
            of_direct += square(direct.mean_difference(leaf, b)) / static_cast<double>(bands);
            if (radiance != Radiance::constant) continue;
            of_direct += seen * variance(forest, leaf, leaf_light.direct(leaf, b));
            of_indirect += seen * variance(forest, leaf, indirect.field(leaf, b));
        }
        return std::pair(of_direct, of_indirect);
    };
    for (const ZoneId z : mesh.zones()) {
        if (!forest.is_leaf(z)) continue;
        const auto [d, i] = fill(z, leaf_light.element_above(z, e.of_zone));
        errors.zone_elements[z.value] = static_cast<float>(std::sqrt(d + i));
    }
    for (const PatchId p : mesh.patches()) {
        if (!forest.is_leaf(p)) continue;
        const auto [d, i] = fill(p, leaf_light.element_above(p, e.of_patch));
        errors.patch_elements[p.value] = static_cast<float>(std::sqrt(d + i));
        errors.patch_direct[p.value] = static_cast<float>(std::sqrt(d));
    }
    if (radiance == Radiance::constant) flatten(forest, errors.gathers);
    return errors;
}

void estimate_errors(const LeafErrors& errors, const std::optional<View>& view, Solution& s) {
    const Enclosure& enclosure = *s.enclosure;
    SolutionSums sums;
    for (std::size_t z = 0; z < s.forest.zone_count(); ++z) {
        const ZoneId zone(z);
        const auto medium = medium_of(enclosure, s.forest, zone);
        if (!s.forest.is_leaf(zone) || medium == none) continue;
        const double departure = errors.zone_elements[z];
        s.zone_error[z] = static_cast<float>(leaf_error(s, errors, zone, departure));
        for (std::size_t b = 0; b < enclosure.bands; ++b)
            sums.add(s, errors, zone, departure, 0.0,
                     4.0 * extinction_in(enclosure, s.forest, zone, b).mean * s.forest.volume(zone),
                     b);
    }
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!s.forest.is_leaf(patch) || side_of(enclosure, s.forest, patch) == none) continue;
        const double departure = errors.patch_elements[p];
        s.patch_error[p] = static_cast<float>(leaf_error(s, errors, patch, departure));
        for (std::size_t b = 0; b < enclosure.bands; ++b)
            sums.add(s, errors, patch, departure, split_emission_of(s, patch, b),
                     s.forest.area(patch), b);
    }
    s.patch_direct_error = errors.patch_direct;
    s.report.solution_error = sums.parts();
    if (view) s.report.picture_error = picture_error(s, errors, *view);
}

}  // namespace tyndall::radiosity
