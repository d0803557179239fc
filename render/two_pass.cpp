#include "render/two_pass.h"

#include <algorithm>
#include <cmath>

#include "mesh/entry.h"
#include "radiosity/direct_light.h"
#include "radiosity/gather.h"
#include "radiosity/segment.h"
#include "render/equiangular.h"
#include "render/light_paths.h"
#include "render/sampled_picture.h"
#include "render/turned_sources.h"

namespace tyndall::render {
namespace {

using mesh::TetId;
using radiosity::none;
using radiosity::PatchId;
using radiosity::ZoneId;

// Zones below this share of their distance stand for their leaves, as in the solve's own last
// gathers.
constexpr double gather_detail = 0.2;
constexpr std::size_t batch = 8;                 // samples that are stratified together
constexpr std::size_t scatterings_of_lobes = 3;  // where media do not scatter evenly
constexpr double nothing_left = 1e-9;            // of transmittance

// A solution's light, as paths ask for it.
class SolvedLight {
  public:
    SolvedLight(const radiosity::Solution& solution, const Camera& camera)
        : s_(solution),
          e_(*solution.enclosure),
          whole_(with_whole_extinction(e_)),
          eye_(mesh::locate(e_.mesh, camera.eye)),
          light_(e_, {.emitters = closed_form()}),
          whole_light_(whole_, {.emitters = closed_form()}),
          gathered_(e_, s_.forest, radiosity::reflected_sources(s_), gather_detail) {
        gathered_.set_in_mirrors(radiosity::sources_in_mirrors(s_));
    }

    const radiosity::Solution& solution() const { return s_; }
    const radiosity::Enclosure& enclosure() const { return e_; }
    const radiosity::DirectLight& light() const { return light_; }
    bool closed_form() const { return s_.direct_light == radiosity::DirectLightMode::closed_form; }

    // The tet that holds x. Near the camera, most often its own.
    TetId tet_at(Point x) const { return mesh::locate(e_.mesh, x, eye_.valid() ? eye_ : TetId(0)); }

    // H^A on a surface.
    void direct(const PathEnd& at, Coefficients on_way, std::span<double> incident) const {
        const auto& light = on_way == Coefficients::whole ? whole_light_ : light_;
        light.at_patch(at.x, at.normal, start_of(at).tet, incident);
    }

    // H^A and H^I on a surface, of its leaf.
    void incident(const PathEnd& at, std::span<double> incident) const {
        const PatchId leaf = s_.forest.leaf_at(mesh::root_patch(at.facet, at.side), at.x);
        for (std::size_t b = 0; b < e_.bands; ++b)
            incident[b] = std::max(0.0, s_.direct.at(leaf, b).at(at.x)) +
                          std::max(0.0, s_.indirect.at(leaf, b).at(at.x));
    }

    // All but direct light, from a direction.
    void gather(const PathEnd& at, Direction from, std::span<double> radiance) const {
        const mesh::WalkStart start = start_of(at);
        std::ranges::fill(radiance, 0.0);
        if (!start.tet.valid() || e_.solid(start.tet)) return;
        radiosity::radiance_along(gathered_, {at.x, from}, start, radiance);
    }

  private:
    mesh::WalkStart start_of(const PathEnd& at) const {
        return at.facet.valid() ? mesh::start_on(e_.mesh, at.facet, at.side)
                                : mesh::WalkStart{tet_at(at.x)};
    }

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    const radiosity::Enclosure whole_;
    TetId eye_;
    radiosity::DirectLight light_, whole_light_;  // by the solve's extinction, and as it is
    radiosity::GatherScene gathered_;
};

// Where all media scatter evenly and nothing is specular: all but two numbers a sample in closed
// form.
class EvenScene {
  public:
    explicit EvenScene(const SolvedLight& solved)
        : solved_(solved),
          s_(solved.solution()),
          e_(solved.enclosure()),
          bands_(e_.bands),
          media_(e_),
          lights_(e_),
          points_(batch) {}

