// What rows are walked through: the trees of zones and patches in single precision and packed, with
// the column of every node.
#pragma once

#include <array>
#include <cmath>

#include "radiosity/exchange.h"
#include "radiosity/mirrored_ray.h"
#include "radiosity/packed_zones.h"

namespace tyndall::radiosity {

// A ray crosses many zones but ends on one patch: coarser patches make rows no shorter, and their
// means are what a solution with level of detail would be wrong by. They stand for their leaves
// from farther on, by this factor.
inline constexpr float patch_detail = 0.125f;

// Siblings share a cache line: a walk is bound by memory. Lengths are relative to the middle of
// the hull, so that single precision is that of the scene, wherever it lies.
class RowScene {
  public:
    // With levels a zone of size h may stand for the elements below it where h ≤ detail · t, at
    // distance t along the ray, and a patch where h ≤ patch_detail · detail · t. Without: the
    // elements alone. `bands`: whose extinctions one walk meets.
    // Cost: O(nodes). Later bisections of the forest are not seen.
    RowScene(const Discretization& discretization, const RowLevels* levels,
             std::span<const std::size_t> bands, double detail);

    const mesh::BaseMesh& mesh() const { return mesh_; }
    std::size_t memory() const;

  private:
    template <std::size_t Bands, class Deposit>
    friend class RowWalk;
    struct alignas(32) Node {
        float plane[4];        // normal and offset of an inner node's split
        std::uint32_t child;   // first child; none: an element
        std::uint32_t column;  // of exchange areas
        float size;            // longest edge [m]
    };
    struct alignas(64) Pair {
        Node nodes[2];
    };
    struct Tree {
        std::vector<Pair> pairs;  // roots first, by their numbers
        const Node& operator[](std::uint32_t k) const { return pairs[k >> 1].nodes[k & 1]; }
        Node& operator[](std::uint32_t k) { return pairs[k >> 1].nodes[k & 1]; }
    };
    struct Cluster {
        std::uint32_t column;
        std::uint32_t parent;  // none: a root
        float size;            // [m]
    };
    struct Above {
        std::vector<std::uint32_t> of_root;  // smallest cluster; none
        std::vector<Cluster> clusters;
    };

    template <class NodeId>
    Tree pack(const std::vector<std::uint32_t>& tags, const std::vector<std::uint32_t>& elements,
              const std::vector<std::uint32_t>* columns) const;
    static Above pack(const mesh::ClusterTree& tree, const std::vector<std::uint32_t>& columns);

    const mesh::BaseMesh& mesh_;
    const Forest& forest_;
    Point centre_;
    float detail_;
    std::uint32_t outside_;
    Tree zones_, patches_;
    Above zones_above_, patches_above_;
    // Of base tets, [tet * bands + band]: 0 where there is no element [1/m].
    std::vector<float> extinction_;
    // Likewise, null where it is uniform; empty where it is so everywhere.
    std::vector<const ExtinctionBand*> varying_;
    // rho_m of facet sides, [(2 * facet + back) * bands + band]; empty: walks end at all [-].
    std::vector<double> mirrors_;
};

// The part of a ray's way that a deposit is made on.
struct RowLeg {
    const mesh::Ray* ray = nullptr;  // begins where the way did, or at the last mirror
    bool in_mirror = false;          // comes by way of a mirror
    bool on_patch = false;           // the deposit is made where it ends, on a patch
};

// Follows rays, in all bands at once: their way is the same. deposit(leg, column, shares,
// distances): of what a ray carries, 1 in all in each band, its `share` ends in the column, at its
// `distance` [m] from the start of the leg in the mean. At mirrors the way goes on (64); what is
// left when that is too little is not deposited.
template <std::size_t Bands, class Deposit>
class RowWalk {
  public:
    using Values = std::array<double, Bands>;

    // The scene has as many bands.
    RowWalk(const RowScene& scene, Deposit deposit) : s_(scene), deposit_(std::move(deposit)) {}

