#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "radiosity/open_places.h"
#include "radiosity/quadratic.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {
namespace {

// A departure within this many standard deviations of the gather's noise is taken for noise: an
// element too many costs less than light that bulges and is not followed.
constexpr double deviations = 1.0;
// A settled element keeps the quadratic through its samples, of which its leaves hold linear parts.
// What is left of the departure from linear: measured where elements are bisected, against what was
// gathered below them, 0.2 to 0.35 where light is smooth, and half at edges of light on surfaces.
constexpr double remaining = 0.25;

// A departure joins three samples of equal variance with weights 1, −1/2, −1/2.
const double departure_noise = std::sqrt(1.5);

// Of a squared error: what it has grown by where a descent that ended goes on.
constexpr double grown = 4.0;

// Of the share that an element may have: one with less is linear.
constexpr double linear_share = 0.03;

// Multiple scattering is smooth: the descent starts this many levels above the solved zones.
constexpr int levels_above = 1;

std::vector<ZoneId> ancestors(const Forest& forest, std::vector<ZoneId> nodes) {
    for (ZoneId& node : nodes)
        for (int k = 0; k < levels_above && forest[node].parent.valid(); ++k)
            node = forest[node].parent;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

}  // namespace

GatherScene IndirectSources::scene(const Enclosure& enclosure, const Forest& forest) const {
    GatherScene scene(enclosure, forest, fields, detail);
    scene.set_in_mirrors(in_mirrors);
    scene.set_lit(lit);
    return scene;
}

IndirectRefiner::IndirectRefiner(const Enclosure& enclosure, ElementMesh& mesh,
                                 const Elements& coarse, std::size_t rays, std::uint64_t seed,
                                 Radiance radiance)
    : enclosure_(enclosure),
      mesh_(mesh),
      coarse_(coarse),
      on_surfaces_(rays),
      in_zones_((rays + 3) / 4),
      seed_(seed),
      quadratic_(radiance == Radiance::quadratic) {}

template <class Node>
void IndirectRefiner::add_middles(Node node, std::vector<SampleId>& ids) {
    const int count = static_cast<int>(mesh_.corners(node).size());
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) ids.push_back(mesh_.middle(node, i, j));
}

bool IndirectRefiner::was_linear(PatchId patch) const {
    const FacetId facet(mesh_.forest().base_facet_side(patch) / 2);
    return before_ && is_set(before_->linear_patches, patch.value) &&
           mesh::on_body(enclosure_.mesh, facet);
}

template <class Node>
double IndirectRefiner::error_by_corners(Node node) {
    double error = 0.0;
    for (std::size_t b = 0; b < enclosure_.bands; ++b) {
        double least = std::numeric_limits<double>::infinity(), most = 0.0;
        for (const SampleId id : mesh_.corners(node)) {
            least = std::min(least, mesh_.samples().indirect(id, b));
            most = std::max(most, mesh_.samples().indirect(id, b));
        }
        error += 0.25 * remaining * (most - least);
    }
    return error / static_cast<double>(enclosure_.bands);
}

template <class Node, class Share>
std::size_t IndirectRefiner::gather(const std::vector<Node>& frontier,
                                    const IndirectSources& sources, const Share& share,
                                    double threshold) {
    const GatherScene scene = sources.scene(enclosure_, mesh_.forest());
    const auto gather_at = [&](const std::vector<SampleId>& ids) {
        return mesh_.samples().gather_at(ids, scene, sources.look, on_surfaces_, in_zones_, seed_);
    };
    std::vector<SampleId> ids;
    std::vector<Node> linear;
    for (const Node node : frontier) {
        const auto corners = mesh_.corners(node);
        ids.insert(ids.end(), corners.begin(), corners.end());
        if (was_linear(node))
            linear.push_back(node);
        else
            add_middles(node, ids);
    }
    const std::size_t rays = gather_at(ids);
    ids.clear();
    for (const Node node : linear)
        if (share(node, error_by_corners(node)) > threshold) add_middles(node, ids);
    return rays + gather_at(ids);
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
    // One sample's half difference may be small by chance; that of all the element's samples is
    // not.
    std::vector<double> noise(enclosure_.bands, 0.0);
    const auto gathered = [&](SampleId id) { return samples.gathered(id); };
    const auto number = static_cast<double>(std::ranges::count_if(all, gathered));
    for (std::size_t b = 0; b < noise.size(); ++b) {
        for (const SampleId id : all | std::views::filter(gathered)) {
            const double spread = samples.half_difference(id, b);
            noise[b] += spread * spread;
        }
        noise[b] = deviations * departure_noise * std::sqrt(noise[b] / number);
    }

    double worst = 0.0, square = 0.0, measured = 0.0;
    std::array<int, 2> edge = mesh_.forest().longest_edge(node);
    std::size_t next = corners.size();
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            const SampleId middle = all[next++];
            if (!gathered(middle)) continue;
            double error = 0.0;
            for (std::size_t b = 0; b < enclosure_.bands; ++b) {
                const double departure =
                    samples.indirect(middle, b) -
                    0.5 * (samples.indirect(corners[i], b) + samples.indirect(corners[j], b));
                error += std::max(0.0, std::abs(departure) - noise[b]);
            }
            square += error * error;
            ++measured;
            const double length =
                glm::distance(mesh_.forest().point(vertices[i]), mesh_.forest().point(vertices[j]));
            if (error > worst && length > 0.35 * mesh_.forest()[node].longest_edge) {
                worst = error;
                edge = {i, j};
            }
        }
    if (measured == 0.0) return {error_by_corners(node), edge};
    return {remaining * std::sqrt(square / measured) / static_cast<double>(enclosure_.bands), edge};
}