    void sample(mesh::Ray ray, const SampleAt& at, RandomNumbers& random, Seen& seen) const {
        const mesh::Entry entry = mesh::entry_of(e_.mesh, ray, solved_.tet_at(ray.origin));
        if (!entry.tet.valid()) {
            for (std::size_t b = 0; b < bands_; ++b)
                seen.radiance[emission * bands_ + b] += e_.environment[b];
            return;
        }
        if (e_.solid(entry.tet)) return;
        ray.origin += entry.distance * ray.direction;
        const auto u = points_(at.within, radiosity::hash_seed(at.seed, 1));
        thread_local std::vector<Passed> passed;
        passed.clear();
        const auto end =
            mesh::walk(e_.mesh, ray, {entry.tet}, [&](TetId tet, double in, double out) {
                const auto medium = e_.solid(tet) ? none : e_.medium_of(tet);
                if (medium == none) return true;
                return cross(ray, tet, e_.media[medium], in, out, passed, seen);
            });
        single(ray, passed, u, random, seen);
        if (end.arrival == mesh::Arrival::struck) {
            seen.depth = entry.distance + end.distance;
            strike(ray, end, u, seen);
        } else if (end.arrival == mesh::Arrival::left) {
            for (std::size_t b = 0; b < bands_; ++b)
                seen.radiance[emission * bands_ + b] += seen.transmittance[b] * e_.environment[b];
        }
    }

  private:
    struct Passed {
        TetId tet;
        ZoneId zone;  // a leaf
        Stretch stretch;
    };
    using Numbers = std::array<double, radiosity::point_set_dimensions>;

    void add(Seen& seen, Part part, std::size_t band, double value) const {
        seen.radiance[part * bands_ + band] += value;
    }

    // What the zones of a tet emit and scatter, direct light as its leaves hold it (25).
    bool cross(const mesh::Ray& ray, TetId tet, const radiosity::MediumOptics& optics, double t_in,
               double t_out, std::vector<Passed>& passed, Seen& seen) const {
        const auto medium = e_.medium_of(tet);
        return mesh::descend(
            s_.forest, mesh::root_zone(tet), ray, t_in, t_out, mesh::at_leaves,
            [&](ZoneId zone, double in, double out) {
                passed.push_back({tet, zone, {medium, in, out}});
                const Point a = ray.origin + in * ray.direction,
                            b = ray.origin + out * ray.direction;
                double most = 0.0;
                for (std::size_t k = 0; k < bands_; ++k) {
                    const auto w =
                        optics.varying.empty()
                            ? radiosity::segment_weights(optics.extinction[k] * (out - in))
                            : optics.varying[k].weights(ray.origin, ray.direction, in, out);
                    double& transmittance = seen.transmittance[k];
                    const auto held = [&](const radiosity::Affine& f) {
                        return w.front * f.at(a) + w.back * f.at(b);
                    };
                    add(seen, emission, k,
                        transmittance * (w.front + w.back) * radiosity::emission_of(s_, zone, k));
                    add(seen, single_scattering, k,
                        transmittance * optics.albedo[k] * held(s_.direct.at(zone, k)));
                    add(seen, multiple_scattering, k,
                        transmittance * optics.albedo[k] * held(s_.indirect.at(zone, k)));
                    transmittance *= w.transmittance;
                    most = std::max(most, transmittance);
                }
                return most > nothing_left;
            });
    }

    // What direct light scattered once departs by from what the leaves hold, from two places on the
    // ray.
    void single(const mesh::Ray& ray, std::span<const Passed> passed, const Numbers& u,
                RandomNumbers& random, Seen& seen) const {
        if (passed.empty() || solved_.light().empty()) return;
        thread_local std::vector<Stretch> stretches;
        stretches.clear();
        for (const Passed& p : passed) {
            Stretch* last = stretches.empty() ? nullptr : &stretches.back();
            if (last && last->medium == p.stretch.medium && last->end == p.stretch.begin)
                last->end = p.stretch.end;
            else
                stretches.push_back(p.stretch);
        }
        const PassedRay along{ray.origin, ray.direction, stretches};
        thread_local std::vector<double> shares;
        shares.assign(bands_, 1.0 / double(bands_));
        const LightPlace place = lights_.choose(random);
        const Equiangular beside(along, stretches.front().begin, stretches.back().end, place.at);
        const bool aside = !place.infinite && beside.good();
        const auto both = [&](double t) {
            const double a = media_.density_within(along, t, shares);
            const double b = aside ? beside.density(t) : 0.0;
            return std::array{a, b};
        };
        const Collision c = media_.sample_within(along, shares, u[2], u[0]);
        if (c.scattered) {
            const auto [a, b] = both(c.distance);
            lit(along, passed, c.distance, a / (a * a + b * b), seen);
        }
        if (aside) {
            const double t = beside.sample(u[1]);
            const auto [a, b] = both(t);
            lit(along, passed, t, b / (a * a + b * b), seen);
        }
    }

