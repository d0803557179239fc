#include "render/light_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/equiangular.h"
#include "render/power_heuristic.h"

namespace tyndall::render {
namespace {

using radiosity::none;
using radiosity::Sight;
using radiosity::SightEnd;

constexpr std::size_t first_roulette = 3;  // bounce from which paths may end by chance
constexpr double most_survival = 0.98;     // so that they end where nothing is absorbed

}  // namespace

// One path: what it carries, and where it is.
class LightPaths::Walk {
  public:
    Walk(const LightPaths& paths, RandomNumbers& random, Seen& seen)
        : p_(paths), random_(random), seen_(seen), bands_(paths.e_.bands), own_(scratch()) {
        weight_ = own_.of(0, bands_);
        shares_ = own_.of(1, bands_);
        transmittance_ = own_.of(2, bands_);
        through_ = own_.of(3, bands_);
        value_ = own_.of(4, bands_);
        sun_ = own_.of(5, bands_);
        std::ranges::fill(weight_, 1.0);
    }

    void follow(const mesh::Ray& ray) {
        origin_ = ray.origin;
        direction_ = ray.direction;
        medium_ = none;
        while (step()) {
        }
    }

  private:
    // Memory of a thread, from path to path.
    struct Scratch {
        Sight sight;
        std::vector<Stretch> stretches;
        std::array<std::vector<double>, 6> values;

        std::span<double> of(std::size_t k, std::size_t bands) {
            values[k].resize(bands);
            return values[k];
        }
    };
    static Scratch& scratch() {
        thread_local Scratch own;
        return own;
    }

    // The parts that light goes to when it is found from here on.
    struct Into {
        Part direct = emission, indirect = emission;
    };

    double* part(Part p) { return &seen_.radiance[p * bands_]; }
    void add(Part p, std::size_t band, double value) { seen_.radiance[p * bands_ + band] += value; }

    // One ray of the path; false: it ends.
    bool step() {
        p_.hits_.look(origin_, direction_, medium_, sight_);
        ray_ = {origin_, direction_, sight_.stretches};
        if (rays_++ == 0) first_sight();
        if (!share_bands()) return false;
        p_.media_.add_emission(ray_, weight_, {part(into_.indirect), bands_});
        Collision collision{.density = 1.0};
        if (!ray_.stretches.empty()) {
            look_aside();
            const double u = random_();
            collision = p_.media_.sample(ray_, shares_, u, random_());
        }
        if (!(collision.density > 0.0)) return false;
        if (collision.scattered) return scatter(collision);
        p_.media_.transmittance(ray_, sight_.distance, transmittance_);
        for (std::size_t b = 0; b < bands_; ++b)
            weight_[b] *= transmittance_[b] / collision.density;
        if (sight_.end == SightEnd::surface) return sight_.surface != none && strike();
        leave();
        return false;
    }

    void first_sight() {
        p_.media_.transmittance(ray_, sight_.distance, seen_.transmittance);
        if (sight_.end == SightEnd::surface) seen_.depth = sight_.distance;
    }

    // Shares of bands in what the path carries; false: nothing.
    bool share_bands() {
        double sum = 0.0;
        for (const double w : weight_) sum += w;
        if (!(sum > 0.0)) return false;
        for (std::size_t b = 0; b < bands_; ++b) shares_[b] = weight_[b] / sum;
        return true;
    }

    bool roulette() {
        if (++bounces_ < first_roulette) return true;
        const double most = *std::max_element(weight_.begin(), weight_.end());
        const double survival = std::min(most_survival, most);
        if (!(random_() < survival)) return false;
        for (double& w : weight_) w /= survival;
        return true;
    }

    // Whether a scattering on this ray is the ending's.
    bool at_end() const { return p_.ending_ && scatterings_ + 1 >= p_.ending_->scatterings; }

    // Of the extinction towards lights: a solution's, at an ending.
    Coefficients at_vertex() const { return Coefficients(at_end()); }

    // Whether an ending's own gathers find this light as well.
    bool gathered(const FromLight& light) const {
        return !light.direct || (light.facet && !p_.ending_->emitters_are_direct);
    }

