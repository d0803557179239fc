#include "radiosity/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/mirrored_ray.h"
#include "radiosity/segment.h"
#include "radiosity/uneven_zones.h"

namespace tyndall::radiosity {
namespace {

constexpr float opaque_enough = 1e-7f;  // transmittance below which nothing more is gained

// The direction of one ray of a gather, given its numbers.
Direction gather_direction(const GatherPoint& point,
                           const std::array<double, point_set_dimensions>& u) {
    return point.on_surface() ? cosine_direction(point.normal, u[0], u[1])
                              : uniform_direction(u[0], u[1]);
}

}  // namespace

GatherScene::GatherScene(const Enclosure& enclosure, const Forest& forest, const Fields& sources,
                         double detail)
    : enclosure_(enclosure),
      forest_(forest),
      zones_(packed_zones(forest)),
      stride_(sources.bands < 3 ? sources.bands : (sources.bands + 3) / 4 * 4),
      patches_(sources.patch),
      mirrors_(enclosure.has_mirrors()),
      detail_(static_cast<float>(detail)) {
    sources_.resize(zones_.size() * stride_ / 4 + 1);
    for (std::size_t k = 0; k < sources.zone.size(); ++k)
        set_source(ZoneId(k / sources.bands), k % sources.bands, sources.zone[k]);
    if (detail > 0.0)
        for (const ZoneId zone : uneven_zones(enclosure, forest, sources))
            zones_[zone.value].longest_edge = std::numeric_limits<float>::infinity();
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        for (std::size_t b = 0; b < enclosure.bands; ++b)
            extinction_.push_back(
                float(enclosure.solid(TetId(t)) ? 0.0 : enclosure.extinction(TetId(t), b)));
    if (!enclosure.varies()) return;
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        varying_.push_back(enclosure.solid(TetId(t)) ? nullptr : enclosure.varying(TetId(t), 0));
}

void GatherScene::set_source(ZoneId zone, std::size_t band, const Affine& source) {
    const auto& g = source.gradient;
    Source* const first = sources_[0].of;
    first[zone.value * stride_ + band] = {{float(g.x), float(g.y), float(g.z)},
                                          float(source.constant)};
}

void GatherScene::set_source(PatchId patch, std::size_t band, const Affine& source) {
    patches_[patch.value * enclosure_.bands + band] = source;
}

// One ray's way through the packed trees.
class RadianceWalk {
  public:
    // `travelled`: how far the ray had come when it began [m].
    RadianceWalk(const GatherScene& scene, const mesh::Ray& ray, float travelled,
                 std::span<double> radiance, std::span<float> transmittance)
        : s_(scene),
          travelled_(travelled),
          bands_(radiance.size()),
          ray_(ray),
          packed_(ray),
          radiance_(radiance),
          transmittance_(transmittance) {}

    // Crosses a base tet; false when nothing more can be gained.
    bool cross(TetId tet, float t_in, float t_out) {
        const float* extinction = &s_.extinction_[tet.value * bands_];
        if (!(*std::max_element(extinction, extinction + bands_) > 0.0f)) return true;
        varying_ = s_.varying_.empty() ? nullptr : s_.varying_[tet.value];
        return descend_packed(
            s_.zones_, tet.value, packed_, t_in, t_out,
            [&](std::uint32_t zone, const PackedZone& node, float t) {
                __builtin_prefetch(s_.sources(zone));  // a leaf's are needed with it
                return node.longest_edge < s_.detail_ * (travelled_ + t);
            },
            [&](std::uint32_t zone, const PackedZone&, float in, float out) {
                return !(out > in) || gain(zone, extinction, in, out);
            });
    }

  private:
    // A function that fits may dip below zero at an end, and be right in the mean.
    bool gain(std::uint32_t zone, const float* extinction, float t_in, float t_out) {
        float most = 0.0f;
        const GatherScene::Source* sources = s_.sources(zone);
        SegmentWeights w{};
        SegmentOfBands segment(ray_.origin, ray_.direction, t_in, t_out);
        for (std::size_t b = 0; b < bands_; ++b) {
            const GatherScene::Source& source = sources[b];
            const float start = dot(source.gradient, packed_.origin) + source.constant;
            const float slope = dot(source.gradient, packed_.direction);
            if (varying_)
                w = segment.weights(varying_[b]);
            else if (b == 0 || extinction[b] != extinction[b - 1])
                w = segment_weights(extinction[b] * (t_out - t_in));
            float& transmittance = transmittance_[b];
            radiance_[b] += transmittance *
                            (w.front * (start + t_in * slope) + w.back * (start + t_out * slope));
            transmittance *= static_cast<float>(w.transmittance);
            most = std::max(most, transmittance);
        }
        return most > opaque_enough;
    }

