#include "render/last_scatter.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <optional>

#include "mesh/entry.h"
#include "radiosity/direct_light.h"
#include "radiosity/segment.h"
#include "render/arriving_light.h"
#include "render/equiangular.h"
#include "render/eye.h"
#include "render/path_lights.h"
#include "render/sampled_picture.h"
#include "render/seen_solution.h"

namespace tyndall::render {
namespace {

using mesh::TetId;
using mesh::ZoneId;
using radiosity::none;

constexpr std::size_t stratified = 8;  // samples that share a net
// Parts of lights within which Φ is taken at the middle: at g = 0.8 off by 1 % at most [rad].
constexpr double widest_seen_part = 0.15;
constexpr double hidden = 1e-9;  // transmittance behind which nothing shows

class LastScatter {
  public:
    LastScatter(const radiosity::Solution& solution, const Camera& camera, double direct_tolerance,
                const radiosity::ProgressCallback& progress)
        : s_(solution),
          e_(*solution.enclosure),
          bands_(e_.bands),
          eye_(camera.eye),
          eye_tet_(tet_of_eye(e_, camera)),
          seen_(solution, direct_tolerance),
          lights_(e_),
          arriving_(solution, {}, progress),
          media_(arriving_.media()),
          light_(arriving_.whole(), {.emitters = closed_form()}),
          points_(stratified) {}

    void sample(mesh::Ray ray, const SampleAt& at, RandomNumbers& random, Seen& seen) const {
        const mesh::Entry entry = mesh::entry_near(e_.mesh, ray, eye_, eye_tet_);
        if (!entry.tet.valid()) return seen_.leave(seen);
        if (e_.solid(entry.tet)) return;
        ray.origin += entry.distance * ray.direction;
        Way& way = this->way();
        way.passed.clear();
        way.held.clear();
        way.weights.resize(e_.media.size());
        for (std::uint32_t m = 0; m < e_.media.size(); ++m)
            if (!e_.media[m].phase.isotropic()) arriving_.weigh(m, ray.direction, way.weights[m]);
        const auto end =
            mesh::walk(e_.mesh, ray, {entry.tet}, [&](TetId tet, double in, double out) {
                if (e_.solid(tet) || e_.medium_of(tet) == none) return true;
                return cross(ray, tet, in, out, seen);
            });
        single(ray, points_(at.within, radiosity::hash_seed(at.seed, 1)), random, seen);
        if (arriving_.order() == 0 || end.arrival != mesh::Arrival::struck)
            seen_.arrive(ray, end, entry.distance, seen);
        else
            strike(ray, end, entry.distance, seen);
    }

  private:
    struct Passed {
        TetId tet;
        Stretch stretch;
    };
    // What a ray passes; memory of a thread.
    struct Way {
        std::vector<Passed> passed;
        std::vector<Stretch> stretches;
        std::vector<std::vector<double>> weights;  // of phase functions, by medium
        std::vector<double> held;  // Ω ∫ Φ L^A dω of the leaves at both ends, [2 * band + end]
        std::vector<double> at_in, at_out, scattered, transmittance, shares;
    };
    using Numbers = std::array<double, radiosity::point_set_dimensions>;

    static Way& way() {
        thread_local Way own;
        return own;
    }
    bool closed_form() const { return s_.direct_light == radiosity::DirectLightMode::closed_form; }
    void add(Seen& seen, Part part, std::size_t band, double value) const {
        seen.radiance[part * bands_ + band] += value;
    }

    // What the zones of a tet emit and scatter, direct light as its leaves hold it.
    bool cross(const mesh::Ray& ray, TetId tet, double t_in, double t_out, Seen& seen) const {
        if (e_.media[e_.medium_of(tet)].phase.isotropic())
            return leaves(ray, mesh::root_zone(tet), t_in, t_out, {}, seen);
        const auto is_group = [&](ZoneId zone, double) { return arriving_.group(zone); };
        Way& way = this->way();
        way.at_in.resize(bands_);
        way.at_out.resize(bands_);
        return mesh::descend(s_.forest, mesh::root_zone(tet), ray, t_in, t_out, is_group,
                             [&](ZoneId group, double in, double out) {
                                 arriving_.shares(group, way.weights[e_.medium_of(tet)],
                                                  ray.origin + in * ray.direction,
                                                  ray.origin + out * ray.direction, way.at_in,
                                                  way.at_out);
                                 return leaves(ray, group, in, out, {&way, in, out}, seen);
                             });
    }