    // Returns how the walk ended, for the count of lost rays. What is left at the ray's length, if
    // it has one, is not deposited.
    mesh::Arrival follow(const mesh::Ray& ray, mesh::WalkStart start) {
        transmittance_.fill(1.0);
        travelled_ = 0.0f;
        leg_ = {};
        mesh::WalkEnd end = follow_leg(ray, start);
        MirroredRay next{ray, start};
        for (std::size_t mirrors = 0; more_ && mirrors < most_mirrors; ++mirrors) {
            travelled_ += static_cast<float>(end.distance);
            next = mirrored_ray(s_.mesh_, next.ray, end);
            leg_.in_mirror = true;
            end = follow_leg(next.ray, next.start);
        }
        return end.arrival;
    }

  private:
    // The way to the next thing that is struck; more_: it is a mirror.
    mesh::WalkEnd follow_leg(const mesh::Ray& ray, mesh::WalkStart start) {
        const Point from = ray.origin - s_.centre_;
        leg_.ray = &ray;
        leg_.on_patch = false;
        packed_ = PackedRay(from, ray.direction);
        column_ = none;
        depth_.fill(0.0f);
        near_ = far_ = 0.0f;
        more_ = false;
        const auto end =
            mesh::walk(s_.mesh_, ray, start, [&](TetId tet, double t_in, double t_out) {
                cross(tet.value, static_cast<float>(t_in), static_cast<float>(t_out));
                return true;
            });
        flush();
        if (end.arrival == mesh::Arrival::ended) return end;
        std::uint32_t column = s_.outside_;
        const std::uint32_t facet_side = 2 * end.facet.value + (end.side == Side::back);
        if (end.arrival == mesh::Arrival::struck)
            column = arrival(facet_side, from + end.distance * ray.direction,
                             travelled_ + static_cast<float>(end.distance));
        // The dark side of a body, from within rounding of its rim.
        if (column == none) column = s_.outside_;
        leg_.on_patch = column != s_.outside_;
        Values distances;
        distances.fill(end.distance);
        if (!s_.mirrors_.empty() && end.arrival == mesh::Arrival::struck)
            split(column, &s_.mirrors_[facet_side * Bands], distances);
        else
            deposit_(leg_, column, transmittance_, distances);
        return end;
    }

    // What a facet does not mirror ends there (64).
    void split(std::uint32_t column, const double* mirror, const Values& distances) {
        Values shares;
        double most = 0.0;
        for (std::size_t b = 0; b < Bands; ++b) {
            const double kept = transmittance_[b] * mirror[b];
            shares[b] = transmittance_[b] - kept;
            transmittance_[b] = kept;
            most = std::max(most, kept);
        }
        deposit_(leg_, column, shares, distances);
        more_ = most > little_mirrored;
    }

    // The column of the largest cluster above a root that may stand for it; none.
    static std::uint32_t cluster_for(const RowScene::Above& above, std::uint32_t root,
                                     float reach) {
        if (above.of_root.empty()) return none;
        std::uint32_t cluster = above.of_root[root], column = none;
        while (cluster != none && above.clusters[cluster].size <= reach) {
            column = above.clusters[cluster].column;
            cluster = above.clusters[cluster].parent;
        }
        return column;
    }

    // Crosses a base tet: down the tree as a BSP, no deeper than the distance asks for.
    void cross(std::uint32_t tet, float t_in, float t_out) {
        const float* extinction = &s_.extinction_[tet * Bands];
        if (std::all_of(extinction, extinction + Bands, [](float k) { return k == 0.0f; })) return;
        const float detail = s_.detail_;
        varying_ = s_.varying_.empty() ? nullptr : &s_.varying_[tet * Bands];
        if (const auto column = cluster_for(s_.zones_above_, tet, detail * (travelled_ + t_in));
            column != none)
            return pass(column, extinction, t_in, t_out);
        descend_packed(
            s_.zones_, tet, packed_, t_in, t_out,
            [&](std::uint32_t, const RowScene::Node& node, float t) {
                return node.size <= detail * (travelled_ + t);
            },
            [&](std::uint32_t, const RowScene::Node& node, float in, float out) {
                pass(node.column, extinction, in, out);
                return true;
            });
    }

