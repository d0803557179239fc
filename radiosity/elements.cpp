#include "radiosity/elements.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "mesh/input_error.h"
#include "radiosity/leaves_in_order.h"
#include "radiosity/open_places.h"

namespace tyndall::radiosity {

std::uint32_t side_of(const Enclosure& enclosure, const Forest& forest, PatchId patch) {
    const std::uint32_t facet_side = forest.base_facet_side(patch);
    return enclosure.facet_sides[facet_side / 2][facet_side % 2];
}

std::uint32_t medium_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    const TetId tet = forest.base_tet(zone);
    return enclosure.solid(tet) ? none : enclosure.medium_of(tet);
}

std::string name_of(const Enclosure& enclosure, const Forest& forest, const Elements& elements,
                    ElementId element) {
    if (element.value == elements.outside()) return "outside";
    if (elements.is_patch(element.value))
        return enclosure.sides[side_of(enclosure, forest, elements.patches[element.value])].name;
    return enclosure.media[medium_of(enclosure, forest, elements.zone(element.value))].name;
}

namespace {

std::array<Point, 4> corners_of(const Forest& forest, ZoneId zone) {
    std::array<Point, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = forest.point(forest[zone].corners[k]);
    return corners;
}

}  // namespace

TetExtinction extinction_in(const Enclosure& enclosure, const Forest& forest, ZoneId zone,
                            std::size_t band) {
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, zone)];
    if (optics.varying.empty()) return {optics.extinction[band], forest.centroid(zone)};
    return over_tet(optics.varying[band], corners_of(forest, zone));
}

double rough_extinction(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, zone)];
    const bool uniform = optics.varying.empty();
    double sum = 0.0;
    for (std::size_t b = 0; b < enclosure.bands; ++b)
        sum += uniform ? optics.extinction[b]
                       : rough_mean(optics.varying[b], corners_of(forest, zone));
    return sum / static_cast<double>(enclosure.bands);
}

Point centre_of(const Enclosure&, const Forest& forest, PatchId patch) {
    return forest.centroid(patch);
}

Point centre_of(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, zone)];
    if (optics.varying.empty()) return forest.centroid(zone);
    const auto& bands = optics.varying;
    Point sum(0.0);
    double amount = 0.0;
    for (std::size_t b = 0; b < bands.size(); ++b) {
        if (b > 0 && bands[b] == bands[0]) continue;
        const TetExtinction here = over_tet(bands[b], corners_of(forest, zone));
        sum += here.mean * here.centre;
        amount += here.mean;
    }
    return amount > 0.0 ? sum / amount : forest.centroid(zone);
}

std::size_t first_of_extinction(const Enclosure& enclosure, std::size_t band) {
    std::size_t first = 0;
    while (!std::ranges::all_of(enclosure.media, [&](const MediumOptics& m) {
        return m.extinction[first] == m.extinction[band] &&
               (m.varying.empty() || m.varying[first] == m.varying[band]);
    }) || !std::ranges::all_of(enclosure.sides, [&](const SurfaceSide& side) {
        return side.mirrored(first) == side.mirrored(band);
    }))
        ++first;
    return first;
}

Direction normal_of(const Forest& forest, PatchId patch) {
    const auto& c = forest[patch].corners;
    const Point a = forest.point(c[0]);
    return glm::normalize(glm::cross(forest.point(c[1]) - a, forest.point(c[2]) - a));
}

