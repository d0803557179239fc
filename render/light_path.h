// A path from the camera, as LightPaths follows it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "render/light_paths.h"

namespace tyndall::render {

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
        medium_ = radiosity::none;
        while (step()) {
        }
    }

  private:
    // Memory of a thread, from path to path.
    struct Scratch {
        radiosity::Sight sight;
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
    bool step();

    void first_sight();

    // Shares of bands in what the path carries; false: nothing.
    bool share_bands();

    bool roulette();

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
              Coefficients coefficients);

    // Equiangular: from somewhere beside a light, whether or not the path scatters there.
    void look_aside();

    // To which part a scattering on this ray goes.
    Part scattered_into(bool direct) const {
        if (first_) return direct ? single_scattering : multiple_scattering;
        return into_.indirect;
    }

    bool scatter(const Collision& c);

    void scatter_light(Point x, double t, const Collision& c);

    // The weight, by the power heuristic, of having met a light of that density by this direction.
    double weight_of_met(double light_density, Point at, bool infinite) const;

    // Into the environment.
    void leave();

    void meet_suns();

    // What a surface sends out by itself.
    void meet_emitter();

    bool strike();

    // On the surface that a gathering ray meets: what the solution says it sends out.
    void strike_end(Point x);
    // Turns a gathering ray at a mirror that the solution leaves to walks; false: it is none.
    bool mirror_end(Point x);

    Into reflected_into(Lobe lobe) const;

    bool reflect(std::uint32_t side, Point x);

    // One light, for both lobes.
    void reflect_light(std::uint32_t side, Point x, double chance, bool end);

    // What a solution says of the Lambertian part: direct light by closed forms, one ray of the
    // rest.
    void reflect_direct(std::uint32_t side, Point x, Coefficients on_way);
    void reflect_end(std::uint32_t side, Point x);

    // What a solution says of the ray that a medium scattered: lights that it meets, by their
    // weight among the ways to find them, and all the rest.
    void hand_over();

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
    std::uint32_t medium_ = radiosity::none;
    Scratch& own_;
    radiosity::Sight& sight_ = own_.sight;
    PassedRay ray_;
    std::span<double> weight_, shares_, transmittance_, through_, value_, sun_;
    double begin_ = 0.0, end_ = 0.0;  // of media on the ray [m]
    Into into_;
    Before before_;
    bool first_ = true;  // on the ray from the camera
    // Beyond the Lambertian surface that the picture shows, where the way through media from the
    // next one is followed; on the ray that left it.
    bool gathering_ = false, straight_ = false;
    bool mirrored_ = false;  // a gathering ray has been turned by a mirror
    std::size_t rays_ = 0, bounces_ = 0, scatterings_ = 0;
};

}  // namespace tyndall::render