    // q along a part of a ray.
    struct Turned {
        const Way* way = nullptr;  // null: 1
        double in = 0.0, out = 0.0;

        double at(double t, std::size_t band) const {
            if (!way) return 1.0;
            const double share = (t - in) / (out - in);
            return (1.0 - share) * way->at_in[band] + share * way->at_out[band];
        }
    };

    bool leaves(const mesh::Ray& ray, ZoneId below, double t_in, double t_out, const Turned& turned,
                Seen& seen) const {
        const std::uint32_t medium = radiosity::medium_of(e_, s_.forest, below);
        const auto& optics = arriving_.whole().media[medium];
        const auto leaf = [&](ZoneId zone, double in, double out) {
            const Point a = ray.origin + in * ray.direction, b = ray.origin + out * ray.direction;
            double most = 0.0;
            Way& own = this->way();
            own.passed.push_back({s_.forest.base_tet(zone), {medium, in, out}});
            radiosity::SegmentWeights w{};
            radiosity::SegmentOfBands segment(ray.origin, ray.direction, in, out);
            for (std::size_t k = 0; k < bands_; ++k) {
                if (!optics.varying.empty())
                    w = segment.weights(optics.varying[k]);
                else if (k == 0 || optics.extinction[k] != optics.extinction[k - 1])
                    w = radiosity::segment_weights(optics.extinction[k] * (out - in));
                double& transmittance = seen.transmittance[k];
                const double emitted = emission_of_whole(s_, arriving_.whole(), zone, medium, k);
                const double back = media_.given_back(medium, k);
                const double turning = media_.albedo(medium, k) - back;
                const radiosity::Affine h = s_.indirect.at(zone, k);
                const double front = (turning * turned.at(in, k) + back) * std::max(0.0, h.at(a));
                const double behind = (turning * turned.at(out, k) + back) * std::max(0.0, h.at(b));
                add(seen, emission, k, transmittance * (w.front + w.back) * emitted);
                add(seen, multiple_scattering, k,
                    transmittance * (w.front * front + w.back * behind));  // (58)
                const double once = single_of(zone, medium, k, ray.direction);
                const radiosity::Affine h_a = s_.direct.at(zone, k);
                const double first = once * h_a.at(a), last = once * h_a.at(b);
                own.held.insert(own.held.end(), {first, last});
                add(seen, single_scattering, k, transmittance * (w.front * first + w.back * last));
                transmittance *= w.transmittance;
                most = std::max(most, transmittance);
            }
            return most > hidden;
        };
        return mesh::descend(s_.forest, below, ray, t_in, t_out, mesh::at_leaves, leaf);
    }

    // s^A of a leaf (61).
    double single_of(ZoneId leaf, std::uint32_t medium, std::size_t band, Direction ray) const {
        return arriving_.sources()
                   ? arriving_.sources()->direct(leaf, band, ray, Coefficients::whole)
                   : media_.albedo(medium, band);
    }

    // What direct light scattered once departs by from what the leaves hold, from two places on the
    // ray.
    void single(const mesh::Ray& ray, const Numbers& u, RandomNumbers& random, Seen& seen) const {
        Way& way = this->way();
        if (way.passed.empty() || light_.empty()) return;
        way.stretches.clear();
        for (const Passed& p : way.passed) {
            Stretch* last = way.stretches.empty() ? nullptr : &way.stretches.back();
            if (last && last->medium == p.stretch.medium && last->end == p.stretch.begin)
                last->end = p.stretch.end;
            else
                way.stretches.push_back(p.stretch);
        }
        const PassedRay along{ray.origin, ray.direction, way.stretches};
        way.shares.assign(bands_, 1.0 / double(bands_));
        const LightPlace place = lights_.choose(random);
        const Equiangular beside(along, way.stretches.front().begin, way.stretches.back().end,
                                 place.at);
        const bool aside = !place.infinite && beside.good();
        const auto both = [&](double t) {
            const double a = media_.density_within(along, t, way.shares);
            const double b = aside ? beside.density(t) : 0.0;
            return std::array{a, b};
        };
        const Collision c = media_.sample_within(along, way.shares, u[2], u[0]);
        if (c.scattered) {
            const auto [a, b] = both(c.distance);
            lit(along, c.distance, a / (a * a + b * b), seen);
        }
        if (aside) {
            const double t = beside.sample(u[1]);
            const auto [a, b] = both(t);
            lit(along, t, b / (a * a + b * b), seen);
        }
    }

