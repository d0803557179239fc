#include "radiosity/cube_faces.h"

#include <cmath>
#include <numbers>

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// Integrals over the pixels of a face, from the function whose mixed derivative is the integrand.
template <class Primitive>
void weigh(CubeFace& face, Primitive&& primitive) {
    const auto corner = [&](std::size_t i, std::size_t j) {
        return primitive(face.u_min + static_cast<double>(i) * face.u_step(),
                         face.v_min + static_cast<double>(j) * face.v_step());
    };
    face.weights.reserve(face.nu * face.nv);
    for (std::size_t j = 0; j < face.nv; ++j)
        for (std::size_t i = 0; i < face.nu; ++i)
            face.weights.push_back(corner(i + 1, j + 1) - corner(i, j + 1) - corner(i + 1, j) +
                                   corner(i, j));
}

double above(double u, double v) {
    const double a = std::sqrt(1.0 + u * u), b = std::sqrt(1.0 + v * v);
    return 0.5 / pi * (u / a * std::atan(v / a) + v / b * std::atan(u / b));
}

double beside(double u, double v) {
    const double b = std::sqrt(1.0 + v * v);
    return -0.5 / pi * std::atan(u / b) / b;
}

double solid_angle_share(double u, double v) {
    return 0.25 / pi * std::atan(u * v / std::sqrt(1.0 + u * u + v * v));
}

CubeFace above_patch(std::size_t resolution, double half_width) {
    CubeFace face;
    face.u_min = face.v_min = -half_width;
    face.u_max = face.v_max = half_width;
    face.nu = face.nv = resolution;
    weigh(face, above);
    return face;
}

}  // namespace

std::vector<CubeFace> hemicube_faces(std::size_t resolution) {
    std::vector<CubeFace> faces{above_patch(resolution, 1.0)};
    for (const int across : {0, 1})
        for (const double sign : {1.0, -1.0}) {
            CubeFace side{.across = across, .along_u = 1 - across, .along_v = 2, .sign = sign};
            side.v_min = 0.0;
            side.nu = resolution;
            side.nv = (resolution + 1) / 2;
            weigh(side, beside);
            faces.push_back(side);
        }
    return faces;
}

std::vector<CubeFace> full_cube_faces(std::size_t resolution) {
    std::vector<CubeFace> faces;
    for (const int across : {0, 1, 2})
        for (const double sign : {1.0, -1.0}) {
            CubeFace face{.across = across,
                          .along_u = (across + 1) % 3,
                          .along_v = (across + 2) % 3,
                          .sign = sign};
            face.nu = face.nv = resolution;
            weigh(face, solid_angle_share);
            faces.push_back(face);
        }
    return faces;
}

std::vector<CubeFace> single_plane_faces(std::size_t resolution) {
    return {above_patch(resolution, single_plane_half_width)};
}

}  // namespace tyndall::radiosity