    // Transmittance to a light; false: something is in between.
    bool sees(Point x, const LightPlace& place, const FromLight& light, std::uint32_t medium,
              Coefficients coefficients) {
        auto& stretches = own_.stretches;
        const bool visible = place.infinite
                                 ? p_.hits_.sees_out(x, light.direction, medium, stretches)
                                 : p_.hits_.sees(x, place.at, medium, stretches);
        if (!visible) return false;
        const PassedRay way{x, light.direction, stretches};
        p_.media_.transmittance(way, light.distance, through_, coefficients);
        return true;
    }

    // Equiangular: from somewhere beside a light, whether or not the path scatters there.
    void look_aside() {
        begin_ = ray_.stretches.front().begin;
        end_ = ray_.stretches.back().end;
        if (p_.lights_.empty()) return;
        const LightPlace place = p_.lights_.choose(random_);
        const double u = random_();
        if (place.infinite) return;
        const Equiangular along(ray_, begin_, end_, place.at);
        if (!along.good()) return;
        const double t = along.sample(u);
        const auto on = std::find_if(ray_.stretches.begin(), ray_.stretches.end(),
                                     [&](const Stretch& s) { return t >= s.begin && t <= s.end; });
        if (on == ray_.stretches.end()) return;
        const Point x = ray_.at(t);
        FromLight light;
        if (!p_.lights_.from(place, x, light) || (at_end() && gathered(light))) return;
        const double cosine = glm::dot(direction_, light.direction);
        const double way = along.density(t), distance = p_.media_.density(ray_, t, shares_);
        const double phase = light.density > 0.0
                                 ? p_.media_.direction_density(on->medium, cosine) / light.density
                                 : 0.0;
        const double share = power_heuristic(way, distance, distance * phase);  // (54)
        if (!(share > 0.0) || !sees(x, place, light, on->medium, at_vertex())) return;
        p_.media_.transmittance(ray_, t, transmittance_);
        const Part to = scattered_into(light.direct);
        for (std::size_t b = 0; b < bands_; ++b)
            add(to, b,
                weight_[b] * transmittance_[b] * p_.media_.extinction(on->medium, b, x) *
                    p_.media_.scattered(on->medium, b, cosine) * light.irradiance[b] * through_[b] *
                    share / way);
    }

    // To which part a scattering on this ray goes.
    Part scattered_into(bool direct) const {
        if (first_) return direct ? single_scattering : multiple_scattering;
        return into_.indirect;
    }

    bool scatter(const Collision& c) {
        // Not beyond the wall by rounding.
        const double t = std::max(0.0, std::min(c.distance, sight_.distance - p_.hits_.offset()));
        const Point x = ray_.at(t);
        p_.media_.transmittance(ray_, c.distance, transmittance_);
        for (std::size_t b = 0; b < bands_; ++b)
            weight_[b] *= p_.media_.extinction(c.medium, b, ray_.at(c.distance)) *
                          transmittance_[b] / c.density;
        if (!p_.lights_.empty()) scatter_light(x, t, c);
        const bool end = at_end();
        if (first_)
            into_ = {single_scattering, multiple_scattering};
        else
            into_.direct = into_.indirect;
        const Direction next = p_.media_.sample_direction(c.medium, direction_, random_);
        const double cosine = glm::dot(direction_, next);
        const double density = p_.media_.direction_density(c.medium, cosine);
        for (std::size_t b = 0; b < bands_; ++b)
            weight_[b] *= p_.media_.scattered(c.medium, b, cosine) / density;
        before_ = {true, density, c.density, {origin_, direction_}, begin_, end_, t};
        move(x, next, c.medium);
        if (end) return hand_over(), false;
        ++scatterings_;
        return roulette();
    }

    void scatter_light(Point x, double t, const Collision& c) {
        const LightPlace place = p_.lights_.choose(random_);
        FromLight light;
        if (!p_.lights_.from(place, x, light) || (at_end() && gathered(light))) return;
        const double cosine = glm::dot(direction_, light.direction);
        const double aside =
            place.infinite ? 0.0 : Equiangular(ray_, begin_, end_, place.at).density(t);
        const double phase = light.density > 0.0
                                 ? p_.media_.direction_density(c.medium, cosine) / light.density
                                 : 0.0;
        const double share = power_heuristic(c.density, aside, c.density * phase);  // (54)
        if (!sees(x, place, light, c.medium, at_vertex())) return;
        const Part to = scattered_into(light.direct);
        for (std::size_t b = 0; b < bands_; ++b)
            add(to, b,
                weight_[b] * p_.media_.scattered(c.medium, b, cosine) * light.irradiance[b] *
                    through_[b] * share);
    }