    // Adds what one place scatters, times a weight [m].
    void lit(const PassedRay& ray, double t, double weight, Seen& seen) const {
        Way& way = this->way();
        const auto at = std::lower_bound(
            way.passed.begin(), way.passed.end(), t,
            [](const Passed& p, double distance) { return p.stretch.end < distance; });
        if (at == way.passed.end() || t < at->stretch.begin || !(weight > 0.0)) return;
        const auto& [medium, begin, end] = at->stretch;
        const Point x = ray.at(t);
        scatter(x, at->tet, ray.direction, way.scattered);
        way.transmittance.resize(bands_);
        media_.transmittance(ray, t, way.transmittance);
        const double* held = &way.held[2 * bands_ * std::size_t(at - way.passed.begin())];
        const double share = (t - begin) / (end - begin);
        for (std::size_t b = 0; b < bands_; ++b) {
            // As the closed form has it: linear between the leaf's two faces.
            const double in_leaf = (1.0 - share) * held[2 * b] + share * held[2 * b + 1];
            add(seen, single_scattering, b,
                weight * way.transmittance[b] * media_.extinction(medium, b, x) *
                    (way.scattered[b] - in_leaf));
        }
    }

    // What the patch at the ray's end sends out: direct light that whole extinction leaves, anew.
    void strike(const mesh::Ray& ray, const mesh::WalkEnd& end, double before, Seen& seen) const {
        seen.depth = before + end.distance;
        const auto side = e_.facet_sides[end.facet.value][end.side == mesh::Side::back];
        if (side == none) return;
        const Point x = ray.origin + end.distance * ray.direction;
        const auto leaf = s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), x);
        thread_local std::vector<double> direct, more;
        direct.resize(bands_);
        more.resize(bands_);
        light_.at_patch(x, radiosity::normal_of(s_.forest, leaf), end.tet, direct);
        arriving_.beyond(end.facet, end.side, x, more);
        for (std::size_t b = 0; b < bands_; ++b) {
            const double t = seen.transmittance[b], rho = e_.sides[side].reflectance[b];
            const double indirect = std::max(0.0, s_.indirect.at(leaf, b).at(x) + more[b]);
            add(seen, emission, b, t * radiosity::emission_of(s_, leaf, b));
            add(seen, surfaces_direct, b, t * rho * direct[b]);
            add(seen, surfaces_indirect, b, t * rho * indirect);  // (62)
        }
    }

    // Ω ∫ Φ τ L^A dω, of a ray's direction from the eye [W/m^2/sr].
    void scatter(Point x, TetId tet, Direction ray, std::vector<double>& scattered) const {
        scattered.assign(bands_, 0.0);
        const std::uint32_t medium = e_.medium_of(tet);
        if (e_.media[medium].phase.isotropic()) {
            light_.at_zone(x, tet, scattered);
            for (std::size_t b = 0; b < bands_; ++b) scattered[b] *= media_.albedo(medium, b);
            return;
        }
        light_.visit_zone(
            x, tet, widest_seen_part, [&](Direction towards, std::span<const double> irradiance) {
                const double cosine = glm::dot(ray, towards);
                for (std::size_t b = 0; b < bands_; ++b)
                    scattered[b] += media_.scattered(medium, b, cosine) * irradiance[b];
            });
    }

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    std::size_t bands_;
    Point eye_;
    TetId eye_tet_;
    SeenSolution seen_;
    PathLights lights_;
    ArrivingLight arriving_;
    const PathMedia& media_;
    radiosity::DirectLight light_;  // by extinction as it is
    radiosity::PointSet points_;
};

}  // namespace

Image last_scatter(const radiosity::Solution& solution, const Camera& camera,
                   const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    const LastScatter picture(solution, camera, options.direct_tolerance, progress);
    const Sampler sampler = [&](const mesh::Ray& ray, const SampleAt& at, RandomNumbers& random,
                                Seen& seen) { picture.sample(ray, at, random, seen); };
    return sampled_picture(*solution.enclosure, camera, options, {.batch = stratified}, sampler,
                           progress);
}

}  // namespace tyndall::render
