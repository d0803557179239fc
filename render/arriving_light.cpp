#include "render/arriving_light.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <numbers>

#include "radiosity/cube_faces.h"

namespace tyndall::render {

using mesh::Direction;
using mesh::PatchId;
using mesh::Point;
using mesh::ZoneId;
using radiosity::none;

namespace {

// Zones below this share of their distance stand for their leaves in walks, as in the solve's own
// last gathers.
constexpr double cube_detail = 0.2;
constexpr double most_parts = 6.0;     // of a pixel, along its edge
constexpr std::size_t sub_pixels = 4;  // along a pixel's edge, for its ∫ Y dω

// Such that f_l of all orders above is below `series`.
std::size_t order_of(const radiosity::PhaseFunction& phase, const ArrivingLightOptions& options) {
    if (phase.isotropic()) return 0;
    if (phase.kind == radiosity::PhaseKind::rayleigh) return 2;
    const double orders = std::log(options.series) / std::log(std::abs(phase.asymmetry));
    return std::clamp<std::size_t>(std::size_t(std::ceil(orders)) - 1, 1, options.most_order);
}

std::array<double, 4> barycentric(const mesh::Forest& forest, ZoneId zone, Point x) {
    std::array<Point, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = forest.point(forest[zone].corners[k]) - x;
    const auto volume = [](Point a, Point b, Point c) { return glm::dot(a, glm::cross(b, c)); };
    std::array<double, 4> w{-volume(p[1], p[2], p[3]), volume(p[0], p[2], p[3]),
                            -volume(p[0], p[1], p[3]), volume(p[0], p[1], p[2])};
    const double sum = w[0] + w[1] + w[2] + w[3];
    for (double& v : w) v /= sum;
    return w;
}

}  // namespace

double phase_coefficient(const radiosity::PhaseFunction& phase, std::size_t l) {
    if (phase.kind == radiosity::PhaseKind::rayleigh) return l == 0 ? 1.0 : l == 2 ? 0.1 : 0.0;
    return l == 0 ? 1.0 : std::pow(phase.asymmetry, double(l));  // (57)
}

ArrivingLight::ArrivingLight(const radiosity::Solution& solution,
                             const ArrivingLightOptions& options,
                             const radiosity::ProgressCallback& progress)
    : s_(solution),
      e_(*solution.enclosure),
      whole_(with_whole_extinction(e_)),
      media_(e_),
      bands_(e_.bands),
      places_(arriving_places(solution, options.places)) {
    for (const auto& medium : e_.media) order_ = std::max(order_, order_of(medium.phase, options));
    if (order_ == 0) return;
    sources_ = std::make_unique<TurnedSources>(s_, whole_, media_);
    weigh_pixels(options);
    place_leaves();
    mean_.resize(places_.in_media * bands_);
    moments_.resize(mean_.size() * harmonics_count(order_));
    irradiance_.resize((places_.places.size() - places_.in_media) * bands_);
    beyond_.resize(irradiance_.size());
    const radiosity::Fields reflected = radiosity::reflected_sources(s_);
    std::vector<float> radiance(places_.places.size() * pixels_.size() * bands_);
    for (std::size_t sweep = 0; sweep <= options.sweeps; ++sweep) {
        radiosity::GatherScene scene(sweep == 0 ? e_ : whole_, s_.forest, reflected, cube_detail);
        scene.set_in_mirrors(radiosity::sources_in_mirrors(s_));
        if (sweep > 1) reflect(scene);
        const auto tell = [&](double done) {
            const double sweeps = double(options.sweeps + 1);
            return radiosity::report(progress, {"arriving light", (double(sweep) + done) / sweeps});
        };
        if (!look(sweep, scene, tell, radiance)) return;
        keep(sweep, radiance);
    }
}

void ArrivingLight::place_leaves() {
    const auto& groups = places_.zone_corners;
    std::vector<ZoneId> group_zone(groups.size());
    for (std::size_t z = 0; z < places_.zone_groups.size(); ++z)
        if (places_.zone_groups[z] != none) group_zone[places_.zone_groups[z]] = ZoneId(z);
    for (std::size_t k = 0; k < places_.zones.size(); ++k) {
        const auto w = barycentric(s_.forest, group_zone[places_.group_of_zone[k]],
                                   s_.forest.centroid(places_.zones[k]));
        leaf_weights_.push_back({float(w[0]), float(w[1]), float(w[2]), float(w[3])});
    }
}

void ArrivingLight::weigh_pixels(const ArrivingLightOptions& options) {
    for (const auto& face : radiosity::full_cube_faces(options.resolution))
        for (std::size_t j = 0; j < face.nv; ++j)
            for (std::size_t i = 0; i < face.nu; ++i) {
                double parts = 1.0;
                if (options.brightest > 0.0) {
                    const double bright =
                        sources_->brightness(glm::normalize(face.direction(i, j)));
                    parts = std::ceil(std::sqrt(bright / options.brightest));
                }
                add_pixel(face, i, j, std::size_t(std::clamp(parts, 1.0, most_parts)));
            }
}

// A pixel in parts × parts, their shares of it by 1/r³ in their middles.
void ArrivingLight::add_pixel(const radiosity::CubeFace& face, std::size_t i, std::size_t j,
                              std::size_t parts) {
    const std::size_t count = harmonics_count(order_);
    const std::size_t fine = parts * ((sub_pixels + parts - 1) / parts);  // along the pixel's edge
    const std::size_t first = pixels_.size();
    std::vector<double> values(count);
    const auto towards = [&](double k, double l, std::size_t n) {
        Direction d = face.direction(i, j);
        d[face.along_u] += ((k + 0.5) / double(n) - 0.5) * face.u_step();
        d[face.along_v] += ((l + 0.5) / double(n) - 0.5) * face.v_step();
        return d;
    };
    for (std::size_t k = 0; k < parts * parts; ++k)
        pixels_.push_back(
            {glm::normalize(towards(double(k % parts), double(k / parts), parts)), 0.0});
    harmonics_.resize(pixels_.size() * count, 0.0);
    double sum = 0.0;
    for (std::size_t k = 0; k < fine * fine; ++k) {
        const Direction d = towards(double(k % fine), double(k / fine), fine);
        const double length = glm::length(d), weight = 1.0 / std::pow(length, 3);
        const std::size_t u = k % fine * parts / fine, v = k / fine * parts / fine;
        const std::size_t pixel = first + v * parts + u;
        sum += weight;
        pixels_[pixel].share += weight;
        spherical_harmonics(d / length, order_, values);
        for (std::size_t n = 0; n < count; ++n) harmonics_[pixel * count + n] += weight * values[n];
    }
    const double share = face.weights[j * face.nu + i] / sum;
    for (std::size_t p = first; p < pixels_.size(); ++p) {
        pixels_[p].share *= share;
        for (std::size_t n = 0; n < count; ++n)
            harmonics_[p * count + n] *= 4.0 * std::numbers::pi * share;
    }
}

// L of every place and pixel, [(place * pixels + pixel) * bands + band]. A direction at a time.
// False: stopped.
bool ArrivingLight::look(std::size_t sweep, const radiosity::GatherScene& scene,
                         const std::function<bool(double)>& tell,
                         std::vector<float>& radiance) const {
    struct Own {
        radiosity::GatherScene scene;
        std::vector<float> indirect;
        std::vector<double> radiance;
    };
    tbb::enumerable_thread_specific<Own> threads([&] {
        return Own{scene, std::vector<float>(s_.forest.zone_count() * bands_),
                   std::vector<double>(bands_)};
    });
    const auto on_way = sweep > 1 ? Coefficients::whole : Coefficients::reduced;
    std::atomic<bool> stop = false;
    std::size_t done = 0;
    std::mutex mutex;
    tbb::parallel_for(std::size_t(0), pixels_.size(), [&](std::size_t p) {
        if (stop) return;
        Own& own = threads.local();
        const Direction direction = pixels_[p].direction;
        if (sweep > 0) {
            turn_sources(direction, own.indirect);
            sources_->fill(direction, on_way, own.indirect, own.scene);
        }
        for (std::size_t k = 0; k < places_.places.size(); ++k) {
            const auto& place = places_.places[k];
            float* to = &radiance[(k * pixels_.size() + p) * bands_];
            std::fill_n(to, bands_, 0.0f);
            if (place.on_surface() && !(glm::dot(place.normal, direction) > 0.0)) continue;
            radiosity::radiance_along(own.scene, {place.x, direction}, place.start, own.radiance);
            // An ancestor's linear function may dip below zero.
            for (std::size_t b = 0; b < bands_; ++b) to[b] = float(std::max(0.0, own.radiance[b]));
        }
        const std::lock_guard lock(mutex);
        if (!tell(double(++done) / double(pixels_.size()))) stop = true;
    });
    return !stop;
}

// Moments of what was looked at in media, and cosine-weighted means on surfaces.
void ArrivingLight::keep(std::size_t sweep, const std::vector<float>& radiance) {
    const std::size_t count = harmonics_count(order_), cubes = places_.in_media;
    const auto at = [&](std::size_t place, std::size_t p, std::size_t b) {
        return double(radiance[(place * pixels_.size() + p) * bands_ + b]);
    };
    tbb::parallel_for(std::size_t(0), cubes * bands_, [&](std::size_t i) {
        const std::size_t place = i / bands_, b = i % bands_;
        double* moments = &moments_[i * count];
        std::fill_n(moments, count, 0.0);
        double mean = 0.0;
        for (std::size_t p = 0; p < pixels_.size(); ++p) {
            const double value = at(place, p, b), *harmonics = &harmonics_[p * count];
            mean += pixels_[p].share * value;
            for (std::size_t n = 0; n < count; ++n) moments[n] += value * harmonics[n];
        }
        if (sweep == 0) mean_[i] = mean;
        if (mean_[i] > 0.0)
            for (std::size_t n = 0; n < count; ++n) moments[n] /= mean_[i];
    });
    tbb::parallel_for(std::size_t(0), irradiance_.size(), [&](std::size_t i) {
        const std::size_t place = cubes + i / bands_, b = i % bands_;
        const Direction n = places_.places[place].normal;
        double sum = 0.0, all = 0.0;
        for (std::size_t p = 0; p < pixels_.size(); ++p) {
            const double weight =
                pixels_[p].share * std::max(0.0, glm::dot(n, pixels_[p].direction));
            all += weight;
            sum += weight * at(place, p, b);
        }
        const double mean = all > 0.0 ? sum / all : 0.0;
        if (sweep == 0) irradiance_[i] = mean;
        beyond_[i] = mean - irradiance_[i];  // (62)
    });
}

// What zones scatter of the light of the sweep before, over what even scattering makes of the
// solution's.
void ArrivingLight::turn_sources(Direction direction, std::vector<float>& indirect) const {
    const std::size_t count = harmonics_count(order_), cubes = places_.in_media;
    thread_local std::vector<double> weights, turned;
    turned.resize(e_.media.size() * cubes * bands_);
    for (std::uint32_t m = 0; m < e_.media.size(); ++m) {
        if (e_.media[m].phase.isotropic()) continue;
        weigh(m, direction, weights);
        for (std::size_t i = 0; i < cubes * bands_; ++i) {
            const double* moments = &moments_[i * count];
            double q = 0.0;
            for (std::size_t n = 0; n < count; ++n) q += weights[n] * moments[n];  // (57)
            turned[m * cubes * bands_ + i] = std::max(0.0, q);
        }
    }
    for (std::size_t z = 0; z < s_.forest.zone_count(); ++z) {
        const std::uint32_t m = e_.medium_of(s_.forest.base_tet(ZoneId(z)));
        for (std::size_t b = 0; b < bands_; ++b)
            indirect[z * bands_ + b] = m == none ? 0.0f : float(media_.albedo(m, b));
    }
    for (std::size_t k = 0; k < places_.zones.size(); ++k) {
        const ZoneId zone = places_.zones[k];
        const std::uint32_t m = e_.medium_of(s_.forest.base_tet(zone));
        const auto& corners = places_.zone_corners[places_.group_of_zone[k]];
        for (std::size_t b = 0; b < bands_; ++b) {
            double scattered = 0.0, mean = 0.0;
            for (int c = 0; c < 4; ++c) {
                const std::size_t i = corners[c] * bands_ + b;
                const double w = double(leaf_weights_[k][c]) * mean_[i];
                scattered += w * turned[m * cubes * bands_ + i];
                mean += w;
            }
            const double q = mean > 0.0 ? scattered / mean : 1.0;
            const double back = media_.given_back(m, b);
            indirect[zone.value * bands_ + b] = float((media_.albedo(m, b) - back) * q + back);
        }
    }
}

// What patches reflect of the light of the sweep before.
void ArrivingLight::reflect(radiosity::GatherScene& scene) const {
    std::vector<double> more(bands_);
    for (std::size_t p = 0; p < s_.forest.patch_count(); ++p) {
        const PatchId patch(p);
        const auto side = radiosity::side_of(e_, s_.forest, patch);
        if (!s_.forest.is_leaf(patch) || side == none) continue;
        const std::uint32_t root = s_.forest.base_facet_side(patch);
        const Point x = s_.forest.centroid(patch);
        beyond(mesh::FacetId(root / 2), root % 2 ? mesh::Side::back : mesh::Side::front, x, more);
        for (std::size_t b = 0; b < bands_; ++b) {
            const double a = radiosity::scattered_of(s_, patch, b), kept = sources_->kept(patch, b);
            const auto &direct = s_.direct.at(patch, b), &indirect = s_.indirect.at(patch, b);
            scene.set_source(
                patch, b,
                {a * (kept * direct.gradient + indirect.gradient),
                 radiosity::emission_of(s_, patch, b) - radiosity::split_emission_of(s_, patch, b) +
                     a * (kept * direct.constant + indirect.constant + more[b])});
        }
    }
}

void ArrivingLight::weigh(std::uint32_t medium, Direction direction,
                          std::vector<double>& weights) const {
    weights.resize(harmonics_count(order_));
    spherical_harmonics(direction, order_, weights);
    for (std::size_t l = 0; l <= order_; ++l) {
        const double f = phase_coefficient(e_.media[medium].phase, l);
        for (std::size_t n = l * l; n < (l + 1) * (l + 1); ++n) weights[n] *= f;
    }
}

void ArrivingLight::shares(ZoneId group, std::span<const double> weights, Point a, Point b,
                           std::span<double> at_a, std::span<double> at_b) const {
    const auto at = std::array{barycentric(s_.forest, group, a), barycentric(s_.forest, group, b)};
    thread_local std::vector<double> mean;
    mean.assign(2 * bands_, 0.0);
    std::ranges::fill(at_a, 0.0);
    std::ranges::fill(at_b, 0.0);
    const auto& corners = places_.zone_corners[places_.zone_groups[group.value]];
    for (int k = 0; k < 4; ++k) {
        const double w_a = std::max(0.0, at[0][k]), w_b = std::max(0.0, at[1][k]);
        for (std::size_t band = 0; band < bands_; ++band) {
            const std::size_t i = corners[k] * bands_ + band;
            const double* moments = &moments_[i * weights.size()];
            double q = 0.0;
            for (std::size_t n = 0; n < weights.size(); ++n) q += weights[n] * moments[n];  // (57)
            const double m = mean_[i], scattered = m * std::max(0.0, q);
            at_a[band] += w_a * scattered;
            at_b[band] += w_b * scattered;
            mean[2 * band] += w_a * m;
            mean[2 * band + 1] += w_b * m;
        }
    }
    for (std::size_t band = 0; band < bands_; ++band) {
        const double m_a = mean[2 * band], m_b = mean[2 * band + 1];
        at_a[band] = m_a > 0.0 ? at_a[band] / m_a : 1.0;
        at_b[band] = m_b > 0.0 ? at_b[band] / m_b : 1.0;
    }
}

void ArrivingLight::beyond(mesh::FacetId facet, mesh::Side side, Point x,
                           std::span<double> more) const {
    std::ranges::fill(more, 0.0);
    if (order_ == 0) return;
    const auto& forest = s_.forest;
    PatchId patch = mesh::root_patch(facet, side);
    while (places_.patch_groups[patch.value] == none) {
        const auto& node = forest[patch];
        if (forest.is_leaf(patch)) return;
        const bool second = glm::dot(node.plane_normal, x) + node.plane_offset > 0.0;
        patch = PatchId(node.first_child.value + (second ? 1ull : 0ull));
    }
    std::array<Point, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = forest.point(forest[patch].corners[k]);
    const Direction across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double square = glm::dot(across, across);
    const auto& corners = places_.patch_corners[places_.patch_groups[patch.value]];
    for (int k = 0; k < 3; ++k) {
        const Point &q = p[(k + 1) % 3], &r = p[(k + 2) % 3];
        const double w = std::clamp(glm::dot(glm::cross(q - x, r - x), across) / square, 0.0, 1.0);
        for (std::size_t b = 0; b < bands_; ++b)
            more[b] += w * beyond_[(corners[k] - places_.in_media) * bands_ + b];
    }
}

}  // namespace tyndall::render
