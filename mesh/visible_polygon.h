// What part of a polygon can be seen from a point, past opaque polygons, exactly.
//
// Method: everything is taken relative to the point. What an occluder hides of a convex polygon
//   lies in the cone from the point over the occluder and beyond the occluder's plane: an
//   intersection of half spaces. The polygon is cut along those planes; parts outside are kept, the
//   part in all of them is dropped. Occluders that cannot matter are culled by bounding spheres
//   against the cone around the polygon, in a hierarchy.
// Seams: a part within 1e-12 of its distance from a plane counts as inside the cone, so no light
//   leaks between occluders that share an edge.
// Cost: O(occluders that overlap the polygon), each a few dozen flops a visible part.
// Source: Nishita & Nakamae (1985), shadow boundaries of polygons; cone clipping as in Baum et al.
//   (1989).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/convex_merge.h"
#include "mesh/types.h"

namespace tyndall::mesh {

// Convex polygons in one flat list: polygon k has corners [ends[k − 1], ends[k]). Relative to a
// point of view; of a polygon at infinity, directions of any length.
struct ConvexParts {
    std::vector<Point> corners;
    std::vector<std::uint32_t> ends;

    std::size_t size() const { return ends.size(); }
    std::span<const Point> operator[](std::size_t k) const {
        const std::size_t begin = k == 0 ? 0 : ends[k - 1];
        return {corners.data() + begin, ends[k] - begin};
    }
    void clear() { corners.clear(), ends.clear(); }
    void add(std::span<const Point> part) {
        corners.insert(corners.end(), part.begin(), part.end());
        ends.push_back(static_cast<std::uint32_t>(corners.size()));
    }
};

// The part of a convex polygon with dot(normal, p) ≥ offset; appended to `out` (nothing if there is
// none thicker than rounding).
void clip(std::span<const Point> polygon, Direction normal, double offset, std::vector<Point>& out);

enum class Reach { finite, infinite };  // a polygon at its corners' distance, or beyond everything

// What a point looks at, relative to it.
struct Target {
    std::span<const Point> corners;  // convex, counter-clockwise seen from the point
    Reach reach = Reach::finite;
    // Occluders wholly behind this plane through the point do not matter; 0: none.
    Direction horizon{0};
    // Any length: on which side of the planes that it lies on the point is taken to be; 0: what it
    // lies on hides nothing.
    Direction inside{0};
};

// normal·p > offset.
struct HalfSpace {
    Direction normal{0};
    double offset = 0.0;
};

// Working memory of one thread, reused from call to call.
struct VisibleScratch {
    ConvexParts visible;  // the result
    ConvexParts next;
    std::vector<HalfSpace> shadows;          // of the occluders found, one after another
    std::vector<std::uint32_t> shadow_ends;  // as ConvexParts::ends
    std::vector<Point> ring, inside, outside, relative;
    std::vector<double> side;
    std::vector<HalfSpace> crossing, target_edges;
};

struct VisibleLimits {
    std::size_t occluders = 48;  // overlapping the target
    std::size_t parts = 256;     // convex, at any time
};

enum class Visibility {
    none,      // hidden altogether
    all,       // nothing in the way; scratch.visible holds the target itself
    part,      // scratch.visible holds the visible parts
    too_many,  // limits exceeded: nothing is known
};

// Opaque convex polygons, ready to be looked past. Immutable; safe to share among threads.
class Occluders {
  public:
    Occluders() = default;
    // `tolerance` [m]: a point nearer than this to a polygon's plane is on it and is not blocked by
    // it.
    Occluders(std::span<const ConvexPolygon> polygons, double tolerance);

    std::size_t size() const { return planes_.size(); }

    // The visible part of `target` from `eye`, in scratch.visible.
    Visibility look(Point eye, const Target& target, const VisibleLimits& limits,
                    VisibleScratch& scratch) const;

    // Whether something lies between `eye` and eye + path (infinite: beyond as well); `inside` as
    // in Target.
    bool blocked(Point eye, Direction path, Reach reach, Direction inside = Direction(0)) const;

  private:
    // Depth-first tree; a node that is missed is skipped with all below it.
    struct Node {
        Point centre;
        double radius;
        std::uint32_t skip;
        std::uint32_t polygon;  // a leaf's; none else
    };
    struct View;

    std::span<const Point> corners(std::uint32_t k) const {
        return {corners_.data() + begin_[k], begin_[k + 1] - begin_[k]};
    }
    void build(std::span<std::uint32_t> polygons);
    Node bound(std::span<const std::uint32_t> polygons) const;
    Visibility cast_shadow(const View& view, std::uint32_t k, VisibleScratch& scratch) const;
    bool crosses(std::uint32_t k, Point eye, Direction path, Reach reach, Direction inside) const;
    // A tiny step along `inside` off a plane; 0 if it would lead along the plane.
    Direction step(Direction normal, Direction inside) const;

    std::vector<HalfSpace> planes_;
    std::vector<std::uint32_t> begin_{0};
    std::vector<Point> corners_;
    std::vector<Node> nodes_;
    double tolerance_ = 0.0;
};

}  // namespace tyndall::mesh
