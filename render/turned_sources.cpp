#include "render/turned_sources.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>

#include "mesh/body.h"

namespace tyndall::render {

using mesh::PatchId;
using mesh::TetId;
using mesh::ZoneId;
using radiosity::Affine;
using radiosity::none;
using std::numbers::pi;

namespace {

// Parts of lights within which Φ is taken at the middle [rad]. What zones send to each other is
// seen from afar, and through cubes.
constexpr double widest_gathered_part = 0.3;
constexpr std::size_t lit_leaves = 400;  // that speak for all

}  // namespace

radiosity::Enclosure with_whole_extinction(const radiosity::Enclosure& reduced) {
    radiosity::Enclosure e = reduced;
    for (auto& medium : e.media)
        for (std::size_t b = 0; b < e.bands; ++b) {
            if (medium.scattering.empty() || !(medium.extinction[b] > 0.0)) continue;
            const double whole = medium.absorption[b] + medium.scattering[b];
            if (!medium.varying.empty()) medium.varying[b].factor *= whole / medium.extinction[b];
            medium.extinction[b] = whole;
        }
    return e;
}

double emission_of_whole(const radiosity::Solution& solution, const radiosity::Enclosure& whole,
                         ZoneId leaf, std::uint32_t medium, std::size_t band) {
    const double extinction = whole.media[medium].extinction[band];
    if (!(extinction > 0.0)) return 0.0;
    return radiosity::emission_of(solution, leaf, band) *
           solution.enclosure->media[medium].extinction[band] / extinction;
}

// Of one leaf, before they are joined: directions, and shares of the bands.
struct TurnedSources::LeafParts {
    struct Seen {
        std::vector<Direction> towards;
        std::vector<double> shares;
    };
    std::array<Seen, 2> by;  // Coefficients
};

TurnedSources::TurnedSources(const radiosity::Solution& solution, const radiosity::Enclosure& whole,
                             const PathMedia& media)
    : s_(solution),
      e_(*solution.enclosure),
      whole_(whole),
      media_(media),
      bands_(e_.bands),
      direct_(solution.direct),
      indirect_(solution.indirect) {
    for (std::size_t z = 0; z < s_.forest.zone_count(); ++z) {
        const TetId tet = s_.forest.base_tet(ZoneId(z));
        if (!e_.solid(tet) && e_.medium_of(tet) != none) zones_.push_back(ZoneId(z));
    }
    radiosity::coarsen(s_.forest, direct_);
    radiosity::coarsen(s_.forest, indirect_);
    const bool closed = s_.direct_light == radiosity::DirectLightMode::closed_form;
    const radiosity::DirectLight whole_light(whole_, {.emitters = closed}),
        reduced_light(e_, {.emitters = closed});
    look_from_leaves(whole_light, reduced_light);
    look_from_patches(whole_light, reduced_light);
    weigh_nodes();
    choose_lit();
}

void TurnedSources::choose_lit() {
    for (const ZoneId zone : zones_)
        if (s_.forest.is_leaf(zone) && parts_[0][zone.value].begin < parts_[0][zone.value].end)
            lit_.push_back({zone, 0.0});
    const std::size_t step = std::max<std::size_t>(1, lit_.size() / lit_leaves);
    double sum = 0.0;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < lit_.size(); k += step) {
        Lit& lit = lit_[kept++] = lit_[k];
        const std::uint32_t medium = medium_of(lit.leaf);
        for (std::size_t b = 0; b < bands_; ++b)
            lit.weight += whole_.media[medium].extinction[b] * media_.albedo(medium, b) *
                          std::max(0.0, direct_.at(lit.leaf, b).at(s_.forest.centroid(lit.leaf)));
        lit.weight *= s_.forest.volume(lit.leaf);
        sum += lit.weight;
    }
    lit_.resize(sum > 0.0 ? kept : 0);
    for (Lit& lit : lit_) lit.weight /= sum;
}

double TurnedSources::brightness(Direction ray) const {
    if (lit_.empty()) return 1.0;
    double sum = 0.0;
    for (const auto& [leaf, weight] : lit_) {
        double turned = 0.0, even = 0.0;
        for (std::size_t b = 0; b < bands_; ++b) {
            turned += direct(leaf, b, ray, Coefficients::reduced);
            even += media_.albedo(medium_of(leaf), b);
        }
        if (even > 0.0) sum += weight * turned / even;
    }
    return sum;
}

