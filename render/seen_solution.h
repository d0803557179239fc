// What a ray sees of a solution: zones with linear or quadratic J, the patch at its end; and
// pictures as means of rays, with a layer for each part.
#pragma once

#include <functional>
#include <span>

#include "mesh/walk.h"
#include "radiosity/direct_light.h"
#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/picture_parts.h"

namespace tyndall::render {

// Parts of what a solution holds: nothing is specular.
inline constexpr std::size_t solved_parts = specular_reflection;

// What becomes of the light that a mirror reflects which walks go on at.
enum class AtMirrors {
    scatter,  // it is shown as if it were scattered evenly
    go_on,    // it is left to whoever follows the ray on
};

class SeenSolution {
  public:
    // `direct_tolerance`: RenderOptions has it [-].
    SeenSolution(const radiosity::Solution& solution, double direct_tolerance,
                 AtMirrors at_mirrors = AtMirrors::scatter);

    // Adds what a ray gains between two distances in a leaf of a medium, in closed form for J
    // linear or quadratic there (4), (68), and takes the leaf's transmittance. False where so
    // little is left that the rest does not show.
    bool cross(const mesh::Ray& ray, mesh::ZoneId zone, double t_in, double t_out,
               Seen& seen) const;

    // H^I at x of a leaf's patch, one value a band, for the leaf's own [W/m^2/sr].
    using Indirect = std::function<void(mesh::PatchId leaf, mesh::Point x, std::span<double>)>;

    // Adds what the leaf of a patch sends out at x; `before`: the tet on the ray's side of it.
    void strike(mesh::PatchId leaf, mesh::Point x, mesh::TetId before, Seen& seen,
                const Indirect& indirect = {}) const;

    // Adds what a walk along `ray` ends on, surface or outside, and sets the depth. `before`: how
    // far the ray had come when it began [m].
    void arrive(const mesh::Ray& ray, const mesh::WalkEnd& end, double before, Seen& seen,
                const Indirect& indirect = {}) const;

    // Adds what comes in from outside.
    void leave(Seen& seen) const;

    // Mean radiance of the surfaces, a measure of the picture's before there is one [W/m^2/sr].
    double typical_radiance() const { return typical_; }

    // That which surfaces are lit by where it is computed anew.
    const radiosity::DirectLight& light() const { return light_; }

  private:
    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    std::size_t bands_;
    radiosity::DirectLight light_;
    double typical_;
    double threshold_;  // error of a patch's direct light above which it is computed anew
    AtMirrors at_mirrors_;
};

// A picture of the layers that line_of_sight.h names, pixel by pixel; of as many parts as given.
class PictureSums {
  public:
    struct Sums {  // of the rays of a pixel
        std::vector<double> values;
        double depth;
    };
    PictureSums(const Camera& camera, std::size_t bands, std::size_t parts = solved_parts);

    void begin(Sums& sums) const;
    void add(const Seen& seen, Sums& sums) const;
    // From several threads for different pixels.
    void end(const Sums& sums, std::size_t pixel, std::size_t rays);

    Image take() { return std::move(image_); }

  private:
    std::size_t bands_, parts_;
    Image image_;
};

}  // namespace tyndall::render
