#include "radiosity/balance.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/body.h"
#include "radiosity/light_sources.h"
#include "radiosity/mirrored_ray.h"
#include "radiosity/optical_depth.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// Of what is emitted: where mirrors take more, what they leave is not known well enough.
constexpr double least_taken_up = 0.5;

// Follows direct light from its sources to what leaves the hull.
class Escape {
  public:
    Escape(const Enclosure& enclosure, const CoarseSolution& coarse, std::size_t rays,
           std::uint64_t seed)
        : enclosure_(enclosure),
          coarse_(coarse),
          points_(rays),
          seed_(seed),
          power_{Spectrum(enclosure.bands, 0.0), Spectrum(enclosure.bands, 0.0),
                 Spectrum(enclosure.bands, 0.0)} {}

    // Power that leaves, of emitting surfaces and of lights [W].
    Escaped follow() {
        const Elements& e = coarse_.elements();
        if (!enclosure_.open && !enclosure_.has_mirrors()) return power_;
        double emitting = 0.0;
        for (std::size_t i = 0; i < e.patches.size(); ++i)
            emitting += emits(i) ? e.capacity[i * e.bands] : 0.0;
        of_emitter_ = true;
        for (std::size_t i = 0; i < e.patches.size(); ++i)
            if (emits(i)) from_patch(i, emitting);
        of_emitter_ = false;
        for (const Light& light : enclosure_.lights)
            std::visit([this](const auto& source) { from(source); }, light.source);
        return power_;
    }

  private:
    using Numbers = std::array<double, point_set_dimensions>;

    bool emits(std::size_t i) const {
        for (std::size_t b = 0; b < enclosure_.bands; ++b)
            if (coarse_.split_emission(i, b) > 0.0) return true;
        return false;
    }

