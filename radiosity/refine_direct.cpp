#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "radiosity/open_places.h"
#include "radiosity/quadratic.h"
#include "radiosity/refine.h"

namespace tyndall::radiosity {
namespace {

// Pictures compute direct light on surfaces anew where it matters (render/line_of_sight.h), so that
// what patches hold counts for less than what zones hold: for what they reflect.
constexpr double seen_patch_share = 0.03;

// Of departures from linear.
class RootMeanSquare {
  public:
    double add(double departure) {
        square_ += departure * departure;
        ++count_;
        return departure;
    }
    double value() const { return std::sqrt(square_ / count_); }

  private:
    double square_ = 0.0, count_ = 0.0;
};

// A tet's edge is bisected where the error is largest, so that meshes stretch along shafts, but
// never one much shorter than the longest, so that slivers do not run away.
constexpr double shortest_bisected = 0.35;

// Of what a linear function leaves: measured, window_shafts and sun_louvres.
constexpr double left_by_quadratic = 0.6;

// Of an element's error: a jump that makes up less is not what it has to be cut for.
constexpr double least_jump = 0.3;

// Of the mean share at the goal: what a leaf may keep at first, and how that is lowered while the
// sum is too large.
constexpr double first_evenness = 16.0, less_even = 0.7;

// Of the power of direct light: a leaf whose error may be worth more has its mean sampled. Those
// below are many and of either sign.
constexpr double felt_power = 1e-5;
// The same of zones, which are given the function that fits best, too: a sum over many.
constexpr double felt_by_zones = 1e-7;

}  // namespace

double share_of_ends(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    constexpr double seen_through = 0.25;
    const double thickness =
        rough_extinction(enclosure, forest, zone) * forest[zone].longest_edge / seen_through;
    return std::min(1.0, thickness * thickness);
}

DirectRefiner::DirectRefiner(const Enclosure& enclosure, ElementMesh& mesh,
                             const DirectLight& light, const ShadowBoundaries* boundaries,
                             Radiance radiance)
    : enclosure_(enclosure),
      mesh_(mesh),
      light_(light),
      sampled_(enclosure, mesh.forest(), light, radiance == Radiance::quadratic),
      left_(radiance == Radiance::quadratic ? left_by_quadratic : 1.0),
      bands_(enclosure.bands) {
    if (boundaries) cuts_.emplace(enclosure, *boundaries, mesh, light);
}

template <class Node>
void DirectRefiner::measure(Node node, std::vector<float>& errors, std::vector<std::uint8_t>& edges,
                            const std::vector<double>& centroid) {
    const Forest& forest = mesh_.forest();
    const SampleSet& samples = mesh_.samples();
    const auto corner = mesh_.lit_corners(node);
    const int count = static_cast<int>(corner.size());
    const auto& vertices = forest[node].corners;
    const auto longest = forest.longest_edge(node);
    std::array<int, 2> split = longest;
    double worst_edge = 0.0, at_centroid = 0.0;
    RootMeanSquare departures;
    for (std::size_t b = 0; b < bands_; ++b) {
        double mean = 0.0;
        for (const SampleId id : corner) mean += samples.direct(id, b) / count;
        at_centroid += std::abs(departures.add(centroid[node.value * bands_ + b] - mean));
    }
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            const SampleId middle = mesh_.lit_middle(node, i, j);
            double error = 0.0;
            for (std::size_t b = 0; b < bands_; ++b)
                error += std::abs(departures.add(
                    samples.direct(middle, b) -
                    0.5 * (samples.direct(corner[i], b) + samples.direct(corner[j], b))));
            const double length =
                glm::distance(forest.point(vertices[i]), forest.point(vertices[j]));
            if (error > worst_edge && length > shortest_bisected * forest[node].longest_edge) {
                worst_edge = error;
                split = {i, j};
            }
        }
    if (at_centroid > 2.0 * worst_edge) split = longest;
    constexpr bool is_zone = std::is_same_v<Node, ZoneId>;
    if constexpr (is_zone) {
        const double seen =
            std::lerp(fitted_chord_share, chord_share, share_of_ends(enclosure_, forest, node));
        errors[node.value] = static_cast<float>(left_ * seen * left_by_linear(node, centroid));
    } else {
        errors[node.value] = static_cast<float>(departures.value());
    }
    edges[node.value] = static_cast<std::uint8_t>(4 * split[0] + split[1]);
}

