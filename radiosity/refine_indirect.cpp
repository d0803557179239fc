#include <algorithm>
#include <cmath>

#include "radiosity/quadratic.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {
namespace {

// A departure within this many standard deviations of the gather's noise is taken for noise. On
// patches, which share their directions and are seen as they are, a quarter is enough: an element
// too many costs less than a facet that shows.
template <class Node>
constexpr double deviations = std::is_same_v<Node, PatchId> ? 0.25 : 2.0;
// A settled element keeps the quadratic through its samples, of which its leaves hold linear parts:
// about a quarter of the departure from linear remains where the function is smooth, about half at
// the edges of light on surfaces.
template <class Node>
constexpr double remaining = std::is_same_v<Node, PatchId> ? 0.5 : 0.25;

// A departure joins three samples of equal variance with weights 1, −1/2, −1/2.
const double departure_noise = std::sqrt(1.5);

// Multiple scattering is smooth: the descent starts this many levels above the solved zones.
constexpr int levels_above = 3;

std::vector<ZoneId> ancestors(const Forest& forest, std::vector<ZoneId> nodes) {
    for (ZoneId& node : nodes)
        for (int k = 0; k < levels_above && forest[node].parent.valid(); ++k)
            node = forest[node].parent;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

}  // namespace

IndirectRefiner::IndirectRefiner(const Enclosure& enclosure, ElementMesh& mesh,
                                 const Elements& coarse, std::size_t rays, std::uint64_t seed)
    : enclosure_(enclosure),
      mesh_(mesh),
      coarse_(coarse),
      on_surfaces_(rays),
      in_zones_((rays + 1) / 2),
      seed_(seed) {}

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
    return {remaining<Node> * std::sqrt(square / points) / static_cast<double>(enclosure_.bands),
            edge};
}

RefineResult IndirectRefiner::refine(Fields sources, const LitPatches* lit, double detail,
                                     const Importance& importance, double goal,
                                     const RefineLimits& limits, const ProgressCallback& progress) {
    RefineResult result;
    const Forest& forest = mesh_.forest();
    std::vector<ZoneId> zones = ancestors(forest, coarse_.zones), next_zones;
    std::vector<PatchId> patches = coarse_.patches, next_patches, coarse_leaves;
    double pieces = static_cast<double>(zones.size() + patches.size());
    while (!zones.empty() || !patches.empty()) {
        std::vector<SampleId> ids;
        collect(zones, ids);
        collect(patches, ids);
        result.rays +=
            mesh_.samples().gather_at(ids, GatherScene(enclosure_, forest, sources, detail), lit,
                                      on_surfaces_, in_zones_, seed_);
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
                if (descend && share > remaining<PatchId> * remaining<PatchId> * threshold)
                    coarse_leaves.push_back(p);
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
    divide(coarse_leaves);
    return result;
}

// Patches are seen as they are: a quadratic that one leaf holds is given the leaves that show it.
void IndirectRefiner::divide(const std::vector<PatchId>& patches) {
    const Forest& forest = mesh_.forest();
    for (const PatchId patch : patches) {
        if (forest.is_leaf(patch)) mesh_.bisect(patch);
        const PatchId first = forest[patch].first_child;
        for (const PatchId child : {first, PatchId(first.value + 1ull)})
            if (forest.is_leaf(child)) mesh_.bisect(child);
    }
}

template <class Node>
Node IndirectRefiner::settled(Node node, const std::vector<bool>& flags) const {
    while (!(node.value < flags.size() && flags[node.value])) node = mesh_.forest()[node].parent;
    return node;
}

template <class Node>
auto IndirectRefiner::quadratic(Node node, std::size_t band) {
    const auto samples = mesh_.corners(node);
    constexpr std::size_t count = std::tuple_size_v<decltype(samples)>;
    Quadratic<count> q;
    std::size_t edge = 0;
    for (std::size_t i = 0; i < count; ++i) {
        q.points[i] = mesh_.forest().point(mesh_.forest()[node].corners[i]);
        q.at_corners[i] = mesh_.samples().indirect(samples[i], band);
        for (std::size_t j = i + 1; j < count; ++j)
            q.at_middles[edge++] = mesh_.samples().indirect(mesh_.middle(node, i, j), band);
    }
    return q;
}

template <class Node>
Affine IndirectRefiner::linear_part(Node leaf, std::size_t band) {
    const Forest& forest = mesh_.forest();
    constexpr bool is_zone = std::is_same_v<Node, ZoneId>;
    const Node node = settled(leaf, is_zone ? zone_settled_ : patch_settled_);
    const auto q = quadratic(node, band);
    constexpr std::size_t count = std::tuple_size_v<decltype(q.points)>;
    std::array<Point, count> points;
    std::array<double, count> values;
    for (std::size_t k = 0; k < count; ++k) {
        points[k] = forest.point(forest[leaf].corners[k]);
        values[k] = std::max(0.0, q.at(points[k]));
    }
    const Affine f = interpolate(points, values);
    // Zones are seen as integrals along rays, where the mean counts.
    if (!is_zone) return f;
    const double mean = leaf == node
                            ? q.mean()
                            : 0.05 * (values[0] + values[1] + values[2] + values[count - 1]) +
                                  0.8 * q.at(forest.centroid(leaf));
    return with_mean(f, forest.centroid(leaf), std::max(0.0, mean));
}

Affine IndirectRefiner::field(ZoneId zone, std::size_t band) {
    return linear_part(zone, band);
}

Affine IndirectRefiner::field(PatchId patch, std::size_t band) {
    return linear_part(patch, band);
}

template ZoneId IndirectRefiner::settled(ZoneId, const std::vector<bool>&) const;
template PatchId IndirectRefiner::settled(PatchId, const std::vector<bool>&) const;

}  // namespace tyndall::radiosity
