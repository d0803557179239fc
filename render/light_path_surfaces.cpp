#include <glm/geometric.hpp>

#include "render/light_path.h"
#include "render/power_heuristic.h"

namespace tyndall::render {

using radiosity::none;

void LightPaths::Walk::meet_emitter() {
    const auto& optics = p_.e_.sides[sight_.surface];
    const double cosine = -glm::dot(direction_, sight_.normal);
    const double met = p_.lights_.density(sight_.facet, sight_.side, sight_.distance, cosine);
    const double w = weight_of_met(met, ray_.at(sight_.distance), false);
    const Part to = radiosity::shines(optics) ? into_.direct : into_.indirect;
    for (std::size_t b = 0; b < bands_; ++b) add(to, b, weight_[b] * w * optics.emission[b]);
}

bool LightPaths::Walk::strike() {
    const Point x = ray_.at(sight_.distance) + p_.hits_.offset() * sight_.normal;
    if (gathering_) return strike_end(x), mirror_end(x);
    meet_emitter();
    return reflect(sight_.surface, x);
}

void LightPaths::Walk::strike_end(Point x) {
    const auto& optics = p_.e_.sides[sight_.surface];
    const bool direct = radiosity::shines(optics) && p_.ending_->emitters_are_direct;
    if (!straight_ || !direct || mirrored_) meet_emitter();
    p_.ending_->incident({x, sight_.facet, sight_.side, sight_.normal}, value_);
    for (std::size_t b = 0; b < bands_; ++b)
        add(into_.indirect, b, weight_[b] * optics.scattered(b) * value_[b]);
}

bool LightPaths::Walk::mirror_end(Point x) {
    if (p_.e_.sides[sight_.surface].mirror.empty()) return false;
    const Bounce bounce = p_.scattering_.sample(sight_.surface, Lobe::specular, sight_.normal,
                                                -direction_, random_, weight_);
    mirrored_ = true;
    move(x, bounce.direction, sight_.medium);
    return roulette();
}

LightPaths::Walk::Into LightPaths::Walk::reflected_into(Lobe lobe) const {
    if (!first_) return {into_.indirect, into_.indirect};
    if (lobe == Lobe::specular) return {specular_reflection, specular_reflection};
    return {surfaces_direct, surfaces_indirect};
}

bool LightPaths::Walk::reflect(std::uint32_t side, Point x) {
    const double specular = p_.scattering_.specular_share(side);
    const bool ending = p_.ending_ != nullptr;
    const bool through = ending && p_.ending_->through_media && scatterings_ == 0;
    const double chance = ending && !through ? 1.0 : specular;  // of the specular lobe
    if (!p_.lights_.empty()) reflect_light(side, x, chance, ending);
    if (ending && specular < 1.0) reflect_direct(side, x, Coefficients(!through));
    if (ending && !through) {
        if (specular < 1.0) reflect_end(side, x);
        if (specular == 0.0) return false;
    }
    const bool mirrored = specular > 0.0 && (chance == 1.0 || random_() < chance);
    const Lobe lobe = mirrored ? Lobe::specular : Lobe::diffuse;
    const double choice = mirrored ? chance : 1.0 - chance;
    into_ = reflected_into(lobe);
    first_ = false;
    const Bounce bounce =
        p_.scattering_.sample(side, lobe, sight_.normal, -direction_, random_, weight_);
    if (bounce.lost) return false;
    for (double& w : weight_) w /= choice;
    gathering_ = straight_ = through && !mirrored;
    // What comes straight from lights is in closed form, and the rest found in no other way.
    before_ = {.density = gathering_ ? 0.0 : bounce.density * choice};
    move(x, bounce.direction, sight_.medium);
    return roulette();
}

void LightPaths::Walk::reflect_light(std::uint32_t side, Point x, double chance, bool end) {
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
        const double density =
            p_.scattering_.value(side, lobe, sight_.normal, -direction_, light.direction, value_) *
            (lobe == Lobe::specular ? chance : 1.0 - chance);
        if (!seen && !sees(x, place, light, sight_.medium, Coefficients::whole)) return;
        seen = true;
        const double share = light.density > 0.0 ? power_heuristic(light.density, density) : 1.0;
        const Into into = reflected_into(lobe);
        const Part to = light.direct ? into.direct : into.indirect;
        for (std::size_t b = 0; b < bands_; ++b)
            add(to, b, weight_[b] * value_[b] * light.irradiance[b] * through_[b] * share);
    }
}

void LightPaths::Walk::reflect_direct(std::uint32_t side, Point x, Coefficients on_way) {
    p_.ending_->direct({x, sight_.facet, sight_.side, sight_.normal}, on_way, value_);
    const Into into = reflected_into(Lobe::diffuse);
    for (std::size_t b = 0; b < bands_; ++b)
        add(into.direct, b, weight_[b] * p_.e_.sides[side].diffuse(b) * value_[b]);
}

void LightPaths::Walk::reflect_end(std::uint32_t side, Point x) {
    const double u = random_();
    const Direction next = radiosity::cosine_direction(sight_.normal, u, random_());
    p_.ending_->gather({x, sight_.facet, sight_.side, sight_.normal}, next, value_);
    const Into into = reflected_into(Lobe::diffuse);
    for (std::size_t b = 0; b < bands_; ++b)
        add(into.indirect, b, weight_[b] * p_.e_.sides[side].diffuse(b) * value_[b]);
}

}  // namespace tyndall::render
