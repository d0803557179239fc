// What a point sees through the pixels of a cube's face: an item buffer with depths for surfaces,
// and for zones a list a pixel (A-buffer) of where its ray enters and leaves them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <span>

#include "radiosity/cube_faces.h"
#include "radiosity/exchange.h"

namespace tyndall::radiosity {

// What can be drawn, for all cubes: triangles and tetrahedra.
struct DrawnElements {
    // The members of all elements; columns are elements'.
    DrawnElements(const Discretization& discretization, std::size_t band);
    // The leaves: patches of opaque facets, zones of media. Columns are those of a PatchId or a
    // ZoneId; what is outside has the column `none`. Extinctions are left at 0.
    DrawnElements(const Enclosure& enclosure, const Forest& forest);

    struct Patch {
        std::array<std::uint32_t, 3> corners;  // counter-clockwise seen from the side it faces
        std::uint32_t column;
    };
    struct Zone {
        std::array<std::uint32_t, 4> corners;
        std::uint32_t column;
        double extinction;  // [1/m]
    };
    std::vector<Point> points;  // of the forest [m]
    std::vector<Patch> patches;
    std::vector<Zone> zones;
    std::uint32_t outside;
};

// A box of pixels: [u_begin, u_end) × [v_begin, v_end).
struct PixelBox {
    std::size_t u_begin = 0, u_end = 0, v_begin = 0, v_end = 0;
    bool empty() const { return u_begin >= u_end || v_begin >= v_end; }
};

// Purpose: the shares of a pixel's delta form factor w that go to what its ray meets,
//     w T (1 − e^{−κΔs})   to a zone passed over Δs, T the transmittance so far
//     w T                  to the patch at the end, or outside                          (8)–(10)
//   A pixel is decided by its middle. Patches are drawn from their front only.
// Edges: a pixel whose middle lies on an edge belongs to the patch that was drawn first; where two
//   zones claim the same stretch of a ray, in the face between them, the nearer beginning has it.
//   Nothing is counted twice, and the shares add up to w.
// Cost: of a face: the elements, each tested against its frame, and for every element the pixels of
//   the rectangle around its projection. Memory: O(elements), and 128² pixels with their lists.
// Source: Cohen & Greenberg (1985); lists a pixel after Carpenter (1984), for zones after
//   Rushmeier & Torrance (1987); edge functions of unclipped triangles: Olano & Greer (1997).
class ItemBuffer {
  public:
    explicit ItemBuffer(const DrawnElements& elements) : elements_(&elements) {}

    // Puts the eye, with the cube's axes as columns of `axes`.
    void look_from(Point eye, const glm::dmat3& axes);

    // deposit(column, share) for every pixel of a face, tile by tile.
    template <class Deposit>
    void project(const CubeFace& face, Deposit&& deposit);

    // A stretch of a pixel's ray in a zone. Distances along the pixel's direction, in units of its
    // length.
    struct Fragment {
        std::uint32_t pixel, column;
        double extinction;
        double near, far;
    };
    // What a pixel shows: zones from the nearest on, no two at one place, and the patch behind.
    struct Pixel {
        std::size_t u, v;
        std::span<const Fragment> zones;  // those with near >= far are to be passed over
        std::uint32_t column;             // of the patch, or outside
        double depth;                     // of the patch, likewise; infinity: none
        double length;                    // of the direction
    };
    // see(pixel) for every pixel of a face, tile by tile.
    template <class See>
    void look(const CubeFace& face, See&& see) {
        for (std::size_t v = 0; v < face.nv; v += tile)
            for (std::size_t u = 0; u < face.nu; u += tile) {
                draw(face, {u, std::min(u + tile, face.nu), v, std::min(v + tile, face.nv)});
                hand_over(see);
            }
    }

  private:
    static constexpr std::size_t tile = 128;  // pixels along its edge: lists stay small

    // Half spaces as seen from the eye: directions d with normal · d ≤ tolerance |d|.
    struct Edge {
        Direction normal;
        double tolerance;
    };
    // normal · x ≤ offset inside.
    struct Plane {
        Direction normal;
        double offset;
        double nothing;  // |normal · d| / |d| up to which a direction lies in the plane
        bool touches;    // the eye lies in the plane, or inside
    };
    struct FacingPatch {
        std::array<Point, 3> corners;  // in the cube's frame [m]
        std::array<Edge, 3> edges;
        Direction normal;  // of its plane, towards the eye, times twice the area [m^2]
        double offset;     // normal · x in it, negative [m^3]
        std::uint32_t column;
    };
    struct SeenZone {
        std::array<Point, 4> corners;
        std::array<Plane, 4> planes;
        std::uint32_t column;
        double extinction;
    };

    void add_patch(const DrawnElements::Patch& patch);
    void add_zone(const DrawnElements::Zone& zone);
    void draw(const CubeFace& face, const PixelBox& tile);
    void draw_patch(const CubeFace& face, const FacingPatch& patch);
    void draw_zone(const CubeFace& face, const SeenZone& zone);
    void sort_fragments();
    template <class See>
    void hand_over(See&& see);
    // on(u, v, length, p) for the pixels of a box: `length` is that of the direction through u and
    // v, p the pixel's place in the tile.
    template <class On>
    void each_pixel(const PixelBox& box, On&& on) const {
        for (std::size_t j = box.v_begin - tile_.v_begin; j < box.v_end - tile_.v_begin; ++j)
            for (std::size_t i = box.u_begin - tile_.u_begin; i < box.u_end - tile_.u_begin; ++i) {
                const std::size_t p = j * u_.size() + i;
                on(u_[i], v_[j], lengths_[p], p);
            }
    }

    const DrawnElements* elements_;
    std::vector<Point> points_;  // in the cube's frame [m]
    double reach_ = 0.0;         // to the farthest of them [m]
    std::vector<FacingPatch> patches_;
    std::vector<SeenZone> zones_;
    PixelBox tile_;
    std::vector<double> u_, v_;         // of the tile's pixels
    std::vector<double> lengths_;       // of their directions
    std::vector<double> depth_;         // of the patch seen, in units of the direction's length
    std::vector<std::uint32_t> items_;  // its column, or outside
    std::vector<Fragment> drawn_, fragments_;  // as drawn; by pixel and nearness
    std::vector<std::uint32_t> ends_;          // of every pixel's fragments
};

template <class See>
void ItemBuffer::hand_over(See&& see) {
    std::size_t begin = 0, p = 0;
    for (std::size_t v = tile_.v_begin; v < tile_.v_end; ++v)
        for (std::size_t u = tile_.u_begin; u < tile_.u_end; ++u, ++p) {
            const std::span<Fragment> zones(fragments_.data() + begin, ends_[p] - begin);
            begin = ends_[p];
            double reached = 0.0;
            for (Fragment& f : zones) {
                f.near = std::max(f.near, reached);
                reached = std::max(reached, f.far);
            }
            see(Pixel{u, v, zones, items_[p], depth_[p], lengths_[p]});
        }
}

template <class Deposit>
void ItemBuffer::project(const CubeFace& face, Deposit&& deposit) {
    look(face, [&](const Pixel& pixel) {
        double left = face.weights[pixel.v * face.nu + pixel.u];
        for (const Fragment& f : pixel.zones) {
            if (!(f.far > f.near)) continue;
            const double lost = -left * std::expm1(-f.extinction * (f.far - f.near) * pixel.length);
            deposit(f.column, lost);
            left -= lost;
        }
        deposit(pixel.column, left);
    });
}

}  // namespace tyndall::radiosity