double DirectRefiner::left_by_linear(ZoneId zone, const std::vector<double>& centroid) {
    const auto corner = mesh_.lit_corners(zone);
    std::array<SampleId, 6> middle;
    for (int i = 0, e = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) middle[e++] = mesh_.lit_middle(zone, i, j);
    double sum = 0.0;
    for (std::size_t b = 0; b < bands_; ++b) {
        const auto value = [&](SampleId id) { return mesh_.samples().direct(id, b); };
        std::array<double, 4> at_corners;
        std::array<double, 6> at_middles;
        std::ranges::transform(corner, at_corners.begin(), value);
        std::ranges::transform(middle, at_middles.begin(), value);
        sum += squares_left(at_corners, at_middles, centroid[zone.value * bands_ + b]);
    }
    return std::sqrt(sum / (7.0 * static_cast<double>(bands_)));
}

void DirectRefiner::update() {
    const Forest& forest = mesh_.forest();
    std::vector<ZoneId> zones;
    std::vector<PatchId> patches;
    for (; zones_done_ < mesh_.zones().size(); ++zones_done_)
        if (const ZoneId z = mesh_.zones()[zones_done_]; forest.is_leaf(z)) zones.push_back(z);
    for (; patches_done_ < mesh_.patches().size(); ++patches_done_)
        if (const PatchId p = mesh_.patches()[patches_done_]; forest.is_leaf(p))
            patches.push_back(p);
    if (cuts_) cuts_->update(zones, patches);
    make_samples(zones, patches);
    mesh_.samples().light(light_);

    zone_error_.resize(forest.zone_count());
    zone_edge_.resize(forest.zone_count());
    zone_centroid_.resize(forest.zone_count() * bands_);
    patch_error_.resize(forest.patch_count());
    patch_edge_.resize(forest.patch_count());
    patch_centroid_.resize(forest.patch_count() * bands_);
    tbb::parallel_for(std::size_t(0), zones.size(), [&](std::size_t k) {
        const ZoneId z = zones[k];
        const OpenPlace place = open_place(enclosure_, forest.centroid(z), forest.base_tet(z));
        light_.at_zone(place.x, place.tet, {zone_centroid_.data() + z.value * bands_, bands_});
    });
    tbb::parallel_for(std::size_t(0), patches.size(), [&](std::size_t k) {
        const PatchId p = patches[k];
        const Point centroid = forest.centroid(p);
        light_.at_patch(centroid, normal_of(forest, p),
                        mesh::tet_before(enclosure_.mesh, forest.base_facet_side(p), centroid),
                        {patch_centroid_.data() + p.value * bands_, bands_});
    });
    for (const ZoneId z : zones) measure(z, zone_error_, zone_edge_, zone_centroid_);
    for (const PatchId p : patches) measure(p, patch_error_, patch_edge_, patch_centroid_);
}