    // Segments of one node on end are one deposit.
    void pass(std::uint32_t column, const float* extinction, float t_in, float t_out) {
        if (varying_ && *varying_) return pass_varying(column, t_in, t_out);
        if (column != column_) {
            flush();
            column_ = column;
            near_ = t_in;
        }
        for (std::size_t b = 0; b < Bands; ++b) depth_[b] += extinction[b] * (t_out - t_in);
        far_ = t_out;
    }

    void pass_varying(std::uint32_t column, double t_in, double t_out) {
        flush();
        column_ = none;
        SegmentOfBands segment(leg_.ray->origin, leg_.ray->direction, t_in, t_out);
        Values shares{}, distances;
        bool any = false;
        for (std::size_t b = 0; b < Bands; ++b) {
            const auto& w = segment.weights(*varying_[b]);
            const double lost = w.front + w.back;
            distances[b] = t_in;
            if (!(lost > 0.0)) continue;
            any = true;
            shares[b] = transmittance_[b] * lost;
            distances[b] = t_in + (t_out - t_in) * (w.back / lost);
            transmittance_[b] -= transmittance_[b] * lost;
        }
        if (any) deposit_(leg_, column, shares, distances);
    }

    void flush() {
        if (std::all_of(depth_.begin(), depth_.end(), [](float d) { return !(d > 0.0f); })) return;
        Values shares, distances;
        for (std::size_t b = 0; b < Bands; ++b) {
            // −expm1: the difference of two exponentials loses digits when thin.
            const double depth = depth_[b], lost = opacity(depth);
            shares[b] = transmittance_[b] * lost;
            distances[b] = near_ + (far_ - near_) * mean_place(depth, lost);
            transmittance_[b] -= transmittance_[b] * lost;
        }
        deposit_(leg_, column_, shares, distances);
        depth_.fill(0.0f);
    }

    static double opacity(double depth) {
        if (depth > 0.03) return -std::expm1(-depth);
        // The series' next term is below 1e-12 of the first.
        return depth *
               (1.0 -
                depth / 2 *
                    (1.0 - depth / 3 * (1.0 - depth / 4 * (1.0 - depth / 5 * (1.0 - depth / 6)))));
    }

    // Where on its way through an optical depth a ray's loss is in the mean, 0 the entry, 1 the
    // exit: ∫₀^τ t e^{−t} dt / (τ (1 − e^{−τ})).
    static double mean_place(double depth, double opacity) {
        if (depth > 0.03) return 1.0 / depth - (1.0 - opacity) / opacity;
        return 0.5 - depth / 12.0;  // the next term is below 4e-8
    }

    std::uint32_t arrival(std::uint32_t facet_side, Point x, float distance) const {
        const float reach = patch_detail * s_.detail_ * distance;
        if (const auto column = cluster_for(s_.patches_above_, facet_side, reach); column != none)
            return column;
        const float at[3]{static_cast<float>(x.x), static_cast<float>(x.y),
                          static_cast<float>(x.z)};
        std::uint32_t patch = facet_side;
        for (;;) {
            const RowScene::Node& node = s_.patches_[patch];
            if (node.child == none || node.size <= reach) return node.column;
            patch = node.child + (dot(node.plane, at) + node.plane[3] > 0.0f ? 1u : 0u);
        }
    }

    const RowScene& s_;
    Deposit deposit_;
    RowLeg leg_;
    const ExtinctionBand* const* varying_ = nullptr;  // of every band, in the tet that is crossed
    PackedRay packed_{};                              // from the middle of the hull
    Values transmittance_{};
    std::uint32_t column_ = none;
    std::array<float, Bands> depth_{};  // optical, in column_ so far
    float near_ = 0.0f, far_ = 0.0f;  // distances where column_ was entered, and reached so far [m]
    float travelled_ = 0.0f;          // to the last mirror [m]
    bool more_ = false;               // a mirror was struck, and enough is left
};

}  // namespace tyndall::radiosity