std::uint32_t TurnedSources::medium_of(ZoneId zone) const {
    return e_.medium_of(s_.forest.base_tet(zone));
}

// Where the centroid is in the dark, a place nearer to a corner may see what lights the leaf.
TurnedSources::LeafParts TurnedSources::parts_at(ZoneId leaf, const radiosity::DirectLight& whole,
                                                 const radiosity::DirectLight& reduced) const {
    const TetId tet = s_.forest.base_tet(leaf);
    const Point middle = s_.forest.centroid(leaf);
    LeafParts result;
    std::vector<double> sum(bands_);
    for (int place = 0; place < 5; ++place) {
        const Point corner =
            place == 0 ? middle : s_.forest.point(s_.forest[leaf].corners[place - 1]);
        const Point x = middle + 0.8 * (corner - middle);
        for (const auto by : {Coefficients::reduced, Coefficients::whole}) {
            auto& seen = result.by[std::size_t(by)];
            const auto& light = by == Coefficients::whole ? whole : reduced;
            light.visit_zone(x, tet, widest_gathered_part,
                             [&](Direction towards, std::span<const double> irradiance) {
                                 seen.towards.push_back(towards);
                                 for (std::size_t b = 0; b < bands_; ++b) {
                                     seen.shares.push_back(irradiance[b]);
                                     if (by == Coefficients::reduced) sum[b] += irradiance[b];
                                 }
                             });
        }
        if (std::ranges::any_of(sum, [](double v) { return v > 0.0; })) break;
        result = {};
    }
    for (auto& seen : result.by)
        for (std::size_t k = 0; k < seen.shares.size(); ++k)
            seen.shares[k] = sum[k % bands_] > 0.0 ? seen.shares[k] / sum[k % bands_] : 0.0;
    return result;
}

void TurnedSources::look_from_leaves(const radiosity::DirectLight& whole,
                                     const radiosity::DirectLight& reduced) {
    std::vector<ZoneId> lit;
    for (const ZoneId zone : zones_) {
        if (!s_.forest.is_leaf(zone) || e_.media[medium_of(zone)].phase.isotropic()) continue;
        const auto corners = s_.forest[zone].corners;
        for (std::size_t b = 0; b < bands_; ++b)
            if (std::ranges::any_of(corners, [&](mesh::VertexId v) {
                    return direct_.at(zone, b).at(s_.forest.point(v)) > 0.0;
                })) {
                lit.push_back(zone);
                break;
            }
    }
    std::vector<LeafParts> found(lit.size());
    tbb::parallel_for(std::size_t(0), lit.size(),
                      [&](std::size_t k) { found[k] = parts_at(lit[k], whole, reduced); });
    for (auto& parts : parts_) parts.resize(s_.forest.zone_count());
    for (std::size_t k = 0; k < lit.size(); ++k)
        for (std::size_t by = 0; by < 2; ++by) {
            const auto& seen = found[k].by[by];
            Parts& parts = parts_[by][lit[k].value];
            parts.begin = std::uint32_t(all_parts_.size());
            for (std::size_t n = 0; n < seen.towards.size(); ++n) {
                const Direction& t = seen.towards[n];
                all_parts_.push_back(
                    {{float(t.x), float(t.y), float(t.z)}, std::uint32_t(shares_.size())});
                for (std::size_t b = 0; b < bands_; ++b)
                    shares_.push_back(float(seen.shares[n * bands_ + b]));
            }
            parts.end = std::uint32_t(all_parts_.size());
        }
}

void TurnedSources::look_from_patches(const radiosity::DirectLight& whole,
                                      const radiosity::DirectLight& reduced) {
    patch_kept_.assign(s_.forest.patch_count() * bands_, 1.0);
    tbb::parallel_for(std::size_t(0), s_.forest.patch_count(), [&](std::size_t p) {
        const PatchId patch(p);
        if (!s_.forest.is_leaf(patch) || radiosity::side_of(e_, s_.forest, patch) == none) return;
        const Direction n = radiosity::normal_of(s_.forest, patch);
        const Point x = s_.forest.centroid(patch);
        const TetId tet = mesh::start_before(e_.mesh, s_.forest.base_facet_side(patch), x).tet;
        std::vector<double> by_whole(bands_), by_reduced(bands_);
        whole.at_patch(x, n, tet, by_whole);
        reduced.at_patch(x, n, tet, by_reduced);
        for (std::size_t b = 0; b < bands_; ++b)
            if (by_reduced[b] > 0.0) patch_kept_[p * bands_ + b] = by_whole[b] / by_reduced[b];
    });
}

