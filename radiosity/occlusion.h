// Whether two points see each other, by shadow rays through Embree.
#pragma once

#include <memory>

#include "radiosity/enclosure.h"

namespace tyndall::radiosity {

// All opaque facets of an enclosure. Single precision: for sampled visibility, where thousands of
// occluders overlap; mesh::Occluders is the exact form.
// Source: Wald et al. (2014), Embree.
class Occlusion {
  public:
    explicit Occlusion(const mesh::BaseMesh& mesh);
    ~Occlusion();
    Occlusion(Occlusion&&) noexcept;
    Occlusion& operator=(Occlusion&&) noexcept;

    // Whether an opaque facet lies between x and x + path, the ends apart. Thread-safe.
    bool blocked(Point x, Direction path) const;
    // Length of a path's ends that is not looked at [m].
    double end_gap() const { return gap_; }

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
    double gap_ = 0.0;
};

}  // namespace tyndall::radiosity
