#include "render/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "radiosity/extinction_field.h"
#include "render/options.h"

namespace tyndall::render {

using mesh::PatchId;
using mesh::Point;
using mesh::ZoneId;
using radiosity::none;

namespace {

constexpr std::size_t steps = 32;  // of a chord at most: a power of two
// A piece of a chord may leave this share of what its leaf may.
constexpr double share_of_piece = 0.1;
// Ends of a chord lie on faces, and faces on walls: direct light is asked for this share inside.
constexpr double inside = 1e-3;

// x over all elements, weighed by their capacities, mean over bands: patches and media alike.
double mean_radiance(const radiosity::Solution& s) {
    const radiosity::Enclosure& e = *s.enclosure;
    double sum = 0.0, capacity = 0.0;
    const auto add = [&](auto leaf, double size) {
        const Point x = s.forest.centroid(leaf);
        for (std::size_t b = 0; b < e.bands; ++b)
            sum +=
                size * (radiosity::emission_of(s, leaf, b) +
                        radiosity::scatter_of(s, leaf, b) * (s.direct.at(leaf, b).Affine::at(x) +
                                                             s.indirect.at(leaf, b).Affine::at(x)));
        capacity += size * static_cast<double>(e.bands);
    };
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p)
        if (const PatchId patch(p);
            s.forest.is_leaf(patch) && radiosity::side_of(e, s.forest, patch) != none)
            add(patch, s.forest.area(patch));
    for (std::size_t z = 0; z < s.forest.zone_count(); ++z)
        if (const ZoneId zone(z);
            s.forest.is_leaf(zone) && radiosity::medium_of(e, s.forest, zone) != none)
            add(zone, 4.0 * radiosity::rough_extinction(e, s.forest, zone) * s.forest.volume(zone));
    return capacity > 0.0 ? sum / capacity : 0.0;
}

// One chord, from its beginning to its end.
class Chord {
  public:
    Chord(const radiosity::Solution& s, const radiosity::DirectLight& light, const mesh::Ray& ray,
          ZoneId zone, double t_in, double t_out, std::span<double> gained)
        : light_(light),
          optics_(s.enclosure->media[radiosity::medium_of(*s.enclosure, s.forest, zone)]),
          tet_(s.forest.base_tet(zone)),
          ray_(ray),
          t_in_(t_in),
          length_(t_out - t_in),
          gained_(gained) {
        transmittance_.assign(gained.size(), 1.0);
        incident_.resize((steps + 1) * gained.size());
        std::fill(gained.begin(), gained.end(), 0.0);
    }

    // Mean over bands.
    double opacity(std::size_t from, std::size_t to) const {
        auto segment = between(from, to);
        double sum = 0.0;
        for (std::size_t b = 0; b < gained_.size(); ++b)
            sum += 1.0 - weights(segment, b, from, to).transmittance;
        return sum / static_cast<double>(gained_.size());
    }

    // `tolerance`: for ∫ κ T H^A dt over a piece.
    void integrate(double tolerance) {
        for (const std::size_t k : {std::size_t(0), steps / 2, steps}) evaluate(k);
        halve(0, steps / 2, tolerance);
        halve(steps / 2, steps, tolerance);
    }

  private:
    void evaluate(std::size_t k) {
        const double share = inside + (1.0 - 2.0 * inside) * double(k) / double(steps);
        light_.at_zone(ray_.origin + (t_in_ + share * length_) * ray_.direction, tet_,
                       {at(k), gained_.size()});
    }
    double* at(std::size_t k) const { return incident_.data() + k * gained_.size(); }

    void halve(std::size_t from, std::size_t to, double tolerance) {
        const std::size_t middle = (from + to) / 2;
        evaluate(middle);
        double departure = 0.0, seen = 0.0;
        for (std::size_t b = 0; b < gained_.size(); ++b) {
            departure += std::abs(at(middle)[b] - 0.5 * (at(from)[b] + at(to)[b]));
            seen += transmittance_[b];
        }
        const double bands = static_cast<double>(gained_.size());
        if (to - from > 2 && departure * seen * opacity(from, to) > tolerance * bands * bands) {
            halve(from, middle, tolerance);
            halve(middle, to, tolerance);
        } else {
            add(from, middle);
            add(middle, to);
        }
    }

    void add(std::size_t from, std::size_t to) {
        auto segment = between(from, to);
        for (std::size_t b = 0; b < gained_.size(); ++b) {
            const auto w = weights(segment, b, from, to);
            gained_[b] += transmittance_[b] * (w.front * at(from)[b] + w.back * at(to)[b]);  // (59)
            transmittance_[b] *= w.transmittance;
        }
    }

    radiosity::SegmentOfBands between(std::size_t from, std::size_t to) const {
        const double step = length_ / double(steps);
        return {ray_.origin, ray_.direction, t_in_ + step * double(from),
                t_in_ + step * double(to)};
    }
    radiosity::SegmentWeights weights(radiosity::SegmentOfBands& segment, std::size_t band,
                                      std::size_t from, std::size_t to) const {
        if (!optics_.varying.empty()) return segment.weights(optics_.varying[band]);
        return radiosity::segment_weights(optics_.extinction[band] * length_ * double(to - from) /
                                          double(steps));
    }

    static thread_local std::vector<double> transmittance_, incident_;
    const radiosity::DirectLight& light_;
    const radiosity::MediumOptics& optics_;
    mesh::TetId tet_;
    const mesh::Ray& ray_;
    double t_in_, length_;
    std::span<double> gained_;
};

thread_local std::vector<double> Chord::transmittance_, Chord::incident_;

}  // namespace

SingleScattering::SingleScattering(const radiosity::Solution& solution,
                                   const radiosity::DirectLight& light, double tolerance)
    : s_(solution),
      light_(light),
      threshold_(tolerance < as_elements_hold ? tolerance * mean_radiance(solution)
                                              : std::numeric_limits<double>::infinity()) {}

bool SingleScattering::along(const mesh::Ray& ray, ZoneId zone, double t_in, double t_out,
                             std::span<const double> transmittance,
                             std::span<double> gained) const {
    const double error = s_.zone_error[zone.value];
    if (!(error > threshold_)) return false;
    const double before = std::accumulate(transmittance.begin(), transmittance.end(), 0.0) /
                          static_cast<double>(transmittance.size());
    if (!(before * error > threshold_)) return false;
    Chord chord(s_, light_, ray, zone, t_in, t_out, gained);
    if (!(before * error * chord.opacity(0, steps) > threshold_)) return false;
    chord.integrate(share_of_piece * threshold_ / before);
    return true;
}

}  // namespace tyndall::render
