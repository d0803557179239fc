#include "render/seen_solution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/segment.h"

namespace tyndall::render {

using mesh::PatchId;
using mesh::Point;
using mesh::ZoneId;
using radiosity::LeafFunction;
using radiosity::none;

namespace {

double mean_of_surfaces(const radiosity::Solution& s) {
    double sum = 0.0, area = 0.0;
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!s.forest.is_leaf(patch) || radiosity::side_of(*s.enclosure, s.forest, patch) == none)
            continue;
        const double a = s.forest.area(patch);
        const Point centroid = s.forest.centroid(patch);
        for (std::size_t b = 0; b < s.enclosure->bands; ++b)
            sum += a * radiosity::scatter_of(s, patch, b) *
                   (s.direct.at(patch, b).Affine::at(centroid) +
                    s.indirect.at(patch, b).Affine::at(centroid));
        area += a * static_cast<double>(s.enclosure->bands);
    }
    return area > 0.0 ? sum / area : 0.0;
}

}  // namespace

SeenSolution::SeenSolution(const radiosity::Solution& solution, double direct_tolerance,
                           AtMirrors at_mirrors)
    : s_(solution),
      e_(*solution.enclosure),
      bands_(e_.bands),
      light_(e_, {.emitters = s_.direct_light == radiosity::DirectLightMode::closed_form}),
      typical_(mean_of_surfaces(solution)),
      threshold_(direct_tolerance * typical_),
      at_mirrors_(at_mirrors) {}

bool SeenSolution::cross(const mesh::Ray& ray, ZoneId zone, double t_in, double t_out,
                         Seen& seen) const {
    const auto& optics = e_.media[medium_of(e_, s_.forest, zone)];
    const Point in = ray.origin + t_in * ray.direction, out = ray.origin + t_out * ray.direction;
    double most = 0.0;
    radiosity::SegmentWeights w{};
    radiosity::SegmentOfBands segment(ray.origin, ray.direction, t_in, t_out);
    for (std::size_t b = 0; b < bands_; ++b) {
        if (!optics.varying.empty())
            w = segment.weights(optics.varying[b]);
        else if (b == 0 || optics.extinction[b] != optics.extinction[b - 1])
            w = radiosity::segment_weights(optics.extinction[b] * (t_out - t_in));
        double& transmittance = seen.transmittance[b];
        const double bent = s_.direct.zone_bend.empty() ? 0.0 : radiosity::bend_weight(w);
        const auto gain = [&](Part part, const LeafFunction& f) {
            seen.radiance[part * bands_ + b] +=
                transmittance * optics.albedo[b] *
                std::max(0.0, w.front * f.at(in) + w.back * f.at(out) + bent * f.between(in, out));
        };
        seen.radiance[emission * bands_ + b] +=
            transmittance * (w.front + w.back) * radiosity::emission_of(s_, zone, b);
        gain(single_scattering, s_.direct.at(zone, b));
        gain(multiple_scattering, s_.indirect.at(zone, b));
        transmittance *= w.transmittance;
        most = std::max(most, transmittance);
    }
    return most > 1e-9;
}

void SeenSolution::strike(PatchId leaf, Point x, mesh::TetId before, Seen& seen,
                          const Indirect& indirect) const {
    const auto side = radiosity::side_of(e_, s_.forest, leaf);
    if (side == none) return;
    const auto& optics = e_.sides[side];
    thread_local std::vector<double> direct;
    direct.resize(bands_);
    if (s_.patch_direct_error[leaf.value] > threshold_) {
        const mesh::Direction n = radiosity::normal_of(s_.forest, leaf);
        light_.at_patch(x, n, before, direct);
    } else {
        for (std::size_t b = 0; b < bands_; ++b)
            direct[b] = std::max(0.0, s_.direct.at(leaf, b).at(x));
    }
    thread_local std::vector<double> other;
    other.resize(bands_);
    if (indirect && std::ranges::any_of(optics.reflectance, [](double r) { return r > 0.0; })) {
        indirect(leaf, x, other);
    } else {
        for (std::size_t b = 0; b < bands_; ++b)
            other[b] = std::max(0.0, s_.indirect.at(leaf, b).at(x));
    }
    for (std::size_t b = 0; b < bands_; ++b) {
        const double t = seen.transmittance[b];
        const double rho =
            at_mirrors_ == AtMirrors::go_on ? optics.scattered(b) : optics.reflectance[b];
        seen.radiance[emission * bands_ + b] += t * radiosity::emission_of(s_, leaf, b);
        seen.radiance[surfaces_direct * bands_ + b] += t * rho * direct[b];
        seen.radiance[surfaces_indirect * bands_ + b] += t * rho * other[b];
    }
}

void SeenSolution::arrive(const mesh::Ray& ray, const mesh::WalkEnd& end, double before, Seen& seen,
                          const Indirect& indirect) const {
    if (end.arrival == mesh::Arrival::left) leave(seen);
    if (end.arrival != mesh::Arrival::struck) return;
    seen.depth = before + end.distance;
    const Point x = ray.origin + end.distance * ray.direction;
    strike(s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), x), x, end.tet, seen, indirect);
}

void SeenSolution::leave(Seen& seen) const {
    for (std::size_t b = 0; b < bands_; ++b)
        seen.radiance[emission * bands_ + b] += seen.transmittance[b] * e_.environment[b];
}

PictureSums::PictureSums(const Camera& camera, std::size_t bands, std::size_t parts)
    : bands_(bands), parts_(parts) {
    image_.width = camera.width;
    image_.height = camera.height;
    const auto add = [&](const char* name, std::size_t channels) {
        image_.layers.push_back(
            {name, channels, std::vector<float>(image_.width * image_.height * channels)});
    };
    add("beauty", bands);
    for (std::size_t p = 0; p < parts_; ++p) add(part_names[p], bands);
    add("transmittance", bands);
    add("depth", 1);
}

void PictureSums::begin(Sums& sums) const {
    sums.values.assign((parts_ + 1) * bands_, 0.0);
    sums.depth = std::numeric_limits<double>::infinity();
}

void PictureSums::add(const Seen& seen, Sums& sums) const {
    for (std::size_t n = 0; n < parts_ * bands_; ++n) sums.values[n] += seen.radiance[n];
    for (std::size_t b = 0; b < bands_; ++b)
        sums.values[parts_ * bands_ + b] += seen.transmittance[b];
    sums.depth = std::min(sums.depth, seen.depth);
}

void PictureSums::end(const Sums& sums, std::size_t pixel, std::size_t rays) {
    const double share = 1.0 / static_cast<double>(rays);
    for (std::size_t b = 0; b < bands_; ++b) {
        double beauty = 0.0;
        for (std::size_t part = 0; part <= parts_; ++part) {
            // What some rays put right for all may be a little more than they have.
            const double value = std::max(0.0, share * sums.values[part * bands_ + b]);
            image_.layers[1 + part].values[pixel * bands_ + b] = static_cast<float>(value);
            if (part < parts_) beauty += value;
        }
        image_.layers[0].values[pixel * bands_ + b] = static_cast<float>(beauty);
    }
    image_.layers[2 + parts_].values[pixel] = static_cast<float>(sums.depth);
}

}  // namespace tyndall::render