    // Adds `power` × transmittance if the ray leaves; one value a band.
    template <class Power>
    void add(const mesh::Ray& ray, mesh::WalkStart start, const Power& power) {
        std::vector<double> depth(enclosure_.bands, 0.0);
        MirroredRay at{ray, start};
        for (std::size_t mirrors = 0;; ++mirrors) {
            const auto end = mesh::walk(enclosure_.mesh, at.ray, at.start,
                                        [&](TetId tet, double t_in, double t_out) {
                                            add_depth(enclosure_, tet, at.ray, t_in, t_out, depth);
                                            return true;
                                        });
            if (end.arrival == mesh::Arrival::left) {
                Spectrum& to = mirrors > 0 && of_emitter_ ? power_.in_mirrors : power_.direct;
                for (std::size_t b = 0; b < depth.size(); ++b)
                    to[b] += power(b) * std::exp(-depth[b]);
            }
            const SurfaceSide* mirror = mirror_struck(enclosure_, end);
            if (!mirror || mirrors == most_mirrors) return;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t b = 0; b < depth.size(); ++b) {
                depth[b] -= std::log(mirror->mirror[b]);  // as if it were a medium
                least = std::min(least, depth[b]);
                if (mirrors == 0 && of_emitter_)
                    power_.onto_mirrors[b] += power(b) * std::exp(-depth[b]);
            }
            if (!(std::exp(-least) > little_mirrored)) return;
            at = mirrored_ray(enclosure_.mesh, at.ray, end);
        }
    }

    void from_patch(std::size_t i, double emitting) {
        const Elements& e = coarse_.elements();
        const auto& forest = coarse_.forest();
        const double area = e.capacity[i * e.bands] / e.seen(i, 0);
        const auto count = std::max<std::size_t>(
            16, static_cast<std::size_t>(
                    std::ceil(static_cast<double>(points_.size()) * area / emitting)));
        for (std::size_t k = 0; k < std::min(count, points_.size()); ++k) {
            auto u = points_(k, hash_seed(seed_, i));
            const PatchId patch(e.pick_member(i, u[0]));
            const auto& c = forest[patch].corners;
            const auto n = normal_of(forest, patch);
            const auto side = forest.base_facet_side(patch);
            const auto w = uniform_in_triangle(u[0], u[1]);
            const Point x =
                w[0] * forest.point(c[0]) + w[1] * forest.point(c[1]) + w[2] * forest.point(c[2]);
            add({x, cosine_direction(n, u[3], u[4])}, mesh::start_before(enclosure_.mesh, side, x),
                [&](std::size_t b) {
                    return pi * e.capacity[i * e.bands + b] * coarse_.split_emission(i, b) /
                           static_cast<double>(std::min(count, points_.size()));
                });
        }
    }

    // From a point inside the mesh, if light can be there.
    template <class Power>
    void from_point(Point x, Direction direction, const Power& power) {
        const TetId tet = mesh::locate(enclosure_.mesh, x);
        if (tet.valid() && !enclosure_.solid(tet)) add({x, direction}, {tet}, power);
    }

    double share() const { return 1.0 / static_cast<double>(points_.size()); }

    void from(const PointLight& light) {
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const auto u = points_(k, seed_);
            from_point(light.position, uniform_direction(u[0], u[1]),
                       [&](std::size_t b) { return 4.0 * pi * share() * light.intensity[b]; });
        }
    }

    void from(const SpotLight& light) {
        const double half = std::min(pi, 0.5 * light.angle + light.soft_edge);
        const double cap = 1.0 - std::cos(half);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const auto u = points_(k, seed_);
            const Direction omega =
                direction_about(glm::normalize(light.direction), 1.0 - cap * u[0], u[1]);
            const double weight = 2.0 * pi * cap * share() * spot_share(light, omega);
            from_point(light.position, omega,
                       [&](std::size_t b) { return weight * light.intensity[b]; });
        }
    }

    // What enters through the faces of the hull that look towards the sun.
    void from(const Sun& sun) {
        const auto& mesh = enclosure_.mesh;
        const Direction d = glm::normalize(sun.direction);
        const auto size = mesh.hull_max - mesh.hull_min;
        for (int axis = 0; axis < 3; ++axis) {
            if (d[axis] == 0.0) continue;
            const int s = (axis + 1) % 3, t = (axis + 2) % 3;
            for (std::size_t k = 0; k < points_.size(); ++k) {
                const auto u = points_(k, hash_seed(seed_, std::size_t(axis)));
                Point x;
                x[axis] = d[axis] > 0.0 ? mesh.hull_min[axis] + 1e-9 * size[axis]
                                        : mesh.hull_max[axis] - 1e-9 * size[axis];
                x[s] = mesh.hull_min[s] + u[0] * size[s];
                x[t] = mesh.hull_min[t] + u[1] * size[t];
                const Direction ray = direction_about(
                    glm::normalize(d), std::cos(0.5 * sun.angle * std::sqrt(u[3])), u[4]);
                const double weight = size[s] * size[t] * std::abs(d[axis]) * share();
                from_point(x, ray, [&](std::size_t b) { return weight * sun.irradiance[b]; });
            }
        }
    }

    const Enclosure& enclosure_;
    const CoarseSolution& coarse_;
    PointSet points_;
    std::uint64_t seed_;
    bool of_emitter_ = false;
    Escaped power_;
};

}  // namespace

Escaped escaped_direct(const Enclosure& enclosure, const CoarseSolution& coarse, std::size_t rays,
                       std::uint64_t seed) {
    return Escape(enclosure, coarse, rays, seed).follow();
}

double conserve_direct_power(const Enclosure& enclosure, const Elements& e,
                             const DirectLight& light, const Escaped& escaped,
                             std::vector<double>& incident_direct) {
    double missing = 0.0, all = 0.0;
    // A sun's power is what falls on the hull, whatever gets in.
    const bool known =
        !enclosure.open && !light.cut_images() &&
        std::none_of(enclosure.lights.begin(), enclosure.lights.end(),
                     [](const Light& l) { return std::holds_alternative<Sun>(l.source); });
    for (std::size_t b = 0; b < e.bands; ++b) {
        double emitted = 0.0, received = 0.0;
        for (const LightPower& p : light.powers()) emitted += p.power[b];
        for (std::size_t k = b; k < e.capacity.size(); k += e.bands)
            received += pi * e.capacity[k] * incident_direct[k];
        missing += received + escaped.direct[b] + escaped.onto_mirrors[b] - emitted;
        all += emitted;
        const double taken_up = emitted - escaped.onto_mirrors[b];
        if (!known || !(received > 0.0) || !(taken_up > least_taken_up * emitted)) continue;
        for (std::size_t k = b; k < e.capacity.size(); k += e.bands)
            incident_direct[k] *= taken_up / received;
    }
    return all > 0.0 ? missing / all : 0.0;
}

