// A scene as path tracers describe one: triangles with a material on either side, media within
// boundaries, lights. What the writers of their formats share.
#pragma once

#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "exports/ply_file.h"
#include "exports/spectra.h"
#include "radiosity/enclosure.h"

namespace tyndall::exports {

// In a radian.
inline constexpr double degrees = 180.0 / std::numbers::pi;

// What is seen of one side of a wall.
struct Finish {
    Spectrum diffuse;        // Lambertian [-]
    Spectrum specular;       // about the mirror direction [-]
    double roughness = 0.0;  // of that part; 0 a mirror [-]
    Spectrum emission;       // [W/m^2/sr]

    bool emits() const;
    bool operator==(const Finish&) const = default;
};

// Triangles with the same on both sides. Only the front emits.
struct Sheet {
    std::string name;  // of the surface: "room.floor"
    Triangles triangles;
    Finish front;
    std::optional<Finish> back;  // none: nobody sees it
    // Indices into PathRoom::media; none: empty space.
    std::uint32_t medium_front = radiosity::none, medium_back = radiosity::none;
};

// With the coefficients that the medium has, not the reduced ones of the solve.
struct RoomMedium {
    std::string name;
    Spectrum extinction;  // where it varies: what the grid's values are multiplied by [1/m]
    Spectrum albedo;      // [-]
    Spectrum emission;    // J_e: what is emitted over what is absorbed [W/m^2/sr]
    radiosity::PhaseFunction phase;
    std::shared_ptr<const radiosity::RegularGrid> shape;  // null: uniform
};

struct PathRoom {
    std::size_t bands = 1;          // 1 or 3
    std::vector<Sheet> walls;       // opaque
    std::vector<Sheet> boundaries;  // where a medium ends and no wall is; no finish
    std::vector<RoomMedium> media;
    std::vector<radiosity::Light> lights;
    Spectrum environment;  // [W/m^2/sr]
    double size = 0.0;     // diagonal of the hull [m]
    mesh::Point centre{0};
};

struct PathRoomOptions {
    std::optional<std::size_t> band{};  // this one alone; none: all of them
    // Walls whose sides differ become two sheets, a hundred-thousandth of the room's size apart:
    // for formats with one material for both sides. Where both sides emit that is done in any case.
    bool one_material = false;
};

// Purpose: the conforming triangles of the enclosure, sheet by sheet; where tetrahedra with a
//   medium end at the hull, that too is a boundary.
// Errors: mesh::InputError for what a path tracer cannot know or has no word for: neither one band
//   nor three; a band that is not there; temperatures that a solve finds; a sink (a negative flux);
//   extinctions of bands with different shapes.
// Cost: O(facets + tets).
PathRoom path_room(const radiosity::Enclosure& enclosure, const PathRoomOptions& options = {});

// The medium around a camera's eye, as an index into PathRoom::media; none.
std::uint32_t medium_at(const radiosity::Enclosure& enclosure, mesh::Point x);

// Purpose: the share w of light that meets the specular part where a format blends two materials by
//   one number: rho_s = w s and rho_d = (1 − w) d with s and d at most 1 in every band.
// Errors: mesh::InputError where there is none; `name` is the surface's.
double specular_share(const Finish& finish, const std::string& name);

// Purpose: a glossy finish for programs whose microfacets lose what they reflect more than once.
//   The mean of that over all directions is added to the diffuse part, as far as it fits.
// Equation: rho_s (1 − ⟨E⟩), E of (52).
Finish with_lost_light(Finish finish);

// Names that any format takes, letters, digits and _, each another one.
std::vector<std::string> plain_names(const std::vector<std::string>& names);

}  // namespace tyndall::exports
