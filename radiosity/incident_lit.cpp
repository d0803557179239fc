#include "radiosity/incident_lit.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "radiosity/open_places.h"

namespace tyndall::radiosity {
namespace {

// Of an element's size: nearer to a body a mean is taken anew. The whole size costs a third more,
// and leaves the picture as it is.
constexpr double anew_within = 0.5;

using Rule = std::vector<std::pair<Receiver, double>>;

// Points of degree 2 on an element, each with its part of the area or volume.
Rule quadrature(const Enclosure& enclosure, const Forest& forest, PatchId patch) {
    Rule points;
    for (const VertexId corner : forest[patch].corners) {
        const Point x = 0.5 * (forest.point(corner) + forest.centroid(patch));
        points.push_back({{x, mesh::tet_before(enclosure.mesh, forest.base_facet_side(patch), x),
                           normal_of(forest, patch), true},
                          forest.area(patch) / 3.0});
    }
    return points;
}

Rule quadrature(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    constexpr double towards_corner = 0.4472135954999579;  // 1/√5
    const MediumOptics& optics = enclosure.media[medium_of(enclosure, forest, zone)];
    Rule points;
    for (const VertexId corner : forest[zone].corners) {
        const Point centre = forest.centroid(zone);
        const Point x = centre + towards_corner * (forest.point(corner) - centre);
        double size = forest.volume(zone) / 4.0;
        if (!optics.varying.empty()) {
            // A zone is met as often as it is dense.
            double density = least_density * optics.extinction[0] + 1e-300;
            for (const ExtinctionBand& band : optics.varying) density += band.at(x);
            size *= density;
        }
        const OpenPlace place = open_place(enclosure, x, forest.base_tet(zone));
        points.push_back({{place.x, place.tet}, size});
    }
    return points;
}

// The middle of an element; a patch's, which is before its side of the facet.
Rule middle(const Enclosure& enclosure, const Forest& forest, PatchId patch) {
    const Point x = forest.centroid(patch);
    return {{{x, mesh::tet_before(enclosure.mesh, forest.base_facet_side(patch), x),
              normal_of(forest, patch), true},
             forest.area(patch)}};
}

Rule middle(const Enclosure& enclosure, const Forest& forest, ZoneId zone) {
    const OpenPlace place = open_place(enclosure, forest.centroid(zone), forest.base_tet(zone));
    return {{{place.x, place.tet}, forest.volume(zone)}};
}

// What arrives at an element, by the rule that `points` gives for each of its members.
template <class Points>
void gather_over(const Elements& e, std::size_t i, const LitPatches& lit, Points&& points,
                 std::span<double> mean) {
    std::vector<double> here(e.bands);
    double measure = 0.0;
    std::fill(mean.begin(), mean.end(), 0.0);
    for (const std::uint32_t member : e.members_of(i))
        for (const auto& [receiver, size] :
             e.is_patch(i) ? points(PatchId(member)) : points(ZoneId(member))) {
            std::fill(here.begin(), here.end(), 0.0);
            lit.gather(receiver, here);
            measure += size;
            for (std::size_t b = 0; b < e.bands; ++b) mean[b] += size * here[b];
        }
    for (double& value : mean) value /= measure;
}

// One value an element and band: find(element, its values).
template <class Find>
std::vector<double> of_elements(const Elements& e, Find&& find) {
    std::vector<double> values(e.size() * e.bands);
    tbb::parallel_for(std::size_t(0), e.size(), [&](std::size_t i) {
        find(i, std::span<double>(values.data() + i * e.bands, e.bands));
    });
    return values;
}

template <class Node>
bool near_body(const Forest& forest, Node node, std::span<const mesh::Body> bodies) {
    return std::ranges::any_of(bodies, [&](const mesh::Body& body) {
        return glm::distance(forest.centroid(node), body.centre) <=
               body.radius + anew_within * forest[node].longest_edge;
    });
}

}  // namespace

std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& e, const LitPatches& lit) {
    const auto rule = [&](auto node) { return quadrature(enclosure, forest, node); };
    return of_elements(
        e, [&](std::size_t i, std::span<double> mean) { gather_over(e, i, lit, rule, mean); });
}

std::vector<double> lit_in_middles(const Enclosure& enclosure, const Forest& forest,
                                   const Elements& e, const LitPatches& lit) {
    const auto rule = [&](auto node) { return middle(enclosure, forest, node); };
    return of_elements(
        e, [&](std::size_t i, std::span<double> mean) { gather_over(e, i, lit, rule, mean); });
}

std::vector<double> incident_lit(const Enclosure& enclosure, const Forest& forest,
                                 const Elements& e, const LitPatches& lit,
                                 const LitBefore& before) {
    const auto rule = [&](auto node) { return quadrature(enclosure, forest, node); };
    const auto rule_in_middle = [&](auto node) { return middle(enclosure, forest, node); };
    return of_elements(e, [&](std::size_t i, std::span<double> mean) {
        const bool near = std::ranges::any_of(e.members_of(i), [&](std::uint32_t member) {
            return e.is_patch(i) ? near_body(forest, PatchId(member), before.bodies)
                                 : near_body(forest, ZoneId(member), before.bodies);
        });
        if (near) return gather_over(e, i, lit, rule, mean);
        gather_over(e, i, lit, rule_in_middle, mean);
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = i * e.bands + b;
            mean[b] = std::max(0.0, before.means[k] + mean[b] - before.in_middles[k]);
        }
    });
}

}  // namespace tyndall::radiosity