namespace {

double volume_of(const Elements& e, const Forest& forest, std::size_t element) {
    double volume = 0.0;
    for (const auto member : e.members_of(element)) volume += forest.volume(ZoneId(member));
    return volume;
}

// Net power over the area of a side, the volume of a medium.
void add_densities(const Enclosure& enclosure, const std::map<std::string, double>& measure,
                   Balance& result) {
    const auto over = [&](const std::string& name) {
        Spectrum density = result.net_power.at(name);
        for (double& value : density) value /= measure.at(name);
        return density;
    };
    for (const SurfaceSide& side : enclosure.sides)
        if (measure.contains(side.name)) result.net_flux[side.name] = over(side.name);
    for (const MediumOptics& medium : enclosure.media)
        if (measure.contains(medium.name)) result.flux_divergence[medium.name] = over(medium.name);
}

}  // namespace

Balance balance(const Enclosure& enclosure, const CoarseSolution& coarse,
                const std::vector<double>& incident_direct, const DirectLight& light,
                const Escaped& escaped) {
    const Elements& e = coarse.elements();
    const std::size_t bands = e.bands;
    Balance result;
    Spectrum lights(bands, 0.0), brought(bands, 0.0), net(bands, 0.0), outside = escaped.direct;
    for (std::size_t b = 0; b < bands; ++b) outside[b] += escaped.in_mirrors[b];
    for (std::size_t k = light.powers().size() - enclosure.lights.size(); k < light.powers().size();
         ++k)
        for (std::size_t b = 0; b < bands; ++b) lights[b] += light.powers()[k].power[b];

    const auto named = [&](const std::string& name) -> Spectrum& {
        return result.net_power.try_emplace(name, Spectrum(bands, 0.0)).first->second;
    };
    std::map<std::string, double> measure;  // area of a side, volume of a medium
    for (std::size_t i = 0; i < e.size(); ++i) {
        const std::string& name =
            e.is_patch(i) ? enclosure.sides[side_of(enclosure, coarse.forest(), e.patches[i])].name
                          : enclosure.media[medium_of(enclosure, coarse.forest(), e.zone(i))].name;
        measure[name] +=
            e.is_patch(i) ? e.capacity[i * bands] / e.seen(i, 0) : volume_of(e, coarse.forest(), i);
        brought[0] += std::max(0.0, coarse.settled().heat(i));
        for (std::size_t b = 0; b < bands; ++b) {
            const std::size_t k = i * bands + b;
            const double c = e.capacity[k], r = coarse.reflected(i, b);
            const double incident = incident_direct[k] + coarse.indirect(i, b);
            const double power = pi * c * (r + coarse.split_emission(i, b) - incident);
            named(name)[b] += power;
            net[b] += power;
            brought[b] += pi * c * std::max(0.0, e.emission[k]);
            const double escaping = pi * coarse.to_outside(i, b);
            outside[b] += escaping * (r - enclosure.environment[b]);
            brought[b] += escaping * enclosure.environment[b];
        }
    }
    double imbalance = 0.0, total = 0.0;
    for (std::size_t b = 0; b < bands; ++b) {
        imbalance += net[b] + lights[b] - outside[b];
        total += brought[b] + lights[b];
    }
    add_densities(enclosure, measure, result);
    named("outside") = outside;
    result.energy_balance = total > 0.0 ? imbalance / total : 0.0;
    return result;
}

}  // namespace tyndall::radiosity
