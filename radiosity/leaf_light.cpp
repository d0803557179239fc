#include "radiosity/leaf_light.h"

#include <algorithm>

#include "radiosity/open_places.h"

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

LeafFunction LeafLight::direct_with_mean(ZoneId leaf, std::size_t band) {
    const Affine between = between_corners(leaf, band);
    const LeafFunction* fitted = direct_.fitted(leaf, band);
    if (!fitted) return {between, {}};
    const double share = share_of_ends(enclosure_, mesh_.forest(), leaf);
    LeafFunction f = *fitted;
    f.gradient += share * (between.gradient - f.gradient);
    f.constant += share * (between.constant - f.constant);
    if (radiance_ != Radiance::quadratic) return f;
    std::array<Point, 4> corners;
    for (std::size_t k = 0; k < 4; ++k)
        corners[k] = mesh_.forest().point(mesh_.forest()[leaf].corners[k]);
    for (double& second : f.bend.second) second *= 1.0 - share;
    f.bend = bend_with(f.bend.second, corners);  // as files have it, to the last bit
    return f;
}

template Affine LeafLight::direct(ZoneId, std::size_t);
template Affine LeafLight::direct(PatchId, std::size_t);

WeighedMean LeafLight::weighed_direct(PatchId leaf, std::size_t band) {
    const Forest& forest = mesh_.forest();
    return {open_share(enclosure_, forest, leaf, leaf_share_points) * forest.area(leaf),
            direct_.mean(leaf, band)};
}

WeighedMean LeafLight::weighed(PatchId leaf, std::size_t, const Affine& function) const {
    const Forest& forest = mesh_.forest();
    return {open_share(enclosure_, forest, leaf, leaf_share_points) * forest.area(leaf),
            function.at(forest.centroid(leaf))};
}

WeighedMean LeafLight::weighed(ZoneId leaf, std::size_t band, const Affine& function) const {
    const Forest& forest = mesh_.forest();
    const double volume =
        open_share(enclosure_, forest, leaf, leaf_share_points) * forest.volume(leaf);
    const MediumOptics& optics = enclosure_.media[medium_of(enclosure_, forest, leaf)];
    if (optics.varying.empty()) return {volume, function.at(forest.centroid(leaf))};
    const auto [mean, centre] = extinction_in(enclosure_, forest, leaf, band);
    return {std::max(mean, least_density * optics.extinction[band]) * volume, function.at(centre)};
}

WeighedMean LeafLight::weighed_direct(ZoneId leaf, std::size_t band) {
    const Forest& forest = mesh_.forest();
    if (enclosure_.media[medium_of(enclosure_, forest, leaf)].varying.empty())
        return {open_share(enclosure_, forest, leaf, leaf_share_points) * forest.volume(leaf),
                direct_.mean(leaf, band)};
    return weighed(leaf, band, direct_with_mean(leaf, band));
}

std::vector<double> LeafLight::means_of_direct(const Elements& e) {
    const std::size_t bands = enclosure_.bands;
    std::vector<double> result(e.size() * bands, 0.0);
    std::vector<double> measure(e.size() * bands, 0.0);
    const auto add = [&](auto node, std::uint32_t element) {
        for (std::size_t b = 0; b < bands; ++b) {
            const WeighedMean one = weighed_direct(node, b);
            measure[element * bands + b] += one.measure;
            result[element * bands + b] += one.measure * one.mean;
        }
    };
    const Forest& forest = mesh_.forest();
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) add(z, element_above(z, e.of_zone));
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) add(p, element_above(p, e.of_patch));
    for (std::size_t k = 0; k < measure.size(); ++k)
        if (measure[k] > 0.0) result[k] /= measure[k];
    return result;
}

