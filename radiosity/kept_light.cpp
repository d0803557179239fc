#include "radiosity/kept_light.h"

#include <algorithm>
#include <cmath>

#include "radiosity/incident_lit.h"
#include "radiosity/indicators.h"
#include "radiosity/moving_bodies.h"

namespace tyndall::radiosity {
namespace {

// Of the goal: what a change that is linear over an element may miss.
constexpr double missed_share = 0.1;

// Of an element's size: nearer to a body a gather is made anew. Half costs a fifth more in a large
// room, and leaves the picture's error as it is, or nearly.
constexpr double near = 0.25;

// Of a gather's rays: where more meet a body, all are walked anew.
constexpr double most_met = 0.4;

// Functions linear in the elements, given their means in a band ([element * bands + band]).
void set_linear(const KeptLight& kept, const ExchangeAreas& areas, const std::vector<double>& mean,
                std::size_t band, Affine* functions) {
    const Elements& e = kept.elements;
    std::vector<glm::vec3> gradients(e.size(), glm::vec3(0.0f));
    if (areas.gradients) gradients = areas.gradients->of(mean);
    for (std::size_t i = 0; i < e.size(); ++i) {
        const Direction g(gradients[i]);
        const Point centre = e.is_patch(i)
                                 ? centre_of(*kept.enclosure, kept.coarse_forest, e.patches[i])
                                 : centre_of(*kept.enclosure, kept.coarse_forest, e.zone(i));
        functions[i * e.bands + band] = {g, mean[i] - glm::dot(g, centre)};
    }
}

}  // namespace

std::size_t KeptLight::memory() const {
    std::size_t bytes =
        direct.memory() + gathers.memory() + 2 * forest.memory() + coarse_forest.memory();
    for (const auto* values : {&gathered_from.sent, &gathered_from.by_lit, &gathered_from.by_rows,
                               &lit_in_middles, &coarse_errors})
        bytes += values->size() * sizeof(double);
    if (rows) bytes += rows->memory();
    bytes += directions.size() * sizeof(glm::vec3);
    return bytes;
}

void KeptLight::take(const CoarseSolution& coarse, const std::vector<double>& incident_direct,
                     const std::vector<double>& incident_lit) {
    elements = coarse.elements();
    // A copy: what the solve lets go the first frame's rows will take. Pages that a system has to
    // find anew cost a third of a frame where it is a virtual machine.
    rows = std::make_shared<const RowSet>(*coarse.rows());
    directions = coarse.ray_directions();
    gathered_from = radiosity::gathered_from(coarse, incident_direct, incident_lit);
}

void KeptLight::finish(std::shared_ptr<const Enclosure> of, const Forest& leaves,
                       Fields zone_sources, Fields patch_sources, double detail) {
    enclosure = std::move(of);
    forest = leaves;
    for (Fields* fields : {&zone_sources, &patch_sources}) {
        extend(forest, *fields);
        coarsen(forest, *fields);
    }
    in_zones = std::make_unique<const GatherScene>(*enclosure, forest, zone_sources, detail);
    on_patches = std::make_unique<const GatherScene>(*enclosure, forest, patch_sources, detail);
    direct.settle();
    gathers.settle();
}

GatheredFrom gathered_from(const CoarseSolution& coarse, const std::vector<double>& incident_direct,
                           const std::vector<double>& incident_lit) {
    const Elements& e = coarse.elements();
    GatheredFrom result{{}, incident_lit, {}};
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = i * e.bands + b;
            result.sent.push_back(coarse.reflected(i, b));
            if (e.is_patch(i)) result.sent.back() -= e.scatter[k] * incident_direct[k];
            result.by_rows.push_back(coarse.by_rows(i, b));
        }
    return result;
}

