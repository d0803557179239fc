// The walk of view/page/walk.frag in double precision over a page's arrays: written from what
// view/viewer_arrays.h says of them.
#pragma once

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "radiosity/segment.h"
#include "view/viewer_arrays.h"

namespace tyndall::test {

struct ViewerWalk {
    const view::ViewerArrays& a;

    // Of a face plane as its leaf sees it, positive inside: unit normal and offset.
    glm::dvec4 plane(std::int32_t face) const {
        const float* p = &a.planes[4 * static_cast<std::size_t>(face >> 1)];
        return (face & 1 ? -1.0 : 1.0) * glm::dvec4(p[0], p[1], p[2], p[3]);
    }
    static double at(const glm::dvec4& f, const glm::dvec3& x) {
        return glm::dot(glm::dvec3(f), x) + f.w;
    }
    glm::dvec4 function(const std::vector<float>& values, std::size_t index) const {
        const float* f = &values[4 * index];
        return {f[0], f[1], f[2], f[3]};
    }
    double nearest_face(std::size_t zone, const glm::dvec3& x) const {
        double least = 1e30;
        for (int k = 0; k < 4; ++k)
            least = std::min(least, at(plane(a.zone_planes[4 * zone + k]), x));
        return least;
    }
    // The leaf that holds x, by looking at all.
    std::size_t zone_at(const glm::dvec3& x) const {
        std::size_t best = 0;
        for (std::size_t z = 1; z < a.zone_count(); ++z)
            if (nearest_face(z, x) > nearest_face(best, x)) best = z;
        return best;
    }

    std::int32_t descend(std::int32_t rope, const glm::dvec3& eye, const glm::dvec3& d,
                         double t) const {
        while (rope >= 0 && rope % 4 == static_cast<int>(view::RopeKind::node)) {
            const std::int32_t* node = &a.nodes[3 * static_cast<std::size_t>(rope / 4)];
            const glm::dvec4 p = plane(2 * node[0]);
            const double start = at(p, eye), slope = glm::dot(glm::dvec3(p), d);
            const bool second = slope == 0.0 ? start > 0.0 : (slope > 0.0) == (t >= -start / slope);
            rope = node[second ? 2 : 1];
        }
        return rope;
    }

    struct Exit {
        int face = 0;
        double t = 1e30;
    };
    Exit exit(std::size_t zone, const glm::dvec3& eye, const glm::dvec3& d) const {
        Exit out;
        for (int k = 0; k < 4; ++k) {
            const glm::dvec4 p = plane(a.zone_planes[4 * zone + k]);
            const double slope = glm::dot(glm::dvec3(p), d);
            if (slope < 0.0 && -at(p, eye) / slope < out.t) out = {k, -at(p, eye) / slope};
        }
        return out;
    }

    // The kind of a rope, and what it leads to.
    static bool is(std::int32_t rope, view::RopeKind kind) {
        return rope >= 0 && rope % 4 == static_cast<int>(kind);
    }

    // Radiance of every band along a ray from inside [W/m^2/sr].
    std::vector<double> radiance(const glm::dvec3& eye, const glm::dvec3& d,
                                 const std::vector<double>& environment) const {
        std::vector<double> sum(a.bands, 0.0), through(a.bands, 1.0);
        std::int32_t rope = view::rope_to(view::RopeKind::zone, zone_at(eye));
        for (double t = 0.0;;) {
            if (rope == view::outside)
                for (std::size_t b = 0; b < a.bands; ++b) sum[b] += through[b] * environment[b];
            if (rope < 0) return sum;
            if (is(rope, view::RopeKind::wall)) {
                strike(static_cast<std::size_t>(rope / 4), eye + t * d, through, sum);
                return sum;
            }
            const auto zone = static_cast<std::size_t>(rope / 4);
            const Exit out = exit(zone, eye, d);
            const double t_out = std::max(t, out.t);
            if (a.zone_row[zone] >= 0) cross(zone, eye + t * d, eye + t_out * d, through, sum);
            t = t_out;
            rope = descend(a.zone_ropes[4 * zone + out.face], eye, d, t);
        }
    }

    void cross(std::size_t zone, const glm::dvec3& in, const glm::dvec3& out,
               std::vector<double>& through, std::vector<double>& sum) const {
        const double length = glm::length(out - in);
        for (std::size_t b = 0; b < a.bands; ++b) {
            const float* row = &a.rows[2 * (a.zone_row[zone] * a.bands + b)];
            const auto direct = function(a.zone_direct, zone * a.bands + b);
            const auto indirect = function(a.zone_indirect, zone * a.bands + b);
            radiosity::SegmentWeights w = radiosity::segment_weights(row[0] * length);
            if (!a.zone_extinction.empty()) {
                const auto kappa = function(a.zone_extinction, zone * a.bands + b);
                const double k0 = std::max(0.0, at(kappa, in)), k1 = std::max(0.0, at(kappa, out));
                w = radiosity::segment_weights(0.125 * length * (3.0 * k0 + k1),
                                               0.125 * length * (k0 + 3.0 * k1));
            }
            const auto gained = [&](const glm::dvec4& f) {
                return std::max(0.0, w.front * at(f, in) + w.back * at(f, out));
            };
            sum[b] +=
                through[b] * ((w.front + w.back) * row[1] + gained(direct) + gained(indirect));
            through[b] *= w.transmittance;
        }
    }

    void strike(std::size_t wall, const glm::dvec3& x, const std::vector<double>& through,
                std::vector<double>& sum) const {
        std::int32_t rope = a.walls[2 * wall];
        while (is(rope, view::RopeKind::node)) {
            const std::int32_t* node = &a.nodes[3 * static_cast<std::size_t>(rope / 4)];
            rope = node[at(plane(2 * node[0]), x) > 0.0 ? 2 : 1];
        }
        if (rope < 0) return;
        const auto piece = static_cast<std::size_t>(rope / 4);
        const auto patch = static_cast<std::size_t>(a.piece_patch[piece]);
        for (std::size_t b = 0; b < a.bands; ++b)
            sum[b] += through[b] *
                      (a.rows[2 * (a.patch_row[patch] * a.bands + b) + 1] +
                       std::max(0.0, at(function(a.piece_direct, piece * a.bands + b), x)) +
                       std::max(0.0, at(function(a.patch_indirect, patch * a.bands + b), x)));
    }
};

}  // namespace tyndall::test