namespace {

void append_optics(Elements& e, double measure, const Spectrum* extinction, const Spectrum& scatter,
                   const Spectrum& emission) {
    for (std::size_t b = 0; b < e.bands; ++b) {
        e.capacity.push_back(extinction ? 4.0 * (*extinction)[b] * measure : measure);
        e.scatter.push_back(scatter[b]);
        e.emission.push_back(emission[b]);
    }
}

// Adds an element whose first member, area and side are given. Of a mirror: the part of it that
// walks do not go on at (63).
void append(Elements& e, const SurfaceSide& side, PatchId patch, double area) {
    e.patches.push_back(patch);
    if (side.mirror.empty())
        return append_optics(e, area, nullptr, side.reflectance, side.emission);
    e.mirrored.resize((e.patches.size() - 1) * e.bands, 0.0);
    for (std::size_t b = 0; b < e.bands; ++b) {
        const double seen = 1.0 - side.mirror[b];
        e.mirrored.push_back(side.mirror[b]);
        e.capacity.push_back(seen * area);
        e.scatter.push_back(std::min(1.0, side.scattered(b) / seen));
        e.emission.push_back(side.emission[b] / seen);
    }
}

// `extinction`: its mean over the element.
void append(Elements& e, const MediumOptics& medium, ZoneId zone, const Spectrum& extinction,
            double volume) {
    e.zones.push_back(zone);
    append_optics(e, volume, &extinction, medium.albedo, medium.emission);
}

// The mean of kappa_t over zones of one medium.
Spectrum mean_extinction(const Enclosure& enclosure, const Forest& forest,
                         std::span<const std::uint32_t> zones) {
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, ZoneId(zones[0]))];
    if (optics.varying.empty()) return optics.extinction;
    Spectrum mean(enclosure.bands, 0.0);
    double volume = 0.0;
    for (const auto zone : zones) {
        const double size = forest.volume(ZoneId(zone));
        for (std::size_t b = 0; b < mean.size(); ++b)
            mean[b] += size * extinction_in(enclosure, forest, ZoneId(zone), b).mean;
        volume += size;
    }
    for (std::size_t b = 0; b < mean.size(); ++b)
        mean[b] = std::max(mean[b] / volume, least_density * optics.extinction[b]);
    return mean;
}

Elements without_elements(const Enclosure& enclosure, const Forest& forest) {
    Elements e;
    e.bands = enclosure.bands;
    e.of_patch.assign(forest.patch_count(), none);
    e.of_zone.assign(forest.zone_count(), none);
    return e;
}

// The share of an element that counts [-].
template <class Node>
double open(const Enclosure& enclosure, const Forest& forest, Node node) {
    return std::max(least_open, open_share(enclosure, forest, node, element_share_points));
}

// The leaves below a root, as they lie in its tree: neighbours there are neighbours in space.
template <class Node, class Visit>
void each_leaf(const Forest& forest, Node root, Visit&& visit) {
    std::vector<Node> open{root};
    while (!open.empty()) {
        const Node node = open.back();
        open.pop_back();
        if (forest.is_leaf(node)) {
            visit(node);
            continue;
        }
        const Node first = forest[node].first_child;
        open.push_back(Node(first.value + 1ull));
        open.push_back(first);
    }
}

// `open`: of a node, the share that counts.
template <class Open>
Elements of_leaves(const Enclosure& enclosure, const Forest& forest, Open&& open) {
    Elements e = without_elements(enclosure, forest);
    const OpticalTags tags(enclosure);
    for (std::size_t p = 0; p < tags.facet_sides.size(); ++p) {
        const auto side = tags.facet_sides[p];
        if (side == none) continue;
        each_leaf(forest, PatchId(p), [&](PatchId patch) {
            e.of_patch[patch.value] = static_cast<std::uint32_t>(e.size());
            append(e, enclosure.sides[side], patch, forest.area(patch) * open(patch));
        });
    }
    for (std::size_t t = 0; t < tags.tets.size(); ++t) {
        const auto medium = tags.tets[t];
        if (medium == none) continue;
        each_leaf(forest, ZoneId(t), [&](ZoneId zone) {
            e.of_zone[zone.value] = static_cast<std::uint32_t>(e.size());
            append(e, enclosure.media[medium], zone,
                   mean_extinction(enclosure, forest, {&zone.value, 1}),
                   forest.volume(zone) * open(zone));
        });
    }
    return e;
}

}  // namespace

Elements elements_of_leaves(const Enclosure& enclosure, const Forest& forest) {
    return of_leaves(enclosure, forest, [&](auto node) { return open(enclosure, forest, node); });
}

Elements leaves_in_order(const Enclosure& enclosure, const Forest& forest) {
    return of_leaves(enclosure, forest, [](auto) { return 1.0; });
}

