// What a surface side makes of light: a Lambertian lobe, and a mirror's or a glossy one.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "radiosity/enclosure.h"
#include "render/glossy_lobe.h"
#include "render/random_numbers.h"

namespace tyndall::render {

enum class Lobe { diffuse, specular };

// A direction that light is followed back to.
struct Bounce {
    mesh::Direction direction{0.0};
    // Per solid angle; 0: a mirror's, which no other way finds [1/sr].
    double density = 0.0;
    bool lost = false;  // below the surface: nothing comes from there
};

// Purpose: reflectance distributions of all sides, and directions drawn from them.
// Equation: f = ρ_d/π + ρ_s × (52); of a mirror ρ_s δ(mirror direction). Reciprocal; reflects
//   ρ_d + ρ_s of all light.
// Directions `out` (to where the light goes) and `in` (to where it comes from) point away from the
// surface, whose unit normal is n.
class SurfaceScattering {
  public:
    // Keeps a reference to the enclosure.
    explicit SurfaceScattering(const radiosity::Enclosure& enclosure);

    // Some side has a specular part.
    bool specular() const { return specular_; }
    // Share of the specular lobe in what a side reflects, of all bands together [-].
    double specular_share(std::uint32_t side) const { return sides_[side].share; }
    bool mirror(std::uint32_t side) const { return sides_[side].share > 0.0 && !sides_[side].lobe; }

    // f cosθ of a lobe [1/sr], and the density with which `sample` draws `in`; 0 of a mirror. The
    // density is returned.
    double value(std::uint32_t side, Lobe lobe, mesh::Direction n, mesh::Direction out,
                 mesh::Direction in, std::span<double> result) const;
    // Draws a direction; `weight` is multiplied by f cosθ / density.
    Bounce sample(std::uint32_t side, Lobe lobe, mesh::Direction n, mesh::Direction out,
                  RandomNumbers& random, std::span<double> weight) const;

  private:
    struct SideLobes {
        double share = 0.0;
        std::shared_ptr<const GlossyLobe> lobe;  // null: none, or a mirror
    };

    const radiosity::Enclosure& e_;
    std::vector<SideLobes> sides_;
    bool specular_ = false;
};

}  // namespace tyndall::render
