// Incident radiance at a point, gathered by walking through the linear fields of a solution.
#pragma once

#include <span>

#include "radiosity/bright_cones.h"
#include "radiosity/gather_point.h"
#include "radiosity/lit_patches.h"
#include "radiosity/packed_zones.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {

struct Gathered {
    double mean = 0.0;  // H: mean radiance, cosine-weighted on a surface [W/m^2/sr]
    // Half the difference of what the two halves of the rays find, with its sign: one throw of the
    // mean's noise, and the same throw at all points that share their directions [W/m^2/sr].
    double half_difference = 0.0;
};

// What gathers walk through: the trees and r of every leaf in single precision and packed, since a
// gather is bound by memory (half the bytes of the forest's nodes, a third of the time).
class GatherScene {
  public:
    // `sources`: r of every leaf, coarsened: what it sends out besides direct emission. Zones whose
    // longest edge is below `detail` × distance stand for their leaves (0: always the leaves) [-],
    // but uneven ones (uneven_zones.h).
    // Later bisections of the forest are not seen. Cost: O(nodes).
    GatherScene(const Enclosure& enclosure, const Forest& forest, const Fields& sources,
                double detail = 0.0);

    // Gives a zone or a patch another source, for scenes whose sources change from walk to walk. Of
    // zones inner nodes, too: nothing is coarsened.
    void set_source(ZoneId zone, std::size_t band, const Affine& source);
    void set_source(PatchId patch, std::size_t band, const Affine& source);

    // What patches send along rays that a mirror has turned beside their sources: those that see
    // them straight have it from elsewhere. Of the patches of the forest when it was made, and so
    // of all below them ([node * bands + band]); empty: nothing.
    void set_in_mirrors(std::vector<Affine> more) { in_mirrors_ = std::move(more); }
    // Likewise what they send along rays that are aimed at openings: what they reflect of direct
    // light, if LitPatches have that.
    void set_lit(std::vector<Affine> lit) { lit_ = std::move(lit); }

  private:
    friend class RadianceWalk;
    struct Source {
        float gradient[3], constant;
    };
    struct alignas(64) Sources {
        Source of[4];
    };
    const Source* sources(std::uint32_t zone) const { return sources_[0].of + zone * stride_; }
    const Enclosure& enclosure_;
    const Forest& forest_;
    std::vector<PackedZone> zones_;
    // Of zones, [node * stride + band]: those of a node lie in as few cache lines as can be.
    std::vector<Sources> sources_;
    std::size_t stride_;
    double sent(PatchId leaf, std::size_t band, Point x, const std::vector<Affine>& more) const;
    std::vector<Affine> patches_;           // of patches, [node * bands + band]
    std::vector<Affine> in_mirrors_, lit_;  // set_in_mirrors, set_lit
    bool mirrors_;                          // walks go on at some side
    std::vector<float> extinction_;         // of base tets, [tet * bands + band] [1/m]
    // Of base tets, that of the first band, others follow; null where it is uniform. Empty where it
    // is so everywhere.
    std::vector<const ExtinctionBand*> varying_;
    float detail_;

    friend void radiance_along(const GatherScene&, const mesh::Ray&, mesh::WalkStart,
                               std::span<double>, double);
};

// Radiance that arrives at the ray's origin from its direction, one value a band:
//   L = Σ_segments T ∫ κ e^{−κs} J ds + T I   with J, I linear in their elements            (4)
// and so on with rho_m T along the mirrored ray where I is that of a mirror             (64)
// and beyond `lit_beyond` [m] also what patches reflect of direct light (GatherScene::set_lit).
// Cost: the zones crossed.
void radiance_along(const GatherScene& scene, const mesh::Ray& ray, mesh::WalkStart start,
                    std::span<double> radiance, double lit_beyond = mesh::infinity);

// What gathers look at on purpose, so that rays need not find it by luck; null: nothing.
struct OnPurpose {
    const LitPatches* lit = nullptr;  // what it holds must not be in the scene's sources
    const BrightPlaces* bright = nullptr;
};

// One ray of a gather.
struct GatherRay {
    Direction direction;
    double weight;  // their sum is 1 [-]
    // What it counts in half the difference of what two halves of the rays find: each half a gather
    // of its own, whose weights sum to 1 [-].
    double half_weight;
    double lit_beyond;  // see radiance_along [m]
};

// The rays of one gather after another (69); keeps its memory.
class GatherRays {
  public:
    // From the points of the set, scrambled by `seed`, and aimed at bright places, if there are
    // any.
    void spread(const GatherPoint& point, const BrightPlaces* bright, const PointSet& points,
                std::uint64_t seed);

    std::span<const GatherRay> all() const { return rays_; }
    const BrightCones& cones() const { return cones_; }

  private:
    void add_aimed();
    bool add_ordinary(const GatherPoint& point, const PointSet& points, std::uint64_t seed);

    BrightCones cones_;
    std::vector<GatherRay> rays_;
    std::vector<bool> first_half_;   // of each ray
    std::array<double, 2> aimed_{};  // the sums of weights of aimed rays, of each half
};

// H at a point from the points of the set, scrambled by `seed`: one value a band. Returns how many
// rays it took.
// Cost: points.size() walks, and some more where it aims. Error: see `half_difference`.
std::size_t gather(const GatherScene& scene, const OnPurpose& look, const GatherPoint& point,
                   const PointSet& points, std::uint64_t seed, std::span<Gathered> incident);

}  // namespace tyndall::radiosity