// The squared error that remains, and the elements that share in it.
double DirectRefiner::collect(const Importance& importance, const RefineLimits& limits,
                              const Asked& asked, std::vector<Candidate>& candidates) const {
    const Forest& forest = mesh_.forest();
    const IndicatedErrors more = asked.more ? asked.more() : IndicatedErrors{};
    candidates.clear();
    double sum = 0.0;
    const auto add = [&](auto node, double departure, double jump, double scatter, double weight) {
        constexpr bool is_zone = std::is_same_v<decltype(node), ZoneId>;
        const double error = asked.direct ? departure : 0.0;
        const double worst = std::max(error, jump);
        double share = weight * scatter * scatter * worst * worst;
        bool longest_edge = false;
        if (asked.more) {
            const double other = is_zone ? more.zone[node.value] : more.patch[node.value];
            const double other_share = importance.of(node) * other * other;
            longest_edge = other_share > share;
            share = std::max(share, other_share);
        }
        if (share == 0.0) return;
        sum += share;
        if (forest[node].longest_edge > limits.smallest_edge)
            candidates.push_back({share, node.value, is_zone,
                                  !longest_edge && jump > least_jump * worst, longest_edge});
    };
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) {
            const auto& optics = enclosure_.media[medium_of(enclosure_, forest, z)];
            const double open = open_share(enclosure_, forest, z, 0);
            add(z, zone_error_[z.value], cuts_ ? cuts_->error(z) : 0.0,
                mean_over_bands(optics.albedo), open * importance.of(z));
        }
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) {
            const auto& side = enclosure_.sides[side_of(enclosure_, forest, p)];
            add(p, patch_error_[p.value], cuts_ ? cuts_->error(p) : 0.0,
                mean_over_bands(side.scattered()), seen_patch_share * importance.of(p));
        }
    return sum;
}

void DirectRefiner::bisect(const Candidate& candidate, std::size_t max_leaves) {
    if (candidate.is_zone) {
        const ZoneId zone(candidate.index);
        if (candidate.to_cut && cuts_->cut(zone, max_leaves)) return;
        const auto edge = zone_edge_[zone.value];
        mesh_.bisect(zone, candidate.longest_edge ? mesh_.forest().longest_edge(zone)
                                                  : std::array<int, 2>{edge / 4, edge % 4});
    } else if (const PatchId patch(candidate.index); mesh_.forest().is_leaf(patch)) {
        if (candidate.to_cut && cuts_->cut(patch, max_leaves)) return;
        mesh_.bisect(patch);
    }
}

// Equidistribution: every leaf may keep the same share, the largest for which the sum meets the
// goal. To stop as soon as the sum does would leave some leaves with many times what others have:
// the same error takes more of them (docs/studies/shafts.md). Whether any is to be bisected.
bool DirectRefiner::keep_worst(std::vector<Candidate>& candidates, double& evenness, double sum,
                               double goal) const {
    const double mean = goal / static_cast<double>(mesh_.leaf_count());
    for (;; evenness *= less_even) {
        const auto end =
            std::partition(candidates.begin(), candidates.end(),
                           [&](const Candidate& c) { return c.share > evenness * mean; });
        if (end != candidates.begin() || sum <= goal || candidates.empty()) {
            candidates.erase(end, candidates.end());
            return !candidates.empty();
        }
    }
}

RefineResult DirectRefiner::refine(const Importance& importance, double goal,
                                   const RefineLimits& limits, const ProgressCallback& progress,
                                   const Asked& asked) {
    RefineResult result;
    std::vector<Candidate> candidates;
    double first = 0.0, evenness = first_evenness;
    for (std::size_t round = 0;; ++round) {
        update();
        result.squared_error = collect(importance, limits, asked, candidates);
        if (first == 0.0)
            first = result.squared_error;
        else if (asked.bisected)
            asked.bisected();
        const double gone = first > goal && result.squared_error > 0.0
                                ? std::log(first / result.squared_error) / std::log(first / goal)
                                : 1.0;
        if (progress &&
            !progress({"direct light", std::clamp(gone, 0.0, 1.0), mesh_.leaf_count(), 0.0})) {
            result.stopped = true;
            return result;
        }
        if (!keep_worst(candidates, evenness, result.squared_error, goal)) return result;
        const std::size_t memory = mesh_.memory() + (cuts_ ? cuts_->memory() : 0);
        if (mesh_.leaf_count() >= limits.max_elements || memory > limits.max_memory ||
            round == limits.max_rounds) {
            result.limited = result.squared_error > goal;
            return result;
        }
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return a.share != b.share
                       ? a.share > b.share
                       : std::pair(a.is_zone, a.index) < std::pair(b.is_zone, b.index);
        });
        for (const Candidate& c : candidates) {
            if (mesh_.leaf_count() >= limits.max_elements) break;
            bisect(c, limits.max_elements);
        }
    }
}