    // The weight, by the power heuristic, of having met a light of that density by this direction.
    double weight_of_met(double light_density, Point at, bool infinite) const {
        if (before_.density == 0.0) return 1.0;  // no other way finds it
        if (!before_.in_medium) return power_heuristic(before_.density, light_density);
        const double aside =
            infinite ? 0.0
                     : Equiangular(before_.ray, before_.begin, before_.end, at).density(before_.t);
        return power_heuristic(before_.distance_density * before_.density,
                               before_.distance_density * light_density,
                               aside * light_density);  // (54)
    }

    // Into the environment.
    void leave() {
        const double w = weight_of_met(p_.lights_.environment_density(), {}, true);
        for (std::size_t b = 0; b < bands_; ++b)
            add(into_.indirect, b, weight_[b] * w * p_.e_.environment[b]);
        if (rays_ > 1) meet_suns();  // they are not drawn where the eye looks at them
    }

    void meet_suns() {
        for (std::size_t k = 0; k < p_.lights_.sun_count(); ++k) {
            std::ranges::fill(sun_, 0.0);
            const double density = p_.lights_.sun_disc(direction_, k, sun_);
            if (density == 0.0) continue;
            const double of_sun = weight_of_met(density, {}, true);
            for (std::size_t b = 0; b < bands_; ++b)
                add(into_.direct, b, weight_[b] * of_sun * sun_[b]);
        }
    }

    // What a surface sends out by itself.
    void meet_emitter() {
        const auto& optics = p_.e_.sides[sight_.surface];
        const double cosine = -glm::dot(direction_, sight_.normal);
        const double met = p_.lights_.density(sight_.facet, sight_.side, sight_.distance, cosine);
        const double w = weight_of_met(met, ray_.at(sight_.distance), false);
        const Part to = radiosity::shines(optics) ? into_.direct : into_.indirect;
        for (std::size_t b = 0; b < bands_; ++b) add(to, b, weight_[b] * w * optics.emission[b]);
    }

    bool strike() {
        meet_emitter();
        return reflect(sight_.surface,
                       ray_.at(sight_.distance) + p_.hits_.offset() * sight_.normal);
    }

    Into reflected_into(Lobe lobe) const {
        if (!first_) return {into_.indirect, into_.indirect};
        if (lobe == Lobe::specular) return {specular_reflection, specular_reflection};
        return {surfaces_direct, surfaces_indirect};
    }

    bool reflect(std::uint32_t side, Point x) {
        const double specular = p_.scattering_.specular_share(side);
        const bool end = p_.ending_ != nullptr;
        const double chance = end ? 1.0 : specular;  // of going on by the specular lobe
        if (!p_.lights_.empty()) reflect_light(side, x, chance, end);
        if (end && specular < 1.0) reflect_end(side, x);
        if (specular == 0.0 && end) return false;
        const bool mirrored = specular > 0.0 && (chance == 1.0 || random_() < chance);
        const Lobe lobe = mirrored ? Lobe::specular : Lobe::diffuse;
        const double choice = mirrored ? chance : 1.0 - chance;
        into_ = reflected_into(lobe);
        first_ = false;
        const Bounce bounce =
            p_.scattering_.sample(side, lobe, sight_.normal, -direction_, random_, weight_);
        if (bounce.lost) return false;
        for (double& w : weight_) w /= choice;
        before_ = {false, bounce.density * choice, 0.0, {}, 0.0, 0.0, 0.0};
        move(x, bounce.direction, sight_.medium);
        return roulette();
    }

