#include "radiosity/leaf_light.h"

namespace tyndall::radiosity {

template <class Node>
Affine LeafLight::direct(Node node, std::size_t band) {
    const Forest& forest = mesh_.forest();
    const auto samples = mesh_.lit_corners(node);
    std::array<Point, std::tuple_size_v<decltype(samples)>> points;
    std::array<double, std::tuple_size_v<decltype(samples)>> values;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        points[k] = forest.point(forest[node].corners[k]);
        values[k] = mesh_.samples().direct(samples[k], band);
    }
    return interpolate(points, values);
}

template Affine LeafLight::direct(ZoneId, std::size_t);
template Affine LeafLight::direct(PatchId, std::size_t);

LitPatches LeafLight::lit_patches() {
    const Forest& forest = mesh_.forest();
    Fields lit;
    lit.resize(forest, enclosure_.bands);
    for (const PatchId p : mesh_.patches())
        for (std::size_t b = 0; forest.is_leaf(p) && b < lit.bands; ++b) {
            const double a = enclosure_.sides[side_of(enclosure_, forest, p)].reflectance[b];
            const Affine f = direct_with_mean(p, b);
            lit.at(p, b) = {a * f.gradient, a * f.constant};
        }
    if (radiance_ == Radiance::constant) flatten(forest, lit);
    return {enclosure_, forest, lit};
}

// Indirect light of the coarse elements, linear between the means of those that meet at a corner,
// each element's own mean kept ([element * bands + band]).
std::vector<Affine> LeafLight::linear_indirect(const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh_.forest();
    std::vector<double> sum, weight;
    std::vector<Affine> result(e.size() * e.bands);
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k].constant = coarse.indirect(k / e.bands, k % e.bands);
    if (!e.member_starts.empty()) return result;  // clusters have no corners
    const auto each_corner = [&](auto&& visit) {
        for (std::size_t i = 0; i < e.patches.size(); ++i)
            visit(i, e.patches[i], mesh_.corners(e.patches[i]), forest.area(e.patches[i]));
        for (std::size_t k = 0; k < e.zones.size(); ++k)
            visit(e.patches.size() + k, e.zones[k], mesh_.corners(e.zones[k]),
                  forest.volume(e.zones[k]));
    };
    each_corner([&](std::size_t i, auto, const auto& corners, double size) {
        for (const SampleId id : corners) {
            if (id.value >= weight.size()) {
                weight.resize(mesh_.samples().size());
                sum.resize(mesh_.samples().size() * e.bands);
            }
            weight[id.value] += size;
            for (std::size_t b = 0; b < e.bands; ++b)
                sum[id.value * e.bands + b] += size * coarse.indirect(i, b);
        }
    });
    each_corner([&](std::size_t i, auto node, const auto& corners, double) {
        std::array<Point, std::tuple_size_v<std::decay_t<decltype(corners)>>> points;
        std::array<double, points.size()> values;
        for (std::size_t b = 0; b < e.bands; ++b) {
            for (std::size_t k = 0; k < corners.size(); ++k) {
                points[k] = forest.point(forest[node].corners[k]);
                values[k] = sum[corners[k].value * e.bands + b] / weight[corners[k].value];
            }
            result[i * e.bands + b] = with_mean(interpolate(points, values), forest.centroid(node),
                                                coarse.indirect(i, b));
        }
    });
    return result;
}

Fields LeafLight::sources(const CoarseSolution& coarse, const LitPatches* lit) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh_.forest();
    Fields result;
    result.resize(forest, e.bands);
    const std::vector<Affine> indirect = linear_indirect(coarse);
    const auto fill = [&](auto node, std::uint32_t element) {
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = element * e.bands + b;
            Affine f = direct_with_mean(node, b);
            const double a = e.scatter[k];
            if (lit && std::is_same_v<decltype(node), PatchId>) f = {};
            const Affine& g = indirect[k];
            result.at(node, b) = {
                a * (f.gradient + g.gradient),
                e.emission[k] - coarse.split_emission(element, b) + a * (f.constant + g.constant)};
        }
    };
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) fill(z, element_above(z, e.of_zone));
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) fill(p, element_above(p, e.of_patch));
    if (radiance_ == Radiance::constant) flatten(forest, result);
    coarsen(forest, result);
    return result;
}

void LeafLight::update_zones(IndirectRefiner& indirect, Fields& sources) {
    const Forest& forest = mesh_.forest();
    extend(forest, sources);
    for (const ZoneId z : mesh_.zones()) {
        if (!forest.is_leaf(z)) continue;
        const MediumOptics& optics = enclosure_.media[medium_of(enclosure_, forest, z)];
        for (std::size_t b = 0; b < sources.bands; ++b) {
            const Affine d = direct_with_mean(z, b), i = indirect.field(z, b);
            sources.at(z, b) = {optics.albedo[b] * (d.gradient + i.gradient),
                                optics.emission[b] + optics.albedo[b] * (d.constant + i.constant)};
        }
    }
    if (radiance_ == Radiance::constant) flatten(forest, sources);
    coarsen(forest, sources);
}

Fields LeafLight::indirect(const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    const std::vector<Affine> of_elements = linear_indirect(coarse);
    Fields result;
    result.resize(mesh_.forest(), e.bands);
    const auto fill = [&](auto node, std::uint32_t element) {
        for (std::size_t b = 0; b < e.bands; ++b)
            result.at(node, b) = of_elements[element * e.bands + b];
    };
    for (const ZoneId z : mesh_.zones())
        if (mesh_.forest().is_leaf(z)) fill(z, element_above(z, e.of_zone));
    for (const PatchId p : mesh_.patches())
        if (mesh_.forest().is_leaf(p)) fill(p, element_above(p, e.of_patch));
    return result;
}

}  // namespace tyndall::radiosity
