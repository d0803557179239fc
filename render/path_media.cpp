#include "render/path_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/input_error.h"
#include "render/renderers.h"

namespace tyndall::render {
namespace {

using std::numbers::pi;

double ratio(double part, double whole) {
    return whole > 0.0 ? part / whole : 0.0;
}

std::size_t pick_band(std::span<const double> shares, double u) {
    std::size_t band = 0;
    while (band + 1 < shares.size() && u >= shares[band]) u -= shares[band++];
    return band;
}

void refuse_settled(const radiosity::Enclosure& e) {
    const auto refuse = [](const std::string& name) {
        throw mesh::InputError(fmt::format(
            "\"{}\" finds its temperature in several bands with the solution: paths cannot know "
            "what it emits. Render by line_of_sight.",
            name));
    };
    for (const auto& side : e.sides)
        if (side.settled_flux) refuse(side.name);
    for (const auto& medium : e.media)
        if (medium.settled_heat) refuse(medium.name);
}

}  // namespace

PathMedia::PathMedia(const radiosity::Enclosure& e) : bands_(e.bands) {
    refuse_bodies(e);
    refuse_settled(e);
    for (const auto& medium : e.media) {
        Optics o;
        o.phase = medium.phase;
        o.varying = medium.varying.empty() ? nullptr : &medium.varying;
        double scattering = 0.0, given_back = 0.0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const double absorbed = medium.absorption[b];
            const double scattered = medium.scattering.empty()
                                         ? std::max(0.0, medium.extinction[b] - absorbed)
                                         : medium.scattering[b];
            const double extinction = absorbed + scattered;
            const bool gives_back = medium.albedo[b] == 1.0 && absorbed > 0.0;
            const double back = gives_back ? absorbed : 0.0;
            o.extinction.push_back(extinction);
            o.albedo.push_back(ratio(scattered + back, extinction));
            o.given_back.push_back(ratio(back, extinction));
            o.emission.push_back(ratio(medium.emission[b] * medium.extinction[b], extinction));
            o.over_reduced.push_back(ratio(extinction, medium.extinction[b]));
            scattering += scattered;
            given_back += back;
        }
        o.isotropic_share = ratio(given_back, scattering + given_back);
        isotropic_ = isotropic_ && o.phase.isotropic();
        optics_.push_back(std::move(o));
    }
}

double PathMedia::extinction(std::uint32_t medium, std::size_t band, Point x) const {
    const Optics& o = optics_[medium];
    return o.varying ? o.over_reduced[band] * (*o.varying)[band].at(x) : o.extinction[band];
}

double PathMedia::depth(const PassedRay& ray, std::uint32_t medium, std::size_t band, double begin,
                        double end) const {
    const Optics& o = optics_[medium];
    if (!o.varying) return o.extinction[band] * (end - begin);
    return o.over_reduced[band] * (*o.varying)[band].depth(ray.origin, ray.direction, begin, end);
}

void PathMedia::transmittance(const PassedRay& ray, double end, std::span<double> result,
                              Coefficients coefficients) const {
    const bool reduced = coefficients == Coefficients::reduced;
    for (std::size_t b = 0; b < bands_; ++b) {
        double sum = 0.0;
        for (const Stretch& s : ray.stretches) {
            if (s.begin >= end) break;
            const double here = depth(ray, s.medium, b, s.begin, std::min(s.end, end));
            sum += reduced ? ratio(here, optics_[s.medium].over_reduced[b]) : here;
        }
        result[b] = std::exp(-sum);
    }
}

void PathMedia::add_emission(const PassedRay& ray, std::span<const double> weight,
                             std::span<double> radiance) const {
    for (std::size_t b = 0; b < bands_; ++b) {
        double before = 0.0;
        for (const Stretch& s : ray.stretches) {
            const double here = depth(ray, s.medium, b, s.begin, s.end);
            const double emission = optics_[s.medium].emission[b];
            if (emission > 0.0)
                radiance[b] += weight[b] * emission * std::exp(-before) * -std::expm1(-here);
            before += here;
        }
    }
}

double PathMedia::scattered(std::uint32_t medium, std::size_t band, double cosine) const {
    const Optics& o = optics_[medium];
    const double back = o.given_back[band];
    return (o.albedo[band] - back) * radiosity::phase_value(o.phase, cosine) + back / (4.0 * pi);
}

double PathMedia::albedo(std::uint32_t medium, std::size_t band) const {
    return optics_[medium].albedo[band];
}

double PathMedia::given_back(std::uint32_t medium, std::size_t band) const {
    return optics_[medium].given_back[band];
}

