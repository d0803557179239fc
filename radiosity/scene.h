// What is to be solved: surfaces, materials, media, lights. Plain data in SI units.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/polygon.h"
#include "mesh/types.h"
#include "radiosity/black_body.h"

namespace tyndall::radiosity {

using mesh::Direction;
using mesh::infinity;
using mesh::Point;

// One value a band.
using Spectrum = std::vector<double>;

enum class EmittingSides { front, both };

// How a medium sends light on that it scatters.
enum class PhaseKind { henyey_greenstein, rayleigh };

struct Material {
    std::string name{};
    Spectrum reflectance{};  // Lambertian, 0 to 1 [-]
    // Share of the light that is reflected about the mirror direction; with reflectance at most 1.
    // Empty: none [-].
    Spectrum specular{};
    double roughness = 0.0;  // of the specular part: 0 a mirror, up to 1 [-]
    Spectrum emission{};     // radiance I_e; empty: none [W/m^2/sr]
    Spectrum power{};        // instead of emission: of the whole surface; empty: none [W]
    // Instead: net flux out of the wall, whatever falls on it; 0 is adiabatic. One value a band, or
    // one for all bands where Scene::spectral says what they are; empty: none [W/m^2].
    Spectrum flux{};
    EmittingSides emits = EmittingSides::front;
    std::optional<std::size_t> back{};  // index of the material of the back side; none: the same
    std::string where{};                // file:line:column, for messages
};

struct Surface {
    std::string name{};                     // "room.floor"
    std::vector<mesh::Polygon> polygons{};  // [m]
    std::optional<std::size_t> material{};  // index; none: an interface, light passes
    std::string where{};
};

class RegularGrid;

// How extinction varies in space, at least 0: a function of the place [m], which is sampled to a
// grid before anything is solved (extinction_field.h), from one thread; or a grid.
struct ExtinctionShape {
    std::variant<std::function<double(Point)>, std::shared_ptr<const RegularGrid>> values{};
    std::string where{};  // for messages
};

struct Medium {
    std::string name{};
    Spectrum extinction{};  // kappa_t, or what the shape's values are multiplied by [1/m]
    // Of the extinction: one shape for all bands, or one a band; empty: 1 everywhere [-].
    std::vector<ExtinctionShape> shape{};
    Spectrum albedo{};  // Omega = kappa_s / kappa_t, 0 to 1 [-]
    // g of Henyey–Greenstein, −1 < g < 1; the solve uses reduced coefficients [-]
    double asymmetry = 0.0;
    PhaseKind phase = PhaseKind::henyey_greenstein;  // rayleigh: asymmetry is 0
    Spectrum emission{};                             // J_e; empty: none [W/m^2/sr]
    // Instead: source Q, 0 is radiative equilibrium. One value a band, or one for all as with
    // Material::flux; empty: none [W/m^3].
    Spectrum heat{};
    // Fills the region around this point; none: every region that is not solid [m].
    std::optional<Point> at{};
    std::string where{};
};

// A parallel beam, or a disc at infinity of constant radiance.
struct Sun {
    Direction direction{};  // in which the light travels
    Spectrum irradiance{};  // across the beam [W/m^2]
    double angle = 0.0;     // angular diameter [rad]
};

struct PointLight {
    Point position{};      // [m]
    Spectrum intensity{};  // [W/sr]
};

struct SpotLight {
    Point position{};       // [m]
    Direction direction{};  // axis of the cone
    Spectrum intensity{};   // inside the cone [W/sr]
    double angle = 0.0;     // full opening angle [rad]
    // The intensity falls smoothly to 0 over this angle outside the cone [rad].
    double soft_edge = 0.0;
};

struct Light {
    std::string name{};
    std::variant<Sun, PointLight, SpotLight> source{};
    std::string where{};
};

struct Scene {
    std::string title{};
    std::size_t bands = 1;
    std::vector<Material> materials{};
    std::vector<Surface> surfaces{};
    std::vector<Medium> media{};
    std::vector<Light> lights{};
    Spectrum environment{};           // radiance that comes in from outside; empty: 0 [W/m^2/sr]
    std::vector<Point> viewpoints{};  // cameras' eyes: a region that holds one is not solid [m]
    SpectralModel spectral{};         // what the bands are
    bool thermal = false;  // temperatures are asked for, even if no flux and no heat is given
};

}  // namespace tyndall::radiosity