std::string why_nothing_kept(const SolveOptions& o) {
    if (o.exchange != "walked") return "is solved with exchange = \"" + o.exchange + "\"";
    if (o.exchange_settings.smoothing != Smoothing::none) return "is solved with smoothing";
    if (o.exchange_settings.interaction_radius > 0.0) return "is solved with an interaction radius";
    if (o.row_detail > 0.0) return "is solved with level of detail in rows (row_detail)";
    if (o.shots == Shots::on_the_fly) return "is solved with shots on the fly";
    if (o.promotions > 0) return "is solved with promotions";
    if (o.start == Start::single_zone) return "is solved with start = \"single-zone\"";
    // These look at the coarse solution, which moved frames have only after direct light.
    if (asks_for(o, "jump")) return "is refined by the indicator \"jump\"";
    if (o.indicator) return "is refined by an indicator of the caller's";
    return "";
}

bool fits(const KeptLight& kept, const Enclosure& enclosure) {
    if (kept.empty()) return false;
    const mesh::BaseMesh &a = kept.enclosure->mesh, &b = enclosure.mesh;
    if (a.tets != b.tets || a.neighbours != b.neighbours || a.tet_facets != b.tet_facets ||
        a.points.size() != b.points.size() || a.facets.size() != b.facets.size() ||
        a.bodies.size() != b.bodies.size() || kept.enclosure->facet_sides != enclosure.facet_sides)
        return false;
    for (std::size_t f = 0; f < a.facets.size(); ++f)
        if (a.facets[f].corners != b.facets[f].corners) return false;
    for (std::size_t k = 0; k < a.bodies.size(); ++k)
        if (a.bodies[k].first != b.bodies[k].first || a.bodies[k].end != b.bodies[k].end ||
            a.bodies[k].closed != b.bodies[k].closed)
            return false;
    return true;
}

std::vector<double> moved_incident_lit(const KeptLight& before, const Enclosure& enclosure,
                                       const Forest& forest, const Elements& elements,
                                       const LitPatches& lit) {
    const auto bodies = bodies_of(*before.enclosure, enclosure);
    return incident_lit(enclosure, forest, elements, lit,
                        {before.gathered_from.by_lit, before.lit_in_middles, bodies});
}

GatherChange::GatherChange(const KeptLight& before, const Now& now, double error)
    : before_(before),
      bodies_(bodies_of(*before.enclosure, now.enclosure)),
      bands_(now.enclosure.bands),
      may_miss_(missed_share * error) {
    const Elements& e = before.elements;
    const std::size_t n = e.size();
    for (auto* functions : {&of_sources_, &of_lit_, &far_}) functions->resize(n * bands_);
    std::size_t made = 0;
    std::vector<std::size_t> distinct;  // of the bands, as CoarseSolution has them
    const GatheredFrom &is = now.gathered_from, &was = before.gathered_from;
    std::vector<double> sent(n), lit(n), all(n);
    for (std::size_t b = 0; b < bands_; ++b) {
        const std::size_t same = first_of_extinction(now.enclosure, b);
        distinct.push_back(same < b ? distinct[same] : made++);
        const ExchangeAreas& rows = before.rows->areas[distinct[b]];
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = i * bands_ + b;
            sent[i] = is.sent[k] - was.sent[k];
            lit[i] = is.by_lit[k] - was.by_lit[k];
            all[i] = is.by_rows[k] - was.by_rows[k] + lit[i];  // (66)
        }
        std::vector<double> of_sources = multiply(rows, e, sent);  // (50)
        for (std::size_t i = 0; i < n; ++i)
            of_sources[i] /= std::max(e.capacity[i * bands_ + b], 1e-300);
        set_linear(before, rows, of_sources, b, of_sources_.data());
        set_linear(before, rows, lit, b, of_lit_.data());
        set_linear(before, rows, all, b, far_.data());
    }
}

bool GatherChange::meets(const mesh::Ray& ray) const {
    return std::ranges::any_of(
        bodies_, [&](const mesh::Body& body) { return mesh::meets_sphere(body, ray); });
}

bool GatherChange::inside(Point x) const {
    return std::ranges::any_of(bodies_, [&](const mesh::Body& body) {
        return glm::distance(x, body.centre) <= body.radius;
    });
}

