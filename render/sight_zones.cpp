#include "render/sight_zones.h"

#include <algorithm>

namespace tyndall::render {

using mesh::TetId;
using mesh::ZoneId;
using radiosity::Affine;
using radiosity::dot;

namespace {

// Of each band: a H^A and a H^I, gradient and constant, and what is emitted; then what a H^A bends
// by, H, c and m of Bend.
constexpr std::size_t linear_numbers = 9, bend_numbers = 10;
constexpr std::size_t line_length = 16;

void pack(const Affine& f, double scale, float* to) {
    for (int k = 0; k < 3; ++k) to[k] = float(scale * f.gradient[k]);
    to[3] = float(scale * f.constant);
}

void pack(const radiosity::Bend& bend, double scale, float* to) {
    for (int k = 0; k < 6; ++k) to[k] = float(scale * bend.second[k]);
    for (int k = 0; k < 3; ++k) to[6 + k] = float(bend.centre[k]);
    to[9] = float(scale * bend.mean);
}

// u^T H u.
float along(const float* h, const float* u) {
    return h[0] * u[0] * u[0] + h[1] * u[1] * u[1] + h[2] * u[2] * u[2] +
           2.0f * (h[3] * u[0] * u[1] + h[4] * u[0] * u[2] + h[5] * u[1] * u[2]);
}

// Of a bend at two places on a ray, and half way less the mean of those.
struct BentAlong {
    float in, out, between;
};

BentAlong bent_along(const float* bend, const radiosity::PackedRay& ray, float t_in, float t_out) {
    const auto at = [&](float t) {
        float u[3];
        for (int k = 0; k < 3; ++k) u[k] = ray.origin[k] + t * ray.direction[k] - bend[6 + k];
        return 0.5f * (along(bend, u) - bend[9]);
    };
    const float length = t_out - t_in;
    return {at(t_in), at(t_out), -0.125f * length * length * along(bend, ray.direction)};
}

}  // namespace

SightZones::SightZones(const radiosity::Solution& s)
    : e_(*s.enclosure),
      bands_(e_.bands),
      bent_(!s.direct.zone_bend.empty()),
      numbers_(linear_numbers + (bent_ ? bend_numbers : 0)),
      stride_((numbers_ * bands_ + line_length - 1) / line_length),
      zones_(radiosity::packed_zones(s.forest)),
      lines_(s.forest.zone_count() * stride_) {
    for (std::size_t z = 0; z < s.forest.zone_count(); ++z) {
        const ZoneId zone(z);
        if (!s.forest.is_leaf(zone)) continue;
        float* of_band = lines_[z * stride_].values;
        for (std::size_t b = 0; b < bands_; ++b, of_band += numbers_) {
            const double a = radiosity::scatter_of(s, zone, b);
            const radiosity::LeafFunction direct = s.direct.at(zone, b);
            pack(direct, a, of_band);
            pack(s.indirect.at(zone, b), a, of_band + 4);
            of_band[8] = float(radiosity::emission_of(s, zone, b));
            if (bent_) pack(direct.bend, a, of_band + linear_numbers);
        }
    }
}

bool SightZones::cross(const SightRay& ray, TetId tet, double t_in, double t_out, Seen& seen,
                       const SingleScattering* scattered, double anew) const {
    thread_local std::vector<double> along;
    along.resize(bands_);
    using radiosity::PackedZone;
    return radiosity::descend_packed(
        zones_, tet.value, ray.packed, float(t_in), float(t_out),
        [&](std::uint32_t zone, const PackedZone&, float) {
            __builtin_prefetch(leaf(zone));
            return false;
        },
        [&](std::uint32_t zone, const PackedZone&, float in, float out) {
            if (!(out > in)) return true;
            const bool asked = scattered && scattered->along(ray.ray, ZoneId(zone), in, out,
                                                             seen.transmittance, along);
            return gain(ray, zone, tet, in, out, asked ? along.data() : nullptr, anew, seen);
        });
}

bool SightZones::gain(const SightRay& ray, std::uint32_t zone, TetId tet, float t_in, float t_out,
                      const double* scattered, double anew, Seen& seen) const {
    const auto& optics = e_.media[e_.medium_of(tet)];
    double most = 0.0;
    radiosity::SegmentWeights w{};
    radiosity::SegmentOfBands segment(ray.ray.origin, ray.ray.direction, t_in, t_out);
    const float* of_band = leaf(zone);
    for (std::size_t b = 0; b < bands_; ++b, of_band += numbers_) {
        if (!optics.varying.empty())
            w = segment.weights(optics.varying[b]);
        else if (b == 0 || optics.extinction[b] != optics.extinction[b - 1])
            w = radiosity::segment_weights(optics.extinction[b] * double(t_out - t_in));
        double& transmittance = seen.transmittance[b];
        const double front = transmittance * w.front, back = transmittance * w.back;
        // A function that fits may dip below zero at an end; what is gained does not.
        const auto gain = [&](Part part, const float* f, const BentAlong& bent,
                              double bend_weight) {
            const float start = dot(f, ray.packed.origin) + f[3];
            const float slope = dot(f, ray.packed.direction);
            const double gained = std::max(0.0, front * (start + t_in * slope + bent.in) +
                                                    back * (start + t_out * slope + bent.out) +
                                                    bend_weight * bent.between);
            seen.radiance[part * bands_ + b] += gained;
            return gained;
        };
        seen.radiance[emission * bands_ + b] += (front + back) * of_band[8];
        const double held =
            bent_ ? gain(single_scattering, of_band,
                         bent_along(of_band + linear_numbers, ray.packed, t_in, t_out),
                         transmittance * radiosity::bend_weight(w))
                  : gain(single_scattering, of_band, {}, 0.0);
        if (scattered)  // (59)
            seen.radiance[single_scattering * bands_ + b] +=
                anew * (transmittance * optics.albedo[b] * scattered[b] - held);
        gain(multiple_scattering, of_band + 4, {}, 0.0);
        transmittance *= w.transmittance;
        most = std::max(most, transmittance);
    }
    return most > 1e-9;
}

}  // namespace tyndall::render