    // One light, for both lobes.
    void reflect_light(std::uint32_t side, Point x, double chance, bool end) {
        const LightPlace place = p_.lights_.choose(random_);
        FromLight light;
        if (!p_.lights_.from(place, x, light)) return;
        if (!(glm::dot(light.direction, sight_.normal) > 0.0)) return;
        bool seen = false;
        for (const Lobe lobe : {Lobe::diffuse, Lobe::specular}) {
            if (lobe == Lobe::diffuse && end) continue;
            if (lobe == Lobe::specular &&
                (p_.scattering_.specular_share(side) == 0.0 || p_.scattering_.mirror(side)))
                continue;
            const double density = p_.scattering_.value(side, lobe, sight_.normal, -direction_,
                                                        light.direction, value_) *
                                   (lobe == Lobe::specular ? chance : 1.0 - chance);
            if (!seen && !sees(x, place, light, sight_.medium, Coefficients::whole)) return;
            seen = true;
            const double share =
                light.density > 0.0 ? power_heuristic(light.density, density) : 1.0;
            const Into into = reflected_into(lobe);
            const Part to = light.direct ? into.direct : into.indirect;
            for (std::size_t b = 0; b < bands_; ++b)
                add(to, b, weight_[b] * value_[b] * light.irradiance[b] * through_[b] * share);
        }
    }

    // What a solution says of the Lambertian part: direct light, and one ray of the rest.
    void reflect_end(std::uint32_t side, Point x) {
        const auto& optics = p_.e_.sides[side];
        const PathEnd at{x, sight_.facet, sight_.side, sight_.normal};
        const Into into = reflected_into(Lobe::diffuse);
        p_.ending_->direct(at, value_);
        for (std::size_t b = 0; b < bands_; ++b)
            add(into.direct, b, weight_[b] * optics.diffuse(b) * value_[b]);
        const double u = random_();
        const Direction next = radiosity::cosine_direction(sight_.normal, u, random_());
        p_.ending_->gather(at, next, value_);
        for (std::size_t b = 0; b < bands_; ++b)
            add(into.indirect, b, weight_[b] * optics.diffuse(b) * value_[b]);
    }

    // What a solution says of the ray that a medium scattered: lights that it meets, by their
    // weight among the ways to find them, and all the rest.
    void hand_over() {
        p_.ending_->gather({.x = origin_}, direction_, value_);
        for (std::size_t b = 0; b < bands_; ++b) add(into_.indirect, b, weight_[b] * value_[b]);
        p_.hits_.look(origin_, direction_, medium_, sight_);
        ray_ = {origin_, direction_, sight_.stretches};
        p_.media_.transmittance(ray_, sight_.distance, transmittance_, Coefficients::reduced);
        for (std::size_t b = 0; b < bands_; ++b) weight_[b] *= transmittance_[b];
        if (sight_.end == SightEnd::outside) return meet_suns();
        if (sight_.surface == none || !p_.ending_->emitters_are_direct) return;
        if (radiosity::shines(p_.e_.sides[sight_.surface])) meet_emitter();
    }

    void move(Point x, Direction next, std::uint32_t medium) {
        origin_ = x;
        direction_ = next;
        medium_ = medium;
        first_ = false;
    }

    // The vertex a ray comes from, for the weights of what it meets.
    struct Before {
        bool in_medium = false;
        double density = 0.0;           // of the ray's direction; 0: camera or mirror [1/sr]
        double distance_density = 0.0;  // of a collision, along the ray before [1/m]
        PassedRay ray{};                // the ray before, but for its stretches
        double begin = 0.0, end = 0.0, t = 0.0;
    };

    const LightPaths& p_;
    RandomNumbers& random_;
    Seen& seen_;
    std::size_t bands_;
    Point origin_{0.0};
    Direction direction_{0.0};
    std::uint32_t medium_ = none;
    Scratch& own_;
    Sight& sight_ = own_.sight;
    PassedRay ray_;
    std::span<double> weight_, shares_, transmittance_, through_, value_, sun_;
    double begin_ = 0.0, end_ = 0.0;  // of media on the ray [m]
    Into into_;
    Before before_;
    bool first_ = true;  // on the ray from the camera
    std::size_t rays_ = 0, bounces_ = 0, scatterings_ = 0;
};

LightPaths::LightPaths(const radiosity::Enclosure& enclosure, const PathEnding* ending)
    : e_(enclosure),
      hits_(enclosure),
      media_(enclosure),
      lights_(enclosure),
      scattering_(enclosure),
      ending_(ending) {}

void LightPaths::sample(const mesh::Ray& ray, RandomNumbers& random, Seen& seen) const {
    Walk(*this, random, seen).follow(ray);
}

}  // namespace tyndall::render