double PathMedia::direction_density(std::uint32_t medium, double cosine) const {
    const Optics& o = optics_[medium];
    return (1.0 - o.isotropic_share) * radiosity::phase_value(o.phase, cosine) +
           o.isotropic_share / (4.0 * pi);
}

Direction PathMedia::sample_direction(std::uint32_t medium, Direction before,
                                      RandomNumbers& random) const {
    const Optics& o = optics_[medium];
    if (o.isotropic_share > 0.0 && random() < o.isotropic_share) {
        const double u = random();
        return radiosity::uniform_direction(u, random());
    }
    const double u = random();
    return radiosity::sample_phase(o.phase, before, u, random());
}

// Where on a stretch the depth from its begin is `depth`: bisection by chords that keeps the root
// between its ends (Illinois), to a part in 10^12.
double PathMedia::invert(const PassedRay& ray, const Stretch& s, std::size_t band,
                         double wanted) const {
    const Optics& o = optics_[s.medium];
    if (!o.varying) return std::min(s.end, s.begin + wanted / o.extinction[band]);
    double low = s.begin, high = s.end;
    double at_low = -wanted, at_high = depth(ray, s.medium, band, low, high) - wanted;
    for (int step = 0; step < 100 && high - low > 1e-12 * (s.end - s.begin); ++step) {
        double t =
            step % 3 == 2 ? 0.5 * (low + high) : low - at_low * (high - low) / (at_high - at_low);
        t = std::clamp(t, low, high);
        const double at = depth(ray, s.medium, band, s.begin, t) - wanted;
        if (at == 0.0) return t;
        (at < 0.0 ? low : high) = t;
        (at < 0.0 ? at_low : at_high) = at;
    }
    return 0.5 * (low + high);
}

double PathMedia::all_depth(const PassedRay& ray, std::size_t band) const {
    double sum = 0.0;
    for (const Stretch& s : ray.stretches) sum += depth(ray, s.medium, band, s.begin, s.end);
    return sum;
}

template <class Weight>
double PathMedia::mixed_density(const PassedRay& ray, double distance, Weight&& weight) const {
    double sum = 0.0;
    for (std::size_t b = 0; b < bands_; ++b) {
        double before = 0.0;
        for (const Stretch& s : ray.stretches) {
            if (distance > s.end) {
                before += depth(ray, s.medium, b, s.begin, s.end);
                continue;
            }
            if (distance < s.begin) break;
            before += depth(ray, s.medium, b, s.begin, distance);
            sum += weight(b) * extinction(s.medium, b, ray.at(distance)) * std::exp(-before);
            break;
        }
    }
    return sum;
}

double PathMedia::density(const PassedRay& ray, double distance,
                          std::span<const double> shares) const {
    return mixed_density(ray, distance, [&](std::size_t b) { return shares[b]; });
}

double PathMedia::density_within(const PassedRay& ray, double distance,
                                 std::span<const double> shares) const {
    return mixed_density(ray, distance, [&](std::size_t b) {
        const double taken = -std::expm1(-all_depth(ray, b));
        return taken > 0.0 ? shares[b] / taken : 0.0;
    });
}

// Where the depth in a band from the ray's begin is `left`.
Collision PathMedia::place(const PassedRay& ray, std::size_t band, double left) const {
    Collision result;
    for (const Stretch& s : ray.stretches) {
        const double here = depth(ray, s.medium, band, s.begin, s.end);
        if (left < here) {
            result.scattered = true;
            result.medium = s.medium;
            result.distance = invert(ray, s, band, left);
            return result;
        }
        left -= here;
    }
    return result;
}

Collision PathMedia::sample(const PassedRay& ray, std::span<const double> shares, double u,
                            double v) const {
    Collision result = place(ray, pick_band(shares, u), -std::log1p(-v));
    if (result.scattered)
        result.density = density(ray, result.distance, shares);
    else
        for (std::size_t b = 0; b < bands_; ++b)
            result.density += shares[b] * std::exp(-all_depth(ray, b));
    return result;
}

Collision PathMedia::sample_within(const PassedRay& ray, std::span<const double> shares, double u,
                                   double v) const {
    const std::size_t band = pick_band(shares, u);
    const double taken = -std::expm1(-all_depth(ray, band));
    Collision result;
    if (!(taken > 0.0)) return result;
    result = place(ray, band, -std::log1p(-v * taken));
    if (result.scattered) result.density = density_within(ray, result.distance, shares);
    return result;
}

}  // namespace tyndall::render