bool GatherChange::far(Point x, double size) const {
    return std::ranges::all_of(bodies_, [&](const mesh::Body& body) {
        const double d = glm::distance(x, body.centre), sine = body.radius / d;
        if (!(sine < 1.0)) return false;
        const double hidden = 0.5 * (1.0 - std::sqrt(1.0 - sine * sine)), ratio = size / d;
        return hidden * ratio * ratio / 8.0 <= may_miss_;
    });
}

// What lit patches send past a body is known as finely as the elements are: not beside it.
bool near_body(const std::vector<mesh::Body>& bodies, Point x, double size) {
    return std::ranges::any_of(bodies, [&](const mesh::Body& body) {
        return glm::distance(x, body.centre) <= body.radius + size;
    });
}

std::uint32_t GatherChange::element_at(const GatherPoint& point) const {
    const mesh::BaseMesh& mesh = before_.enclosure->mesh;
    const Forest& forest = before_.coarse_forest;
    const TetId tet = point.start.tet;
    if (!point.on_surface())
        return before_.elements.of_zone[forest.leaf_at(mesh::root_zone(tet), point.x).value];
    if (point.start.face == mesh::WalkStart::inside) return none;  // a body's
    const FacetId facet = mesh.tet_facets[tet.value][point.start.face];
    const Side side = mesh.facets[facet.value].tets[0] == tet ? Side::front : Side::back;
    return before_.elements.of_patch[forest.leaf_at(mesh::root_patch(facet, side), point.x).value];
}

bool GatherChange::gather(const GatherScene& now, const GatherPoint& point, const PointSet& points,
                          std::uint64_t seed, std::span<Gathered> incident,
                          std::size_t& walked) const {
    const auto size_of = [&](std::uint32_t e) -> double {
        const Elements& elements = before_.elements;
        return elements.is_patch(e) ? before_.coarse_forest[elements.patches[e]].longest_edge
                                    : before_.coarse_forest[elements.zone(e)].longest_edge;
    };
    const double* kept = before_.gathers.find(point.x, point.normal);
    if (!kept || inside(point.x)) return false;
    const std::uint32_t element = element_at(point);
    if (element == none || near_body(bodies_, point.x, near * size_of(element))) return false;
    if (far(point.x, size_of(element))) {
        for (std::size_t b = 0; b < bands_; ++b)
            incident[b] = {std::max(0.0, kept[2 * b] + far_[element * bands_ + b].at(point.x)),
                           kept[2 * b + 1]};
        return true;
    }
    const GatherScene& before = point.on_surface() ? *before_.on_patches : *before_.in_zones;
    const std::uint64_t stream =
        point.on_surface() ? seed : hash_seed(seed, static_cast<std::uint64_t>(kept[2 * bands_]));
    thread_local GatherRays rays;
    rays.spread(point, before_.bright.get(), points, stream);
    thread_local std::vector<GatherRay> met;
    met.clear();
    double others = 1.0;
    for (const GatherRay& ray : rays.all()) {
        if (!meets({point.x, ray.direction})) continue;
        // What lit patches send through an opening is in H⁰ as rays found it, not as P has it.
        if (ray.lit_beyond < mesh::infinity) return false;
        met.push_back(ray);
        others -= ray.weight;
    }
    if (1.0 - others > most_met) return false;
    for (std::size_t b = 0; b < bands_; ++b) {
        incident[b].mean = kept[2 * b] + others * of_sources_[element * bands_ + b].at(point.x) +
                           of_lit_[element * bands_ + b].at(point.x);  // (49)
        incident[b].half_difference = kept[2 * b + 1];
    }
    thread_local std::vector<double> found, lost;
    found.resize(bands_);
    lost.resize(bands_);
    for (const GatherRay& ray : met) {
        radiance_along(now, {point.x, ray.direction}, point.start, found);
        radiance_along(before, {point.x, ray.direction}, point.start, lost);
        for (std::size_t b = 0; b < bands_; ++b) {
            const double change = found[b] - lost[b];
            incident[b].mean += ray.weight * change;
            incident[b].half_difference += ray.half_weight * change;
        }
    }
    for (std::size_t b = 0; b < bands_; ++b) incident[b].mean = std::max(0.0, incident[b].mean);
    walked += 2 * met.size();
    return true;
}

}  // namespace tyndall::radiosity