    // Adds what is scattered at one place beyond what its leaf holds, times a weight [m].
    void lit(const PassedRay& ray, std::span<const Passed> passed, double t, double weight,
             Seen& seen) const {
        const auto at = std::lower_bound(
            passed.begin(), passed.end(), t,
            [](const Passed& p, double distance) { return p.stretch.end < distance; });
        if (at == passed.end() || t < at->stretch.begin || !(weight > 0.0)) return;
        thread_local std::vector<double> incident, transmittance;
        incident.resize(bands_);
        transmittance.resize(bands_);
        const Point x = ray.at(t);
        solved_.light().at_zone(x, at->tet, incident);
        media_.transmittance(ray, t, transmittance);
        const auto& [medium, begin, end] = at->stretch;
        const double share = (t - begin) / (end - begin);
        for (std::size_t b = 0; b < bands_; ++b) {
            // As the closed form has it: linear between what it is at the leaf's two faces.
            const radiosity::Affine f = s_.direct.at(at->zone, b);
            const double held = (1.0 - share) * f.at(ray.at(begin)) + share * f.at(ray.at(end));
            add(seen, single_scattering, b,
                weight * transmittance[b] * media_.extinction(medium, b, x) *
                    media_.albedo(medium, b) * (incident[b] - held));
        }
    }

    void strike(const mesh::Ray& ray, const mesh::WalkEnd& end, const Numbers& u,
                Seen& seen) const {
        const auto side = e_.facet_sides[end.facet.value][end.side == mesh::Side::back];
        if (side == none) return;
        const auto& optics = e_.sides[side];
        const mesh::Direction front = mesh::normal(e_.mesh, end.facet);
        const PathEnd at{ray.origin + end.distance * ray.direction, end.facet, end.side,
                         end.side == mesh::Side::front ? front : -front};
        const PatchId leaf = s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), at.x);
        for (std::size_t b = 0; b < bands_; ++b)
            add(seen, emission, b, seen.transmittance[b] * radiosity::emission_of(s_, leaf, b));
        if (std::ranges::all_of(optics.reflectance, [](double rho) { return rho == 0.0; })) return;
        thread_local std::vector<double> values;
        values.resize(bands_);
        const auto reflect = [&](Part part) {
            for (std::size_t b = 0; b < bands_; ++b)
                add(seen, part, b, seen.transmittance[b] * optics.reflectance[b] * values[b]);
        };
        solved_.direct(at, Coefficients::whole, values);
        reflect(surfaces_direct);
        solved_.gather(at, radiosity::cosine_direction(at.normal, u[3], u[4]), values);
        reflect(surfaces_indirect);
    }

    const SolvedLight& solved_;
    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    std::size_t bands_;
    PathMedia media_;
    PathLights lights_;
    radiosity::PointSet points_;
};

bool has_specular(const radiosity::Enclosure& e) {
    return std::ranges::any_of(e.sides, [](const auto& side) {
        return std::ranges::any_of(side.specular, [](double rho) { return rho > 0.0; });
    });
}

}  // namespace

Image two_pass(const radiosity::Solution& solution, const Camera& camera,
               const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    const SolvedLight solved(solution, camera);
    const auto& enclosure = solved.enclosure();
    const bool even = PathMedia(enclosure).isotropic();
    if (even && !has_specular(enclosure) && options.scatterings <= 1) {
        const EvenScene scene(solved);
        const Sampler sampler = [&](const mesh::Ray& ray, const SampleAt& at, RandomNumbers& random,
                                    Seen& seen) { scene.sample(ray, at, random, seen); };
        return sampled_picture(enclosure, camera, options, {.batch = batch}, sampler, progress);
    }
    PathEnding ending;
    ending.scatterings = options.scatterings > 0 ? options.scatterings
                         : even                  ? 1
                                                 : scatterings_of_lobes;
    ending.emitters_are_direct = solved.closed_form();
    ending.through_media = !even;
    ending.direct = [&](const PathEnd& at, Coefficients on_way, std::span<double> h) {
        solved.direct(at, on_way, h);
    };
    ending.incident = [&](const PathEnd& at, std::span<double> h) { solved.incident(at, h); };
    ending.gather = [&](const PathEnd& at, Direction from, std::span<double> radiance) {
        solved.gather(at, from, radiance);
    };
    const LightPaths paths(enclosure, &ending);
    const Sampler sampler = [&](const mesh::Ray& ray, const SampleAt&, RandomNumbers& random,
                                Seen& seen) { paths.sample(ray, random, seen); };
    return sampled_picture(enclosure, camera, options,
                           {.batch = batch, .specular = paths.specular()}, sampler, progress);
}

}  // namespace tyndall::render