double IndirectRefiner::scatter(ZoneId zone) const {
    return mean_over_bands(enclosure_.media[medium_of(enclosure_, mesh_.forest(), zone)].albedo);
}

double IndirectRefiner::scatter(PatchId patch) const {
    return mean_over_bands(
        enclosure_.sides[side_of(enclosure_, mesh_.forest(), patch)].scattered());
}

template <class Node>
RefineResult IndirectRefiner::refine(std::vector<Node> frontier, IndirectSources sources,
                                     const Importance& importance, double goal,
                                     const RefineLimits& limits, const ProgressCallback& progress) {
    RefineResult result;
    const Forest& forest = mesh_.forest();
    Settled& settled = settled_of(Node());
    std::vector<Node> next, shown;
    double pieces = static_cast<double>(frontier.size());
    const auto share_of = [&](Node node, double error) {
        const double x = scatter(node) * error;
        return open_share(enclosure_, forest, node, 0) * importance.of(node) * x * x;
    };
    for (std::size_t round = 0; !frontier.empty(); ++round) {
        const double threshold = goal / pieces;
        result.rays += gather(frontier, sources, share_of, threshold);
        settled.resize(std::max(forest.zone_count(), forest.patch_count()));
        result.stopped =
            progress && !progress({"indirect light", 1.0 - double(frontier.size()) / pieces,
                                   mesh_.leaf_count(), 0.0});
        result.limited =
            limits.grow && (!room_for_more(limits) || mesh_.memory() > limits.max_memory ||
                            round == limits.max_rounds);
        const bool descend = !result.stopped && !result.limited;
        next.clear();
        for (const Node node : frontier) {
            const auto [error, edge] = measure(node);
            const double share = share_of(node, error);
            const double allowed = (ended_before(node) ? grown : 1.0) * threshold;
            if (descend && share > allowed && forest[node].longest_edge > limits.smallest_edge &&
                (!forest.is_leaf(node) || room_for_more(limits))) {
                if (forest.is_leaf(node)) bisect(node, edge);
                const Node first = forest[node].first_child;
                next.insert(next.end(), {first, Node(first.value + 1ull)});
                pieces += 1.0;
                continue;
            }
            settled.flags[node.value] = true;
            settled.errors[node.value] = static_cast<float>(error);
            settled.linear[node.value] = goal < no_goal && share <= linear_share * threshold;
            result.squared_error += share;
            // Where all of a patch's departure from linear has more than its share, its leaves are
            // bisected to show the quadratic: they need no gathers.
            if (descend && limits.grow && share > remaining * remaining * threshold)
                shown.push_back(node);
        }
        extend(forest, sources.fields);
        frontier.swap(next);
    }
    if constexpr (std::is_same_v<Node, PatchId>)
        if (!quadratic_) divide(shown, limits);
    return result;
}

RefineResult IndirectRefiner::refine_zones(IndirectSources sources, const Importance& importance,
                                           double goal, const RefineLimits& limits,
                                           const ProgressCallback& progress) {
    return refine(ancestors(mesh_.forest(), coarse_.member_zones()), std::move(sources), importance,
                  goal, limits, progress);
}

RefineResult IndirectRefiner::refine_patches(IndirectSources sources, const Importance& importance,
                                             double goal, const RefineLimits& limits,
                                             const ProgressCallback& progress) {
    return refine(coarse_.member_patches(), std::move(sources), importance, goal, limits, progress);
}

bool IndirectRefiner::room_for_more(const RefineLimits& limits) const {
    return limits.grow && mesh_.leaf_count() < limits.max_elements;
}