namespace {

// Appends a cluster's members to the last element; returns their area or volume.
template <class Measure>
double append_members(Elements& e, std::span<const std::uint32_t> members, Measure&& measure) {
    double total = 0.0;
    for (const auto member : members) {
        e.members.push_back(member);
        e.member_ends.push_back(total += measure(member));
    }
    for (std::size_t k = e.member_starts.back(); k < e.members.size(); ++k)
        e.member_ends[k] /= total;
    e.member_starts.push_back(e.members.size());
    return total;
}

void check_tag(const std::vector<std::uint32_t>& tags, std::span<const std::uint32_t> members) {
    for (const auto member : members)
        if (tags[member] == none || tags[member] != tags[members[0]])
            throw mesh::InputError(
                "a cluster holds more than one medium or side of a surface, or none. Make clusters "
                "with the tags of the enclosure.");
}

}  // namespace

Elements elements_of_clusters(const Enclosure& enclosure, const Forest& forest,
                              const mesh::Clusters& clusters) {
    Elements e = without_elements(enclosure, forest);
    e.member_starts = {0};
    const OpticalTags tags(enclosure);
    // Base tets and facet sides are the first nodes of the forest, by the same numbers.
    const auto each_root = [&](const mesh::ClusterTree& tree, const auto& add) {
        for (std::size_t c = 0; c < tree.clusters.size(); ++c)
            if (!tree.clusters[c].parent.valid()) add(tree.members_of(mesh::ClusterId(c)));
    };
    each_root(clusters.patches, [&](std::span<const std::uint32_t> members) {
        check_tag(tags.facet_sides, members);
        for (const auto member : members) e.of_patch[member] = static_cast<std::uint32_t>(e.size());
        const double area =
            append_members(e, members, [&](std::uint32_t p) { return forest.area(PatchId(p)); });
        append(e, enclosure.sides[tags.facet_sides[members[0]]], PatchId(members[0]), area);
    });
    each_root(clusters.zones, [&](std::span<const std::uint32_t> members) {
        check_tag(tags.tets, members);
        for (const auto member : members) e.of_zone[member] = static_cast<std::uint32_t>(e.size());
        const double volume =
            append_members(e, members, [&](std::uint32_t z) { return forest.volume(ZoneId(z)); });
        append(e, enclosure.media[tags.tets[members[0]]], ZoneId(members[0]),
               mean_extinction(enclosure, forest, members), volume);
    });
    return e;
}

OpticalTags::OpticalTags(const Enclosure& enclosure) {
    for (std::size_t t = 0; t < enclosure.mesh.tets.size(); ++t)
        tets.push_back(enclosure.solid(TetId(t)) ? none : enclosure.medium_of(TetId(t)));
    for (const auto& sides : enclosure.facet_sides)
        facet_sides.insert(facet_sides.end(), {sides[0], sides[1]});
}

std::vector<PatchId> Elements::member_patches() const {
    if (member_starts.empty()) return patches;
    std::vector<PatchId> result;
    for (std::size_t k = 0; k < member_starts[patches.size()]; ++k)
        result.push_back(PatchId(members[k]));
    return result;
}

std::vector<ZoneId> Elements::member_zones() const {
    if (member_starts.empty()) return zones;
    std::vector<ZoneId> result;
    for (std::size_t k = member_starts[patches.size()]; k < members.size(); ++k)
        result.push_back(ZoneId(members[k]));
    return result;
}

std::uint32_t Elements::pick_member(std::size_t element, double& u) const {
    const auto all = members_of(element);
    if (all.size() == 1) return all[0];
    const auto ends = std::span(member_ends).subspan(member_starts[element], all.size());
    const auto k = std::min(
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), u) - ends.begin()),
        all.size() - 1);
    const double begin = k > 0 ? ends[k - 1] : 0.0;
    u = std::clamp((u - begin) / (ends[k] - begin), 0.0, 1.0 - 0x1p-53);
    return all[k];
}

}  // namespace tyndall::radiosity
