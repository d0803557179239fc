// The scene as the solver sees it: the base mesh, and what every facet side and region is made of.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/base_mesh.h"
#include "mesh/conform.h"
#include "mesh/tetrahedralize.h"
#include "radiosity/extinction_field.h"
#include "radiosity/phase_function.h"
#include "radiosity/scene.h"

namespace tyndall::radiosity {

using mesh::FacetId;
using mesh::RegionId;
using mesh::Side;
using mesh::TetId;

// What a solve makes of the specular part of perfect mirrors.
enum class Mirrors {
    walked,     // walks go on at them, weighed by what they reflect (mirrored_ray.h)
    scattered,  // they scatter it evenly, as if it were reflectance: the plain zonal method
};

// Of a mirror that reflects all light this share is scattered evenly instead, so that it is an
// element like others [-].
inline constexpr double least_seen = 1e-6;

// One side of a surface: what exchange and net power speak of. "room.floor+" is the front of
// room.floor.
struct SurfaceSide {
    std::string name;         // with + or − (the hull: "outside")
    std::size_t surface = 0;  // index into Scene::surfaces
    Side side = Side::front;
    Spectrum reflectance;   // a of the one equation: rho, or 1 where a flux is given [-]
    Spectrum emission;      // e of the one equation: I_e, or q/pi [W/m^2/sr]
    double area = 0.0;      // that faces a region light can be in [m^2]
    Spectrum emissivity{};  // 1 − rho, of its temperature; empty: 1 − reflectance [-]
    // Net flux out of it in all bands together, where its temperature settles by that: its emission
    // in each band is found with the solution [W/m^2].
    std::optional<double> settled_flux{};
    // The part of `reflectance` that goes about the mirror direction; the solve scatters as if it
    // were Lambertian what of it is not in `mirror`; empty: none [-].
    Spectrum specular{};
    double roughness = 0.0;  // of that part; 0 a mirror [-]
    // The part of `specular` with which walks go on at it, at most 1 − least_seen: what is not
    // scattered there, and does not count among what an element receives; empty: none [-].
    Spectrum mirror{};

    // Lambertian, rho_d.
    double diffuse(std::size_t band) const {
        return specular.empty() ? reflectance[band] : reflectance[band] - specular[band];
    }
    // rho_m: what walks follow.
    double mirrored(std::size_t band) const { return mirror.empty() ? 0.0 : mirror[band]; }
    // What the solve takes for Lambertian: all but that.
    double scattered(std::size_t band) const { return reflectance[band] - mirrored(band); }
    Spectrum scattered() const;
};

// A medium as it is solved: isotropic, with the reduced coefficients of an anisotropic one.
struct MediumOptics {
    std::string name;
    Spectrum extinction;  // kappa_t; its mean over the medium where it varies [1/m]
    Spectrum albedo;      // a of the one equation: Omega, or 1 where heat is given [-]
    // e of the one equation: (1−Omega) J_e, or Q/(4 kappa_t), times 1/pi [W/m^2/sr]
    Spectrum emission;
    Spectrum absorption;  // kappa_a, likewise [1/m]
    // Q of all bands together, as SurfaceSide::settled_flux [W/m^3].
    std::optional<double> settled_heat{};
    // kappa_t of every band where it varies in space; empty: it is uniform.
    std::vector<ExtinctionBand> varying{};
    // The coefficient as it is, not reduced: kappa_s / (1 − g); its mean where it varies. Empty:
    // extinction − absorption [1/m].
    Spectrum scattering{};
    PhaseFunction phase{};
};

inline constexpr std::uint32_t none = 0xffffffffu;

// Invariants: a solid region has no medium; no facet side that faces a solid region has a
// SurfaceSide.
struct Enclosure {
    std::size_t bands = 1;
    mesh::BaseMesh mesh;
    std::vector<SurfaceSide> sides;
    // Of each facet: index into sides of front, back; none.
    std::vector<std::array<std::uint32_t, 2>> facet_sides;
    std::vector<MediumOptics> media;
    // Of each region: index into media; none: empty space.
    std::vector<std::uint32_t> region_medium;
    std::vector<bool> region_solid;  // of each region
    std::vector<Light> lights;
    Spectrum environment;  // radiance from outside [W/m^2/sr]
    bool open = false;     // some active region reaches the hull
    std::vector<std::string> warnings;
    SpectralModel spectral{};           // what the bands are
    bool thermal = false;               // temperatures are found
    Mirrors mirrors = Mirrors::walked;  // how sides are bound

    // Whether given heat and flux are those of all bands together.
    bool settles() const { return bands > 1 && !spectral.empty(); }
    std::uint32_t medium_of(TetId tet) const {
        return region_medium[mesh.regions[tet.value].value];
    }
    bool solid(TetId tet) const { return region_solid[mesh.regions[tet.value].value]; }
    // kappa_t of a base tet, 0 in empty space; the medium's mean where `varying` [1/m].
    double extinction(TetId tet, std::size_t band) const {
        const auto medium = medium_of(tet);
        return medium == none ? 0.0 : media[medium].extinction[band];
    }
    // kappa_t of the tet's medium where it varies in space; null: it does not.
    const ExtinctionBand* varying(TetId tet, std::size_t band) const {
        const auto medium = medium_of(tet);
        return medium == none || media[medium].varying.empty() ? nullptr
                                                               : &media[medium].varying[band];
    }
    // Whether kappa_t of any medium varies in space.
    bool varies() const;
    // Whether walks go on at any side.
    bool has_mirrors() const;
};

struct EnclosureOptions {
    mesh::ConformOptions conform{};
    mesh::TetrahedralizeOptions tetrahedralize{};
    // The user's own tetrahedra (mesh/tet_file.h) in place of TetGen's; empty: none.
    std::filesystem::path tetrahedra{};
    SampleOptions extinction{};  // how functions of space are sampled
    Mirrors mirrors = Mirrors::walked;
};

// Whether direct light may count what a side emits in closed form: a sink (a negative flux) cannot
// be a lamp.
bool shines(const SurfaceSide& side);

// Purpose: conform the surfaces, tetrahedralize, tell solid from empty from filled, bind optics.
//   Spectra of one value hold for all bands (scene_bands.h).
// Errors: mesh::InputError with file:line:column (Scene's `where`) and name: what cannot be meshed;
//   a spectrum that is missing, or has another number of values than there are bands; a medium
//   point in no region, on a wall or outside; two media that claim one region; a power on a surface
//   without area; a closed region with a source, a flux or heat, but no absorption and no opening;
//   a file of tetrahedra that cannot be read or does not follow the surfaces; an extinction below 0
//   or not finite somewhere, or one that varies beside a heat source.
// Cost: dominated by CGAL and TetGen; about 1 s for a thousand facets.
Enclosure make_enclosure(const Scene& scene, const EnclosureOptions& options = {});

}  // namespace tyndall::radiosity
