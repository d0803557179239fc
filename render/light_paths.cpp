#include "render/light_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/equiangular.h"
#include "render/light_path.h"
#include "render/power_heuristic.h"

namespace tyndall::render {
namespace {

using radiosity::none;
using radiosity::SightEnd;

constexpr std::size_t first_roulette = 3;  // bounce from which paths may end by chance
constexpr double most_survival = 0.98;     // so that they end where nothing is absorbed

}  // namespace

bool LightPaths::Walk::step() {
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
    for (std::size_t b = 0; b < bands_; ++b) weight_[b] *= transmittance_[b] / collision.density;
    if (sight_.end == SightEnd::surface) return sight_.surface != none && strike();
    leave();
    return false;
}

void LightPaths::Walk::first_sight() {
    p_.media_.transmittance(ray_, sight_.distance, seen_.transmittance);
    if (sight_.end == SightEnd::surface) seen_.depth = sight_.distance;
}

bool LightPaths::Walk::share_bands() {
    double sum = 0.0;
    for (const double w : weight_) sum += w;
    if (!(sum > 0.0)) return false;
    for (std::size_t b = 0; b < bands_; ++b) shares_[b] = weight_[b] / sum;
    return true;
}

bool LightPaths::Walk::roulette() {
    if (++bounces_ < first_roulette) return true;
    const double most = *std::max_element(weight_.begin(), weight_.end());
    const double survival = std::min(most_survival, most);
    if (!(random_() < survival)) return false;
    for (double& w : weight_) w /= survival;
    return true;
}

bool LightPaths::Walk::sees(Point x, const LightPlace& place, const FromLight& light,
                            std::uint32_t medium, Coefficients coefficients) {
    auto& stretches = own_.stretches;
    const bool visible = place.infinite ? p_.hits_.sees_out(x, light.direction, medium, stretches)
                                        : p_.hits_.sees(x, place.at, medium, stretches);
    if (!visible) return false;
    const PassedRay way{x, light.direction, stretches};
    p_.media_.transmittance(way, light.distance, through_, coefficients);
    return true;
}

void LightPaths::Walk::look_aside() {
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
    const double phase =
        light.density > 0.0 ? p_.media_.direction_density(on->medium, cosine) / light.density : 0.0;
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

bool LightPaths::Walk::scatter(const Collision& c) {
    // Not beyond the wall by rounding.
    const double t = std::max(0.0, std::min(c.distance, sight_.distance - p_.hits_.offset()));
    const Point x = ray_.at(t);
    p_.media_.transmittance(ray_, c.distance, transmittance_);
    for (std::size_t b = 0; b < bands_; ++b)
        weight_[b] *=
            p_.media_.extinction(c.medium, b, ray_.at(c.distance)) * transmittance_[b] / c.density;
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
    straight_ = false;
    if (end) return hand_over(), false;
    ++scatterings_;
    return roulette();
}

void LightPaths::Walk::scatter_light(Point x, double t, const Collision& c) {
    const LightPlace place = p_.lights_.choose(random_);
    FromLight light;
    if (!p_.lights_.from(place, x, light) || (at_end() && gathered(light))) return;
    const double cosine = glm::dot(direction_, light.direction);
    const double aside =
        place.infinite ? 0.0 : Equiangular(ray_, begin_, end_, place.at).density(t);
    const double phase =
        light.density > 0.0 ? p_.media_.direction_density(c.medium, cosine) / light.density : 0.0;
    const double share = power_heuristic(c.density, aside, c.density * phase);  // (54)
    if (!sees(x, place, light, c.medium, at_vertex())) return;
    const Part to = scattered_into(light.direct);
    for (std::size_t b = 0; b < bands_; ++b)
        add(to, b,
            weight_[b] * p_.media_.scattered(c.medium, b, cosine) * light.irradiance[b] *
                through_[b] * share);
}

double LightPaths::Walk::weight_of_met(double light_density, Point at, bool infinite) const {
    if (before_.density == 0.0) return 1.0;  // no other way finds it
    if (!before_.in_medium) return power_heuristic(before_.density, light_density);
    const double aside =
        infinite ? 0.0
                 : Equiangular(before_.ray, before_.begin, before_.end, at).density(before_.t);
    return power_heuristic(before_.distance_density * before_.density,
                           before_.distance_density * light_density,
                           aside * light_density);  // (54)
}

void LightPaths::Walk::leave() {
    const double w = weight_of_met(p_.lights_.environment_density(), {}, true);
    for (std::size_t b = 0; b < bands_; ++b)
        add(into_.indirect, b, weight_[b] * w * p_.e_.environment[b]);
    if (rays_ > 1 && !straight_) meet_suns();  // they are not drawn where the eye looks at them
}

void LightPaths::Walk::meet_suns() {
    for (std::size_t k = 0; k < p_.lights_.sun_count(); ++k) {
        std::ranges::fill(sun_, 0.0);
        const double density = p_.lights_.sun_disc(direction_, k, sun_);
        if (density == 0.0) continue;
        const double of_sun = weight_of_met(density, {}, true);
        for (std::size_t b = 0; b < bands_; ++b)
            add(into_.direct, b, weight_[b] * of_sun * sun_[b]);
    }
}

void LightPaths::Walk::hand_over() {
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
