#include "radiosity/solution.h"

namespace tyndall::radiosity {
namespace {

const MediumOptics* optics(const Solution& s, ZoneId zone) {
    const auto medium = medium_of(*s.enclosure, s.forest, zone);
    return medium == none ? nullptr : &s.enclosure->media[medium];
}

const SurfaceSide* side(const Solution& s, PatchId patch) {
    const auto index = side_of(*s.enclosure, s.forest, patch);
    return index == none ? nullptr : &s.enclosure->sides[index];
}

Affine combine(double emission, double scatter, const Affine& direct, const Affine& indirect) {
    return {scatter * (direct.gradient + indirect.gradient),
            emission + scatter * (direct.constant + indirect.constant)};
}

}  // namespace

double emission_of(const Solution& solution, ZoneId zone, std::size_t band) {
    if (!solution.settled.zone.empty())
        return solution.settled.zone[zone.value * solution.enclosure->bands + band];
    const auto* medium = optics(solution, zone);
    return medium ? medium->emission[band] : 0.0;
}

double scatter_of(const Solution& solution, ZoneId zone, std::size_t band) {
    const auto* medium = optics(solution, zone);
    return medium ? medium->albedo[band] : 0.0;
}

double emission_of(const Solution& solution, PatchId patch, std::size_t band) {
    if (!solution.settled.patch.empty())
        return solution.settled.patch[patch.value * solution.enclosure->bands + band];
    const auto* surface = side(solution, patch);
    return surface ? surface->emission[band] : 0.0;
}

double scatter_of(const Solution& solution, PatchId patch, std::size_t band) {
    const auto* surface = side(solution, patch);
    return surface ? surface->reflectance[band] : 0.0;
}

double scattered_of(const Solution& solution, PatchId patch, std::size_t band) {
    const auto* surface = side(solution, patch);
    return surface ? surface->scattered(band) : 0.0;
}

double split_emission_of(const Solution& s, PatchId patch, std::size_t band) {
    const SurfaceSide* surface = side(s, patch);
    const bool split =
        s.direct_light == DirectLightMode::closed_form && surface && shines(*surface);
    return split ? surface->emission[band] : 0.0;
}

Fields reflected_sources(const Solution& s) {
    Fields sources;
    sources.resize(s.forest, s.enclosure->bands);
    for (std::size_t z = 0; z < s.forest.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!s.forest.is_leaf(zone)) continue;
        for (std::size_t b = 0; b < sources.bands; ++b)
            sources.at(zone, b) = combine(emission_of(s, zone, b), scatter_of(s, zone, b),
                                          s.direct.at(zone, b), s.indirect.at(zone, b));
    }
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!s.forest.is_leaf(patch)) continue;
        for (std::size_t b = 0; b < sources.bands; ++b)
            sources.at(patch, b) =
                combine(emission_of(s, patch, b) - split_emission_of(s, patch, b),
                        scattered_of(s, patch, b), s.direct.at(patch, b), s.indirect.at(patch, b));
    }
    coarsen(s.forest, sources);
    return sources;
}

std::vector<Affine> sources_in_mirrors(const Solution& s) {
    if (!s.enclosure->has_mirrors()) return {};
    const std::size_t bands = s.enclosure->bands;
    std::vector<Affine> result(s.forest.patch_count() * bands);
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p)
        for (std::size_t b = 0; b < bands; ++b)
            result[p * bands + b].constant = split_emission_of(s, PatchId(p), b);
    return result;
}

}  // namespace tyndall::radiosity
