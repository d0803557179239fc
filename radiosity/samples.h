// Points at which incident radiance is sampled: the corners of elements, shared by those that may.
#pragma once

#include <unordered_map>

#include "mesh/fans.h"
#include "radiosity/direct_light.h"
#include "radiosity/gather.h"

namespace tyndall::radiosity {

class GatherChange;

using SampleId = mesh::Id<struct SampleTag>;

// A sample belongs to a vertex and a fan of tets (or facet sides) around it; corners of that fan
// share it.
class SampleSet {
  public:
    SampleSet(const Enclosure& enclosure, const Forest& forest);

    // The sample of a vertex for elements in `tet`, or on `facet_side`; made if new. Not
    // thread-safe.
    SampleId in_zone(VertexId vertex, TetId tet);
    SampleId on_patch(VertexId vertex, std::uint32_t facet_side);
    // One of several samples of a vertex at which direct light jumps: `sides`, not 0, tells them
    // apart. Taken at x beside the vertex if new.
    SampleId in_zone(VertexId vertex, TetId tet, std::uint32_t sides, Point x);
    SampleId on_patch(VertexId vertex, std::uint32_t facet_side, std::uint32_t sides, Point x);

    std::size_t size() const { return points_.size(); }
    const GatherPoint& point(SampleId id) const { return points_[id.value]; }

    // Evaluates direct light at the samples that do not have it yet, in parallel.
    void light(const DirectLight& light);
    // Gathers at those of `ids` that have not been gathered yet, in parallel. Returns the rays
    // walked.
    std::size_t gather_at(const std::vector<SampleId>& ids, const GatherScene& scene,
                          const OnPurpose& look, const PointSet& on_surfaces,
                          const PointSet& in_zones, std::uint64_t seed);

    // From now on what rays find at a sample is kept as well, for bodies that move (kept_light.h).
    void keep_in(PlaceMemory* gathers) { keep_ = gathers; }
    // From now on gathers begin with what was kept before bodies have moved; null: no more.
    void take_from(const GatherChange* change) { change_ = change; }

    // What has been gathered is to be gathered anew, from other sources.
    void forget_indirect() { gathered_.assign(gathered_.size(), false); }

    // Whether `gather_at` has been asked for it.
    bool gathered(SampleId id) const { return id.value < gathered_.size() && gathered_[id.value]; }

    double direct(SampleId id, std::size_t band) const { return direct_[id.value * bands_ + band]; }
    double indirect(SampleId id, std::size_t band) const {
        return indirect_[id.value * bands_ + band].mean;
    }
    double half_difference(SampleId id, std::size_t band) const {
        return indirect_[id.value * bands_ + band].half_difference;
    }
    std::size_t memory() const { return points_.size() * (sizeof(GatherPoint) + 80 + bands_ * 24); }

  private:
    struct Key {
        VertexId vertex;
        std::uint32_t fan;  // tet, or facet side + 2^31
        std::uint32_t sides;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& key) const noexcept {
            const auto h =
                (std::uint64_t(key.vertex.value) << 32 | key.fan) * 0x9e3779b97f4a7c15ull;
            return ((h ^ h >> 31) + key.sides) * 0xbf58476d1ce4e5b9ull >> 16;
        }
    };

    // Returns the rays walked.
    std::size_t gather_one(std::size_t sample, const GatherScene& scene, const OnPurpose& look,
                           const PointSet& points, std::uint64_t seed);
    GatherPoint opened(GatherPoint point) const;
    GatherPoint on_side(PatchId root, Point x) const;

    const Enclosure& enclosure_;
    const Forest& forest_;
    mesh::Fans fans_;
    std::size_t bands_;
    std::unordered_map<Key, SampleId, Hash> ids_;
    std::vector<GatherPoint> points_;
    std::vector<double> direct_;      // [sample * bands + band]
    std::vector<Gathered> indirect_;  // [sample * bands + band]
    std::vector<bool> gathered_;
    PlaceMemory* keep_ = nullptr;
    const GatherChange* change_ = nullptr;
    std::size_t lit_ = 0;  // samples that have their direct light
};

}  // namespace tyndall::radiosity
