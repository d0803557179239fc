// Sun, point and spot lights as flat mirrors show them: image sources.
//
// Purpose: direct light by way of mirrors from lights that rays cannot find. Emitting surfaces are
//   found by the rays of rows and gathers, and have no images here.
// Equation: the image of a light in the planes of mirrors m_1 … m_k, seen from x through all of
//   them, sends what the light itself would over the same way, times the product of their rho_m:
//     H = ∏ rho_m · τ E_⊥ cosθ / π on a surface, ∏ rho_m · τ E_⊥ / (4π) in a medium          (65)
// Method: images of images are made once, in planes that they are in front of. From a place the ray
//   towards an image is walked, and turned where it strikes a mirror; it counts if it meets just
//   the mirrors that the image was made by, and then the light.
// Valid for: flat mirrors, and curved ones as flat as they are meshed. A sun with a diameter is
//   `sun_points` suns without one. Images stop where mirrors leave less than a thousandth, and at
//   `most_images`.
// Cost: a few operations an image, and a walk for each whose first mirror is met.
// Source: image rooms of Wallace, Cohen & Greenberg (1987), by rays; image sources of acoustics,
//   Allen & Berkley (1979).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "radiosity/mean_transmittance.h"
#include "radiosity/mirrored_ray.h"

namespace tyndall::radiosity {

class MirroredLights {
  public:
    static constexpr std::size_t sun_points = 16;     // of a sun with a diameter
    static constexpr std::size_t most_images = 4096;  // of all lights

    // Keeps a reference to the enclosure. Without mirrors there are no images, and no cost.
    explicit MirroredLights(const Enclosure& enclosure);

    bool empty() const { return images_.empty(); }
    // There were more: what they send is missing.
    bool cut() const { return cut_; }

    // Adds H at a receiver, one value a band [W/m^2/sr]. Thread-safe.
    void gather(const Receiver& receiver, std::span<double> incident) const;

    // visit(towards, irradiance): the unit direction that the light of an image comes from, and its
    // irradiance across it, one value a band [W/m^2].
    using Visit = std::function<void(Direction towards, std::span<const double> irradiance)>;
    void visit(const Receiver& receiver, const Visit& visit) const;

  private:
    struct Plane {
        Direction normal;  // away from the mirror
        double offset;     // normal · x on it
        Point low, high;   // box that holds the mirror's facets
        std::uint32_t side;
    };
    struct Image {
        std::uint32_t light;  // of the enclosure
        bool infinite;
        Point at;                  // infinite: the unit direction towards it
        double share;              // of the light's power that the image stands for [-]
        std::uint32_t begin, end;  // its planes in planes_met_, the one nearest to the eye first
    };

    void find_planes();
    void add_images(std::uint32_t light, bool infinite, Point at, double share);
    bool faces(const Plane& plane, bool infinite, Point at) const;
    // Whether a ray to an image can meet its first mirror.
    bool meets(const Plane& plane, const mesh::Ray& ray) const;
    // Follows the ray; false: it does not come to the light. `irradiance`: what arrives.
    bool follow(const Image& image, mesh::Ray ray, mesh::WalkStart start,
                std::span<double> irradiance) const;

    const Enclosure& e_;
    double tolerance_;  // [m]
    std::vector<Plane> planes_;
    std::vector<std::uint32_t> plane_of_;  // of facet sides; none
    std::vector<Image> images_;
    std::vector<std::uint32_t> planes_met_;
    bool cut_ = false;
};

}  // namespace tyndall::radiosity
