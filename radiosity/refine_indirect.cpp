#include <algorithm>
#include <cmath>

#include "radiosity/refine.h"

namespace tyndall::radiosity {
namespace {

// A departure within this many standard deviations of the gather's noise is taken for noise. On
// patches, which are seen as they are, one is enough: an element too many costs less than a facet
// that shows.
template <class Node>
constexpr double deviations = std::is_same_v<Node, PatchId> ? 1.0 : 2.0;
// A departure joins three samples of equal variance with weights 1, −1/2, −1/2.
const double departure_noise = std::sqrt(1.5);

}  // namespace

IndirectRefiner::IndirectRefiner(const Enclosure& enclosure, ElementMesh& mesh,
                                 const Elements& coarse, std::size_t rays, std::uint64_t seed)
    : enclosure_(enclosure), mesh_(mesh), coarse_(coarse), points_(rays), seed_(seed) {}

template <class Node>
void IndirectRefiner::collect(const std::vector<Node>& frontier, std::vector<SampleId>& ids) {
    for (const Node node : frontier) {
        const auto corners = mesh_.corners(node);
        ids.insert(ids.end(), corners.begin(), corners.end());
        const int count = static_cast<int>(corners.size());
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j) ids.push_back(mesh_.middle(node, i, j));
    }
}

template <class Node>
std::pair<double, std::array<int, 2>> IndirectRefiner::measure(Node node) {
    const SampleSet& samples = mesh_.samples();
    const auto corners = mesh_.corners(node);
    const int count = static_cast<int>(corners.size());
    const auto& vertices = mesh_.forest()[node].corners;
    std::vector<SampleId> all(corners.begin(), corners.end());
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) all.push_back(mesh_.middle(node, i, j));
    // One sample's spread may be small by chance; that of all the element's samples is not.
    std::vector<double> noise(enclosure_.bands, 0.0);
    for (std::size_t b = 0; b < noise.size(); ++b) {
        for (const SampleId id : all) noise[b] += samples.spread(id, b) * samples.spread(id, b);
        noise[b] = deviations<Node> * departure_noise *
                   std::sqrt(noise[b] / static_cast<double>(all.size()));
    }

    double worst = 0.0, square = 0.0;
    std::array<int, 2> edge = mesh_.forest().longest_edge(node);
    std::size_t next = corners.size();
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            const SampleId middle = all[next++];
            double error = 0.0;
            for (std::size_t b = 0; b < enclosure_.bands; ++b) {
                const double departure =
                    samples.indirect(middle, b) -
                    0.5 * (samples.indirect(corners[i], b) + samples.indirect(corners[j], b));
                error += std::max(0.0, std::abs(departure) - noise[b]);
            }
            square += error * error;
            const double length =
                glm::distance(mesh_.forest().point(vertices[i]), mesh_.forest().point(vertices[j]));
            if (error > worst && length > 0.35 * mesh_.forest()[node].longest_edge) {
                worst = error;
                edge = {i, j};
            }
        }
    const double points = 0.5 * count * (count - 1);
    return {std::sqrt(square / points) / static_cast<double>(enclosure_.bands), edge};
}

RefineResult IndirectRefiner::refine(Fields sources, double detail, const Importance& importance,
                                     double goal, const RefineLimits& limits,
                                     const ProgressCallback& progress) {
    RefineResult result;
    const Forest& forest = mesh_.forest();
    std::vector<ZoneId> zones = coarse_.member_zones(), next_zones;
    std::vector<PatchId> patches = coarse_.member_patches(), next_patches;
    double pieces = static_cast<double>(zones.size() + patches.size());
    while (!zones.empty() || !patches.empty()) {
        std::vector<SampleId> ids;
        collect(zones, ids);
        collect(patches, ids);
        result.rays += mesh_.samples().gather_at(
            ids, GatherScene(enclosure_, forest, sources, detail), points_, seed_);
        for (auto* flags : {&zone_settled_, &patch_settled_})
            flags->resize(std::max(forest.zone_count(), forest.patch_count()));
        for (auto* errors : {&zone_error_, &patch_error_})
            errors->resize(std::max(forest.zone_count(), forest.patch_count()));
        result.stopped =
            progress &&
            !progress({"indirect light", 1.0 - double(zones.size() + patches.size()) / pieces,
                       mesh_.leaf_count(), 0.0});
        result.limited =
            mesh_.leaf_count() >= limits.max_elements || mesh_.memory() > limits.max_memory;
        const bool descend = !result.stopped && !result.limited;
        const double threshold = goal / pieces;
        next_zones.clear();
        next_patches.clear();
        for (const ZoneId z : zones) {
            const auto [error, edge] = measure(z);
            const double a =
                mean_over_bands(enclosure_.media[medium_of(enclosure_, forest, z)].albedo);
            const double share = importance.of(z) * a * a * error * error;
            if (!descend || share <= threshold || forest[z].longest_edge <= limits.smallest_edge) {
                zone_settled_[z.value] = true;
                zone_error_[z.value] = static_cast<float>(error);
                result.squared_error += share;
                continue;
            }
            if (forest.is_leaf(z)) mesh_.bisect(z, edge);
            const ZoneId first = forest[z].first_child;
            next_zones.insert(next_zones.end(), {first, ZoneId(first.value + 1ull)});
            pieces += 1.0;
        }
        for (const PatchId p : patches) {
            const double error = measure(p).first;
            const double a =
                mean_over_bands(enclosure_.sides[side_of(enclosure_, forest, p)].reflectance);
            const double share = importance.of(p) * a * a * error * error;
            if (!descend || share <= threshold || forest[p].longest_edge <= limits.smallest_edge) {
                patch_settled_[p.value] = true;
                patch_error_[p.value] = static_cast<float>(error);
                result.squared_error += share;
                continue;
            }
            if (forest.is_leaf(p)) mesh_.bisect(p);
            const PatchId first = forest[p].first_child;
            next_patches.insert(next_patches.end(), {first, PatchId(first.value + 1ull)});
            pieces += 1.0;
        }
        extend(forest, sources);
        zones.swap(next_zones);
        patches.swap(next_patches);
    }
    return result;
}

template <class Node>
Node IndirectRefiner::settled(Node node, const std::vector<bool>& flags) const {
    while (!(node.value < flags.size() && flags[node.value])) node = mesh_.forest()[node].parent;
    return node;
}

Affine IndirectRefiner::field(ZoneId zone, std::size_t band) {
    const ZoneId node = settled(zone, zone_settled_);
    const auto samples = mesh_.corners(node);
    std::array<Point, 4> points;
    std::array<double, 4> values;
    for (int k = 0; k < 4; ++k) {
        points[k] = mesh_.forest().point(mesh_.forest()[node].corners[k]);
        values[k] = mesh_.samples().indirect(samples[k], band);
    }
    return interpolate(points, values);
}

Affine IndirectRefiner::field(PatchId patch, std::size_t band) {
    const PatchId node = settled(patch, patch_settled_);
    const auto samples = mesh_.corners(node);
    std::array<Point, 3> points;
    std::array<double, 3> values;
    for (int k = 0; k < 3; ++k) {
        points[k] = mesh_.forest().point(mesh_.forest()[node].corners[k]);
        values[k] = mesh_.samples().indirect(samples[k], band);
    }
    return interpolate(points, values);
}

template ZoneId IndirectRefiner::settled(ZoneId, const std::vector<bool>&) const;
template PatchId IndirectRefiner::settled(PatchId, const std::vector<bool>&) const;

}  // namespace tyndall::radiosity