Fields LeafLight::lit_patches() {
    const Forest& forest = mesh_.forest();
    Fields lit;
    lit.resize(forest, enclosure_.bands);
    for (const PatchId p : mesh_.patches())
        for (std::size_t b = 0; forest.is_leaf(p) && b < lit.bands; ++b) {
            const double a = enclosure_.sides[side_of(enclosure_, forest, p)].scattered(b);
            const Affine f = direct_with_mean(p, b);
            lit.at(p, b) = {a * f.gradient, a * f.constant};
        }
    if (radiance_ == Radiance::constant) flatten(forest, lit);
    return lit;
}

std::vector<Affine> LeafLight::in_mirrors(const CoarseSolution& coarse, bool lit) {
    if (!enclosure_.has_mirrors()) return {};
    const Forest& forest = mesh_.forest();
    const std::size_t bands = enclosure_.bands;
    std::vector<Affine> result(forest.patch_count() * bands);
    for (const PatchId p : mesh_.patches()) {
        if (!forest.is_leaf(p)) continue;
        const SurfaceSide& side = enclosure_.sides[side_of(enclosure_, forest, p)];
        const std::uint32_t element = element_above(p, coarse.elements().of_patch);
        for (std::size_t b = 0; b < bands; ++b) {
            const double a = lit ? side.scattered(b) : 0.0;
            const Affine f = direct_with_mean(p, b);
            result[p.value * bands + b] = {a * f.gradient,
                                           a * f.constant + coarse.elements().seen(element, b) *
                                                                coarse.split_emission(element, b)};
        }
    }
    return result;
}

Fields LeafLight::sources(const CoarseSolution& coarse, const LitPatches* lit) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh_.forest();
    Fields result;
    result.resize(forest, e.bands);
    const std::vector<Affine> indirect = coarse.linear_indirect();
    const auto fill = [&](auto node, std::uint32_t element) {
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = element * e.bands + b;
            Affine f = direct_with_mean(node, b);
            const double seen = e.seen(element, b), a = seen * e.scatter[k];
            if (lit && std::is_same_v<decltype(node), PatchId>) f = {};
            const Affine& g = indirect[k];
            result.at(node, b) = {
                a * (f.gradient + g.gradient),
                seen * (coarse.emission(element, b) - coarse.split_emission(element, b)) +
                    a * (f.constant + g.constant)};
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

void LeafLight::update_zones(const CoarseSolution& coarse, IndirectRefiner& indirect,
                             Fields& sources) {
    const Forest& forest = mesh_.forest();
    extend(forest, sources);
    for (const ZoneId z : mesh_.zones()) {
        if (!forest.is_leaf(z)) continue;
        const MediumOptics& optics = enclosure_.media[medium_of(enclosure_, forest, z)];
        const std::uint32_t element = element_above(z, coarse.elements().of_zone);
        for (std::size_t b = 0; b < sources.bands; ++b) {
            const Affine d = direct_with_mean(z, b), i = indirect.field(z, b);
            sources.at(z, b) = {
                optics.albedo[b] * (d.gradient + i.gradient),
                coarse.emission(element, b) + optics.albedo[b] * (d.constant + i.constant)};
        }
    }
    if (radiance_ == Radiance::constant) flatten(forest, sources);
    coarsen(forest, sources);
}

Solution::SettledEmission LeafLight::settled(const CoarseSolution& coarse) const {
    const Forest& forest = mesh_.forest();
    const Elements& e = coarse.elements();
    Solution::SettledEmission result;
    result.zone.resize(forest.zone_count() * e.bands);
    result.patch.resize(forest.patch_count() * e.bands);
    const auto fill = [&](auto node, std::uint32_t element, std::vector<double>& values) {
        for (std::size_t b = 0; b < e.bands; ++b)
            values[node.value * e.bands + b] = e.seen(element, b) * coarse.emission(element, b);
    };
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) fill(z, element_above(z, e.of_zone), result.zone);
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) fill(p, element_above(p, e.of_patch), result.patch);
    return result;
}

Fields LeafLight::indirect(const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    const std::vector<Affine> of_elements = coarse.linear_indirect();
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