// How much of the direct and of the indirect light of its parent a node has.
void TurnedSources::weigh_nodes() {
    const std::size_t count = s_.forest.zone_count() * bands_;
    emission_.assign(count, 0.0f);
    of_direct_.assign(count, 0.0f);
    of_indirect_.assign(count, 0.0f);
    const auto weigh = [&](const radiosity::Fields& light, std::vector<float>& share, ZoneId first,
                           std::size_t b) {
        double weight[2];
        for (const std::size_t k : {0u, 1u}) {
            const ZoneId child(first.value + k);
            weight[k] = s_.forest.volume(child) *
                        std::max(0.0, light.at(child, b).at(s_.forest.centroid(child)));
        }
        const double sum = weight[0] + weight[1];
        for (const std::size_t k : {0u, 1u})
            share[(first.value + k) * bands_ + b] = float(sum > 0.0 ? weight[k] / sum : 0.5);
    };
    for (auto zone = zones_.rbegin(); zone != zones_.rend(); ++zone)
        for (std::size_t b = 0; b < bands_; ++b) {
            float& emission = emission_[zone->value * bands_ + b];
            const ZoneId first = s_.forest[*zone].first_child;
            if (!first.valid()) {
                emission = float(emission_of_whole(s_, whole_, *zone, medium_of(*zone), b));
                continue;
            }
            weigh(direct_, of_direct_, first, b);
            weigh(indirect_, of_indirect_, first, b);
            const double volume = s_.forest.volume(*zone);
            for (const std::size_t k : {0u, 1u}) {
                const double part = s_.forest.volume(ZoneId(first.value + k)) / volume;
                emission += float(part) * emission_[(first.value + k) * bands_ + b];
            }
        }
}

double TurnedSources::direct(ZoneId leaf, std::size_t band, Direction ray,
                             Coefficients on_way) const {
    const std::uint32_t medium = medium_of(leaf);
    if (e_.media[medium].phase.isotropic()) return media_.albedo(medium, band);
    const Parts& parts = parts_[std::size_t(on_way)][leaf.value];
    if (parts.begin == parts.end) return media_.albedo(medium, band);
    double sum = 0.0;
    for (std::uint32_t k = parts.begin; k < parts.end; ++k) {
        const LightPart& part = all_parts_[k];
        const double cosine = ray.x * double(part.towards[0]) + ray.y * double(part.towards[1]) +
                              ray.z * double(part.towards[2]);
        sum += media_.scattered(medium, band, cosine) * double(shares_[part.first + band]);
    }
    return 4.0 * pi * sum;  // (61)
}

void TurnedSources::fill(Direction ray, Coefficients on_way, std::vector<float>& indirect,
                         radiosity::GatherScene& scene) const {
    thread_local std::vector<float> direct_shares;
    direct_shares.resize(indirect.size());
    const auto mean = [&](const std::vector<float>& of, const std::vector<float>& shares,
                          std::size_t child, std::size_t b) {
        return of[child * bands_ + b] * shares[child * bands_ + b] +
               of[(child + 1) * bands_ + b] * shares[(child + 1) * bands_ + b];
    };
    for (auto zone = zones_.rbegin(); zone != zones_.rend(); ++zone) {
        const ZoneId first = s_.forest[*zone].first_child;
        for (std::size_t b = 0; b < bands_; ++b) {
            const std::size_t at = zone->value * bands_ + b;
            if (first.valid()) {
                direct_shares[at] = mean(of_direct_, direct_shares, first.value, b);
                indirect[at] = mean(of_indirect_, indirect, first.value, b);
            } else {
                direct_shares[at] = float(direct(*zone, b, ray, on_way));
            }
            const Affine &a = direct_.at(*zone, b), &i = indirect_.at(*zone, b);
            const double s_a = double(direct_shares[at]), s_i = double(indirect[at]);
            scene.set_source(
                *zone, b,
                {s_a * a.gradient + s_i * i.gradient,
                 double(emission_[at]) + s_a * a.constant + s_i * i.constant});  // (61)
        }
    }
}

}  // namespace tyndall::render