void DirectRefiner::sample_means() {
    const Forest& forest = mesh_.forest();
    const auto capacity_of_zone = [&](ZoneId z) {
        return 4.0 * rough_extinction(enclosure_, forest, z) * forest.volume(z);
    };
    double power = 0.0;  // of direct light on all leaves, over π
    for (std::size_t b = 0; b < bands_; ++b) {
        const double share = 1.0 / static_cast<double>(bands_);
        for (const ZoneId z : mesh_.zones())
            if (forest.is_leaf(z)) power += share * capacity_of_zone(z) * mean(z, b);
        for (const PatchId p : mesh_.patches())
            if (forest.is_leaf(p)) power += share * forest.area(p) * mean(p, b);
    }
    std::vector<ZoneId> zones;
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z) && capacity_of_zone(z) * worst_error(z) > felt_by_zones * power)
            zones.push_back(z);
    std::vector<PatchId> patches;
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p) && forest.area(p) * worst_error(p) > felt_power * power)
            patches.push_back(p);
    sampled_.add(zones);
    sampled_.add(patches);
}

double DirectRefiner::mean(ZoneId zone, std::size_t band) {
    if (const double* sampled = sampled_.of(zone)) return sampled[band];
    double sum = 0.0;
    for (const SampleId id : mesh_.lit_corners(zone)) sum += mesh_.samples().direct(id, band);
    return 0.05 * sum + 0.8 * zone_centroid_[zone.value * bands_ + band];
}

double DirectRefiner::mean(PatchId patch, std::size_t band) {
    if (const double* sampled = sampled_.of(patch)) return sampled[band];
    double sum = 0.0;
    for (const SampleId id : mesh_.lit_corners(patch)) sum += mesh_.samples().direct(id, band);
    return sum / 12.0 + 0.75 * patch_centroid_[patch.value * bands_ + band];
}

void DirectRefiner::light_middles() {
    make_samples(mesh_.zones(), mesh_.patches());
    mesh_.samples().light(light_);
}

// Samples at corners and middles of the given nodes that are leaves, and at the corners of all
// leaves. A middle may be marked when it is made, and is then another sample of other leaves that
// have it as a corner or middle: until nothing is new.
void DirectRefiner::make_samples(const std::vector<ZoneId>& zones,
                                 const std::vector<PatchId>& patches) {
    const Forest& forest = mesh_.forest();
    std::size_t before;
    do {
        before = mesh_.samples().size();
        for (const ZoneId z : zones) {
            if (!forest.is_leaf(z)) continue;
            mesh_.lit_corners(z);
            for (int i = 0; i < 4; ++i)
                for (int j = i + 1; j < 4; ++j) mesh_.lit_middle(z, i, j);
        }
        for (const PatchId p : patches) {
            if (!forest.is_leaf(p)) continue;
            mesh_.lit_corners(p);
            for (int i = 0; i < 3; ++i)
                for (int j = i + 1; j < 3; ++j) mesh_.lit_middle(p, i, j);
        }
        if (!cuts_) return;
        for (const ZoneId z : mesh_.zones())
            if (forest.is_leaf(z)) mesh_.lit_corners(z);
        for (const PatchId p : mesh_.patches())
            if (forest.is_leaf(p)) mesh_.lit_corners(p);
    } while (mesh_.samples().size() > before);
}

double DirectRefiner::mean_difference(ZoneId zone, std::size_t band) {
    double corners = 0.0, middles = 0.0;
    for (const SampleId id : mesh_.lit_corners(zone)) corners += mesh_.samples().direct(id, band);
    for (int i = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j)
            middles += mesh_.samples().direct(mesh_.lit_middle(zone, i, j), band);
    return mean(zone, band) - (0.2 * middles - 0.05 * corners);
}

double DirectRefiner::mean_difference(PatchId patch, std::size_t band) {
    double middles = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j)
            middles += mesh_.samples().direct(mesh_.lit_middle(patch, i, j), band);
    return mean(patch, band) - middles / 3.0;
}

}  // namespace tyndall::radiosity