// Patches are seen as they are: a quadratic that one leaf holds is given the leaves that show it.
void IndirectRefiner::divide(const std::vector<PatchId>& patches, const RefineLimits& limits) {
    const Forest& forest = mesh_.forest();
    for (const PatchId patch : patches) {
        if (!room_for_more(limits)) break;
        if (forest.is_leaf(patch)) mesh_.bisect(patch);
        const PatchId first = forest[patch].first_child;
        for (const PatchId child : {first, PatchId(first.value + 1ull)})
            if (forest.is_leaf(child)) mesh_.bisect(child);
    }
}

template <class Node>
Node IndirectRefiner::settled_above(Node node) const {
    const std::vector<bool>& flags = settled_of(node).flags;
    while (!is_set(flags, node.value)) node = mesh_.forest()[node].parent;
    return node;
}

template <class Node>
auto IndirectRefiner::quadratic(Node node, std::size_t band, SampleValue value) {
    const auto samples = mesh_.corners(node);
    constexpr std::size_t count = std::tuple_size_v<decltype(samples)>;
    const auto value_at = [&](SampleId id) { return (mesh_.samples().*value)(id, band); };
    Quadratic<count> q;
    std::size_t edge = 0;
    for (std::size_t i = 0; i < count; ++i) {
        q.points[i] = mesh_.forest().point(mesh_.forest()[node].corners[i]);
        q.at_corners[i] = value_at(samples[i]);
        for (std::size_t j = i + 1; j < count; ++j) {
            const SampleId middle = mesh_.middle(node, i, j);
            q.at_middles[edge++] = mesh_.samples().gathered(middle)
                                       ? value_at(middle)
                                       : 0.5 * (value_at(samples[i]) + value_at(samples[j]));
        }
    }
    return q;
}

template <class Node>
Affine IndirectRefiner::linear_part(Node leaf, std::size_t band) {
    const Forest& forest = mesh_.forest();
    constexpr bool is_zone = std::is_same_v<Node, ZoneId>;
    const Node node = settled_above(leaf);
    const auto q = quadratic(node, band, &SampleSet::indirect);
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

double IndirectRefiner::error(PatchId leaf) const {
    const PatchId settled = settled_above(leaf);
    const double error = patches_.errors[settled.value];
    return settled == leaf && !quadratic_ ? error / remaining : error;
}

LeafFunction IndirectRefiner::function(PatchId leaf, std::size_t band) {
    if (!quadratic_) return {field(leaf, band), {}};
    const Forest& forest = mesh_.forest();
    const auto q = quadratic(settled_above(leaf), band, &SampleSet::indirect);
    std::array<Point, 3> points;
    std::array<double, 3> values, departures;
    for (std::size_t k = 0; k < 3; ++k) {
        points[k] = forest.point(forest[leaf].corners[k]);
        values[k] = std::max(0.0, q.at(points[k]));
    }
    std::size_t edge = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i + 1; j < 3; ++j)
            departures[edge++] =
                std::max(0.0, q.at(0.5 * (points[i] + points[j]))) - 0.5 * (values[i] + values[j]);
    return interpolate(points, values, departures);
}

// Noise has either sign and no mean to be kept: the quadratic's values at the leaf's corners will
// do on a patch; a zone's noise is what its mean has.
template <class Node>
Affine IndirectRefiner::noise_part(Node leaf, std::size_t band) {
    const Forest& forest = mesh_.forest();
    const auto q = quadratic(settled_above(leaf), band, &SampleSet::half_difference);
    constexpr std::size_t count = std::tuple_size_v<decltype(q.points)>;
    std::array<Point, count> points;
    std::array<double, count> values;
    for (std::size_t k = 0; k < count; ++k) {
        points[k] = forest.point(forest[leaf].corners[k]);
        values[k] = q.at(points[k]);
    }
    Affine f = interpolate(points, values);
    if constexpr (std::is_same_v<Node, ZoneId>) {
        double mean = 0.8 * q.at(forest.centroid(leaf));
        for (const double value : values) mean += 0.05 * value;
        f.constant += mean - f.at(forest.centroid(leaf));
    }
    return f;
}

Affine IndirectRefiner::noise(ZoneId zone, std::size_t band) {
    return noise_part(zone, band);
}

Affine IndirectRefiner::noise(PatchId patch, std::size_t band) {
    return noise_part(patch, band);
}

Affine IndirectRefiner::field(ZoneId zone, std::size_t band) {
    return linear_part(zone, band);
}

Affine IndirectRefiner::field(PatchId patch, std::size_t band) {
    return linear_part(patch, band);
}

template ZoneId IndirectRefiner::settled_above(ZoneId) const;
template PatchId IndirectRefiner::settled_above(PatchId) const;

}  // namespace tyndall::radiosity