    const GatherScene& s_;
    float travelled_;
    std::size_t bands_;
    const mesh::Ray& ray_;
    const ExtinctionBand* varying_ = nullptr;  // of the first band, in the tet that is crossed
    PackedRay packed_;
    std::span<double> radiance_;
    std::span<float> transmittance_;
};

// What a leaf sends along a ray, and `more` of the leaf or of the one it was cut from.
double GatherScene::sent(PatchId leaf, std::size_t band, Point x,
                         const std::vector<Affine>& more) const {
    const std::size_t bands = enclosure_.bands;
    double sum = patches_[leaf.value * bands + band].at(x);
    if (!more.empty()) {
        PatchId known = leaf;
        while (known.value * bands >= more.size()) known = forest_[known].parent;
        sum += more[known.value * bands + band].at(x);
    }
    return std::max(0.0, sum);
}

void radiance_along(const GatherScene& scene, const mesh::Ray& ray, mesh::WalkStart start,
                    std::span<double> radiance, double lit_beyond) {
    static const std::vector<Affine> nothing;
    const std::size_t bands = radiance.size();
    const Enclosure& enclosure = scene.enclosure_;
    std::fill(radiance.begin(), radiance.end(), 0.0);
    thread_local std::vector<float> transmittance;
    transmittance.assign(bands, 1.0f);
    MirroredRay at{ray, start};
    float travelled = 0.0f;
    for (std::size_t mirrors = 0;; ++mirrors) {
        RadianceWalk walk(scene, at.ray, travelled, radiance, transmittance);
        const auto end =
            mesh::walk(enclosure.mesh, at.ray, at.start, [&](TetId tet, double t_in, double t_out) {
                return walk.cross(tet, float(t_in), float(t_out));
            });
        if (end.arrival == mesh::Arrival::left) {
            for (std::size_t b = 0; b < bands; ++b)
                radiance[b] += transmittance[b] * enclosure.environment[b];
        } else if (end.arrival == mesh::Arrival::struck) {
            const Point x = at.ray.origin + end.distance * at.ray.direction;
            const PatchId leaf = scene.forest_.leaf_at(mesh::root_patch(end.facet, end.side), x);
            const auto& more = mirrors > 0                 ? scene.in_mirrors_
                               : end.distance > lit_beyond ? scene.lit_
                                                           : nothing;
            for (std::size_t b = 0; b < bands; ++b)
                radiance[b] += transmittance[b] * scene.sent(leaf, b, x, more);
        }
        const SurfaceSide* mirror = scene.mirrors_ ? mirror_struck(enclosure, end) : nullptr;
        if (!mirror) return;
        for (std::size_t b = 0; b < bands; ++b)
            transmittance[b] *= static_cast<float>(mirror->mirror[b]);  // (64)
        if (!(*std::ranges::max_element(transmittance) > float(little_mirrored)) ||
            mirrors == most_mirrors) {
            // What is not followed is taken to be like what was found.
            for (std::size_t b = 0; b < bands; ++b) radiance[b] /= 1.0 - transmittance[b];
            return;
        }
        travelled += float(end.distance);
        at = mirrored_ray(enclosure.mesh, at.ray, end);
    }
}

void GatherRays::spread(const GatherPoint& point, const BrightPlaces* bright,
                        const PointSet& points, std::uint64_t seed) {
    cones_.clear();
    if (bright) cones_.look(*bright, point, points.size(), hash_seed(seed, 1));
    for (;;) {
        add_aimed();
        if (add_ordinary(point, points, seed)) return;
        cones_.clear();  // one half has no ordinary ray: none is aimed
    }
}

void GatherRays::add_aimed() {
    rays_.clear();
    first_half_.clear();
    aimed_ = {};
    for (const auto& [direction, weight, first_half, lit_beyond] : cones_.aimed()) {
        rays_.push_back({direction, weight, first_half ? weight : -weight, lit_beyond});
        first_half_.push_back(first_half);
        aimed_[first_half ? 0 : 1] += weight;
    }
}

// False if aimed rays leave one half of the others without any.
bool GatherRays::add_ordinary(const GatherPoint& point, const PointSet& points,
                              std::uint64_t seed) {
    const std::size_t begin = rays_.size();
    std::array<double, 2> count{};
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Direction d = gather_direction(point, points(k, seed));
        if (!cones_.empty() && cones_.cover(d)) continue;
        const bool first_half = 2 * k < points.size();
        rays_.push_back({d, 0.0, 0.0, mesh::infinity});
        first_half_.push_back(first_half);
        count[first_half ? 0 : 1] += 1.0;
    }
    if (!cones_.empty() && !(count[0] * count[1] > 0.0)) return false;
    const double weight = std::max(0.0, 1.0 - aimed_[0] - aimed_[1]) / (count[0] + count[1]);
    for (std::size_t k = begin; k < rays_.size(); ++k) {
        const int half = first_half_[k] ? 0 : 1;
        rays_[k].weight = weight;
        rays_[k].half_weight = (half == 0 ? 0.5 : -0.5) * (1.0 - 2.0 * aimed_[half]) / count[half];
    }
    return true;
}

std::size_t gather(const GatherScene& scene, const OnPurpose& look, const GatherPoint& point,
                   const PointSet& points, std::uint64_t seed, std::span<Gathered> incident) {
    const std::size_t bands = incident.size();
    thread_local std::vector<double> radiance;
    thread_local GatherRays rays;
    radiance.resize(bands);
    std::ranges::fill(incident, Gathered{});
    rays.spread(point, look.bright, points, seed);
    for (const GatherRay& one : rays.all()) {
        radiance_along(scene, {point.x, one.direction}, point.start, radiance, one.lit_beyond);
        for (std::size_t b = 0; b < bands; ++b) {
            incident[b].mean += one.weight * radiance[b];
            incident[b].half_difference += one.half_weight * radiance[b];
        }
    }
    if (look.lit) {
        radiance.assign(bands, 0.0);
        look.lit->gather({point.x, point.start.tet, point.normal, point.on_surface()}, radiance,
                         &rays.cones());
        for (std::size_t b = 0; b < bands; ++b) incident[b].mean += radiance[b];
    }
    return rays.all().size();
}

}  // namespace tyndall::radiosity
