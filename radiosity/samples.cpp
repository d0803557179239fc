#include "radiosity/samples.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "radiosity/kept_light.h"
#include "radiosity/open_places.h"

namespace tyndall::radiosity {
namespace {

// Samples on walls and edges step into their fan by this share of the way to its centroid, so that
// no point lies in the plane of an occluder.
constexpr double step_inside = 1e-5;

std::size_t dimension(const mesh::Carrier& carrier) {
    std::size_t n = 0;
    while (n < 4 && carrier[n].valid()) ++n;
    return n - 1;
}

// The same for points on parallel planes that face the same way, to rounding.
std::uint64_t plane_seed(std::uint64_t seed, Direction normal) {
    for (int axis = 0; axis < 3; ++axis)
        seed = hash_seed(seed, static_cast<std::uint64_t>(std::llround(1e3 * normal[axis])));
    return seed;
}

}  // namespace

SampleSet::SampleSet(const Enclosure& enclosure, const Forest& forest)
    : enclosure_(enclosure), forest_(forest), fans_(enclosure.mesh), bands_(enclosure.bands) {}

SampleId SampleSet::in_zone(VertexId vertex, TetId tet) {
    const auto& carrier = forest_.carrier(vertex);
    const TetId fan = fans_.of_tet(carrier, tet);
    const auto [entry, made] = ids_.try_emplace({vertex, fan.value, 0}, SampleId(points_.size()));
    if (made) {
        GatherPoint point;
        point.x = forest_.point(vertex);
        point.start = {fan};
        if (dimension(carrier) < 3)
            point.x += step_inside * (forest_.centroid(mesh::root_zone(fan)) - point.x);
        points_.push_back(opened(point));
    }
    return entry->second;
}

SampleId SampleSet::in_zone(VertexId vertex, TetId tet, std::uint32_t sides, Point x) {
    const TetId fan = fans_.of_tet(forest_.carrier(vertex), tet);
    const auto [entry, made] =
        ids_.try_emplace({vertex, fan.value, sides}, SampleId(points_.size()));
    if (made) {
        GatherPoint point;
        point.x = x;
        point.start = {tet};
        points_.push_back(opened(point));
    }
    return entry->second;
}

GatherPoint SampleSet::opened(GatherPoint point) const {
    const OpenPlace place = open_place(enclosure_, point.x, point.start.tet);
    point.x = place.x;
    point.start.tet = place.tet;
    return point;
}

GatherPoint SampleSet::on_side(PatchId root, Point x) const {
    GatherPoint point;
    point.x = x;
    point.start = mesh::start_before(enclosure_.mesh, root.value, x);
    point.normal = normal_of(forest_, root);
    return point;
}

SampleId SampleSet::on_patch(VertexId vertex, std::uint32_t facet_side) {
    const auto& carrier = forest_.carrier(vertex);
    const PatchId fan(fans_.of_facet_side(carrier, facet_side));
    const auto [entry, made] =
        ids_.try_emplace({vertex, fan.value | 0x80000000u, 0}, SampleId(points_.size()));
    if (made) {
        Point x = forest_.point(vertex);
        if (dimension(carrier) < 2) x += step_inside * (forest_.centroid(fan) - x);
        points_.push_back(on_side(fan, x));
    }
    return entry->second;
}

SampleId SampleSet::on_patch(VertexId vertex, std::uint32_t facet_side, std::uint32_t sides,
                             Point x) {
    const std::uint32_t fan = fans_.of_facet_side(forest_.carrier(vertex), facet_side);
    const auto [entry, made] =
        ids_.try_emplace({vertex, fan | 0x80000000u, sides}, SampleId(points_.size()));
    if (made) points_.push_back(on_side(PatchId(facet_side), x));
    return entry->second;
}

void SampleSet::light(const DirectLight& light) {
    direct_.resize(points_.size() * bands_);
    tbb::parallel_for(lit_, points_.size(), [&](std::size_t k) {
        const GatherPoint& p = points_[k];
        const std::span<double> out(direct_.data() + k * bands_, bands_);
        if (p.on_surface())
            light.at_patch(p.x, p.normal, p.start.tet, out);
        else
            light.at_zone(p.x, p.start.tet, out);
    });
    lit_ = points_.size();
}

std::size_t SampleSet::gather_at(const std::vector<SampleId>& ids, const GatherScene& scene,
                                 const OnPurpose& look, const PointSet& on_surfaces,
                                 const PointSet& in_zones, std::uint64_t seed) {
    indirect_.resize(points_.size() * bands_);
    gathered_.resize(points_.size());
    std::vector<SampleId> missing;
    std::atomic<std::size_t> rays = 0;
    for (const SampleId id : ids) {
        if (gathered_[id.value]) continue;
        gathered_[id.value] = true;
        missing.push_back(id);
    }
    tbb::parallel_for(std::size_t(0), missing.size(), [&](std::size_t k) {
        const std::size_t i = missing[k].value;
        rays += gather_one(i, scene, look, points_[i].on_surface() ? on_surfaces : in_zones, seed);
    });
    return rays;
}

std::size_t SampleSet::gather_one(std::size_t sample, const GatherScene& scene,
                                  const OnPurpose& look, const PointSet& points,
                                  std::uint64_t seed) {
    const GatherPoint& point = points_[sample];
    const std::span<Gathered> out(indirect_.data() + sample * bands_, bands_);
    // A surface is seen as it is: on one plane all share their directions, so that noise is smooth.
    // Zones are seen many at a time: theirs are independent, so that noise averages out.
    const bool on_surface = point.on_surface();
    const std::uint64_t stream = on_surface ? plane_seed(seed, point.normal) : seed;
    std::size_t walked = 0;
    if (change_ && change_->gather(scene, point, points, stream, out, walked)) return walked;
    walked = gather(scene, look, point, points, on_surface ? stream : hash_seed(seed, sample), out);
    if (keep_) {
        std::vector<double> values;
        for (const Gathered& one : out)
            values.insert(values.end(), {one.mean, one.half_difference});
        values.push_back(static_cast<double>(sample));
        keep_->keep(point.x, point.normal, values);
    }
    return walked;
}

}  // namespace tyndall::radiosity
