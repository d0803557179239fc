#include "radiosity/adaptive.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "mesh/input_error.h"
#include "radiosity/balance.h"
#include "radiosity/coarse_solution.h"
#include "radiosity/refine.h"
#include "radiosity/resources.h"
#include "radiosity/start_elements.h"

namespace tyndall::radiosity {
namespace {

// How the squared error goal is shared out. Errors of direct light have either sign from leaf to
// leaf, those of indirect light are smooth and stay: they get less.
constexpr double direct_share = 0.85;
constexpr double indirect_share = 0.15;

// A gather's zone may stand for its leaves when it is no longer than this many spacings of its
// rays: measured, 1 and 4 give the same picture, 4 in half the time.
constexpr double detail_factor = 4.0;

// Constant J in an optically thick zone of the coarse solution overstates what passes through it: 5
// % of the flux at 0.5 (docs/limits.md).
constexpr double thin_enough = 0.5;

void warn_of_thick_zones(const Enclosure& enclosure, const CoarseSolution& coarse, Report& report) {
    const Elements& e = coarse.elements();
    double thickest = 0.0;
    std::uint32_t medium = 0;
    for (std::size_t i = e.patches.size(); i < e.size(); ++i) {
        const auto m = medium_of(enclosure, coarse.forest(), e.zone(i));
        double volume = 0.0;
        for (const auto member : e.members_of(i)) volume += coarse.forest().volume(ZoneId(member));
        const double size = std::cbrt(volume);
        for (const double extinction : enclosure.media[m].extinction)
            if (extinction * size > thickest) {
                thickest = extinction * size;
                medium = m;
            }
    }
    if (thickest > thin_enough)
        report.warnings.push_back(fmt::format(
            "zones of medium \"{}\" in the coarse solution are up to {:.2g} optical depths thick: "
            "fluxes through them are overstated. Set solve.element_size to {:.2g} m or less.",
            enclosure.media[medium].name, thickest,
            thin_enough / *std::max_element(enclosure.media[medium].extinction.begin(),
                                            enclosure.media[medium].extinction.end())));
}

std::optional<ShadowBoundaries> shadow_boundaries(const Enclosure& enclosure,
                                                  const SolveOptions& options) {
    if (options.refinement != Refinement::aligned) return {};
    return ShadowBoundaries(enclosure, options.direct_light == DirectLightMode::closed_form);
}

// The loop's state, step by step; each step leaves something that a valid solution can be made of.
class Loop {
  public:
    Loop(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
         const std::optional<View>& view, const ProgressCallback& progress)
        : enclosure_(std::move(enclosure)),
          options_(options),
          view_(view),
          progress_([this, progress, began = wall_seconds()](const Progress& now) {
              out_of_time_ = options_.max_time > 0.0 && wall_seconds() - began > options_.max_time;
              return !out_of_time_ && (!progress || progress(now));
          }),
          light_(*enclosure_, {.emitters = options.direct_light == DirectLightMode::closed_form}),
          mesh_(*enclosure_),
          boundaries_(shadow_boundaries(*enclosure_, options)),
          direct_(*enclosure_, mesh_, light_, boundaries_ ? &*boundaries_ : nullptr) {
        if (options_.refinement < Refinement::view) view_.reset();
        begin_pass();
    }

    Solution run() {
        make_initial_mesh();
        CoarseSolution coarse(*enclosure_, mesh_.forest(),
                              start_elements(*enclosure_, mesh_.forest(), options_.start), options_,
                              progress_);
        rays_ += coarse.rays();
        direct_.update();
        solve(coarse);
        rate(coarse);
        end_pass("coarse solution");

        const Importance importance(*enclosure_, mesh_.forest(), view_, scale_);
        if (adaptive()) {
            const auto result =
                direct_.refine(importance, direct_share * goal(), limits(0.8), progress_);
            note(result);
            squared_error_ = result.squared_error;
        }
        const LitPatches lit = lit_patches();
        solve(coarse, &lit);
        end_pass("direct light");
        IndirectRefiner indirect(*enclosure_, mesh_, coarse.elements(), options_.gather_rays,
                                 options_.seed);
        const double indirect_goal = adaptive() ? indirect_share * goal() : 1e300;
        IndirectSources sources{coarse_sources(coarse, &lit), &lit, gather_detail()};
        // Half for zones; patches get what they leave.
        const auto zones =
            indirect.refine_zones(sources, importance, 0.5 * indirect_goal, limits(1.0), progress_);
        direct_.update();
        update_zones(indirect, sources.fields);
        const auto patches = indirect.refine_patches(
            sources, importance, indirect_goal - std::min(zones.squared_error, 0.5 * indirect_goal),
            limits(1.0), progress_);
        for (const auto& result : {zones, patches}) {
            note(result);
            rays_ += result.rays;
            squared_error_ += result.squared_error;
        }
        direct_.update();
        Solution solution = collect(coarse, indirect);
        end_pass("indirect light");
        solution.report = finish(coarse);
        return solution;
    }

  private:
    bool adaptive() const { return options_.refinement >= Refinement::adaptive; }
    double goal() const { return options_.error * options_.error; }
    // `share` of the elements allowed: what direct light may not use is left for indirect light.
    RefineLimits limits(double share) const {
        const auto& base = enclosure_->mesh;
        return {static_cast<std::size_t>(share * static_cast<double>(options_.max_elements)),
                options_.max_memory, 1e-4 * glm::distance(base.hull_min, base.hull_max)};
    }
    double gather_detail() const {
        return detail_factor * std::sqrt(4.0 * M_PI / static_cast<double>(options_.gather_rays));
    }

    void make_initial_mesh();
    void solve(CoarseSolution& coarse, const LitPatches* lit = nullptr);
    LitPatches lit_patches();
    std::vector<std::pair<Receiver, double>> quadrature(PatchId patch) const;
    std::vector<std::pair<Receiver, double>> quadrature(ZoneId zone) const;
    std::vector<double> incident_lit(const Elements& elements, const LitPatches& lit) const;
    void rate(const CoarseSolution& coarse);
    std::vector<Affine> linear_indirect(const CoarseSolution& coarse);
    Fields coarse_sources(const CoarseSolution& coarse, const LitPatches* lit = nullptr);
    void update_zones(IndirectRefiner& indirect, Fields& sources);
    Solution collect(const CoarseSolution& coarse, IndirectRefiner& indirect);
    Report finish(const CoarseSolution& coarse);
    template <class Node>
    std::uint32_t element_above(Node node, const std::vector<std::uint32_t>& of_node) const {
        while (!(node.value < of_node.size() && of_node[node.value] != none))
            node = mesh_.forest()[node].parent;
        return of_node[node.value];
    }
    template <class Node>
    Affine direct_field(Node node, std::size_t band);
    // A leaf's linear function of direct light with its mean kept.
    template <class Node>
    Affine direct_with_mean(Node node, std::size_t band) {
        return with_mean(direct_field(node, band), mesh_.forest().centroid(node),
                         direct_.mean(node, band));
    }

    void note(const RefineResult& result) {
        stopped_ = stopped_ || result.stopped;
        limited_ = limited_ || result.limited;
    }
    void begin_pass() {
        cpu_ = cpu_seconds();
        wall_ = wall_seconds();
        rays_ = 0;
    }
    void end_pass(const std::string& stage) {
        passes_.push_back({stage, mesh_.patch_leaf_count(), mesh_.zone_leaf_count(), rays_,
                           cpu_seconds() - cpu_, wall_seconds() - wall_, mesh_.memory(),
                           std::sqrt(squared_error_)});
        begin_pass();
    }

    std::shared_ptr<const Enclosure> enclosure_;
    SolveOptions options_;
    std::optional<View> view_;
    ProgressCallback progress_;
    DirectLight light_;
    ElementMesh mesh_;
    std::optional<ShadowBoundaries> boundaries_;  // along which elements are cut
    DirectRefiner direct_;
    std::vector<double> incident_direct_;  // of the coarse elements
    Importance::Scale scale_;
    std::vector<PassReport> passes_;
    double squared_error_ = 0.0;
    bool stopped_ = false, limited_ = false, out_of_time_ = false;
    double cpu_ = 0.0, wall_ = 0.0;
    std::size_t rays_ = 0;
};

void Loop::make_initial_mesh() {
    // Fine enough for smooth indirect light, coarse enough that rows cost about a second.
    ElementMesh::InitialSize size{0.0, 4000, 1500};
    if (options_.start == Start::single_zone) return;
    if (options_.element_size > 0.0)
        size = {options_.element_size, options_.max_elements, options_.max_elements};
    else if (options_.refinement == Refinement::none)
        return;
    mesh_.refine_to(size);
}

// What patches reflect of direct light.
LitPatches Loop::lit_patches() {
    const Forest& forest = mesh_.forest();
    Fields lit;
    lit.resize(forest, enclosure_->bands);
    for (const PatchId p : mesh_.patches())
        for (std::size_t b = 0; forest.is_leaf(p) && b < lit.bands; ++b) {
            const double a = enclosure_->sides[side_of(*enclosure_, forest, p)].reflectance[b];
            const Affine f = direct_with_mean(p, b);
            lit.at(p, b) = {a * f.gradient, a * f.constant};
        }
    if (options_.radiance == Radiance::constant) flatten(forest, lit);
    return {*enclosure_, forest, lit};
}

// H from lit patches, the mean over each element ([element * bands + band]).
std::vector<double> Loop::incident_lit(const Elements& e, const LitPatches& lit) const {
    std::vector<double> incident(e.size() * e.bands, 0.0);
    tbb::parallel_for(std::size_t(0), e.size(), [&](std::size_t i) {
        const std::span<double> sum(incident.data() + i * e.bands, e.bands);
        std::vector<double> here(e.bands);
        double measure = 0.0;
        for (const std::uint32_t member : e.members_of(i)) {
            const auto points =
                e.is_patch(i) ? quadrature(PatchId(member)) : quadrature(ZoneId(member));
            for (const auto& [receiver, size] : points) {
                std::fill(here.begin(), here.end(), 0.0);
                lit.gather(receiver, here);
                measure += size;
                for (std::size_t b = 0; b < e.bands; ++b) sum[b] += size * here[b];
            }
        }
        for (double& value : sum) value /= measure;
    });
    return incident;
}

// Points of degree 2 on an element, each with its part of the area or volume.
std::vector<std::pair<Receiver, double>> Loop::quadrature(PatchId patch) const {
    const Forest& forest = mesh_.forest();
    const auto side = forest.base_facet_side(patch);
    std::vector<std::pair<Receiver, double>> points;
    for (const VertexId corner : forest[patch].corners)
        points.push_back(
            {{0.5 * (forest.point(corner) + forest.centroid(patch)),
              enclosure_->mesh.facets[side / 2].tets[side % 2], normal_of(forest, patch), true},
             forest.area(patch) / 3.0});
    return points;
}

std::vector<std::pair<Receiver, double>> Loop::quadrature(ZoneId zone) const {
    const Forest& forest = mesh_.forest();
    constexpr double towards_corner = 0.4472135954999579;  // 1/√5
    std::vector<std::pair<Receiver, double>> points;
    for (const VertexId corner : forest[zone].corners) {
        const Point centre = forest.centroid(zone);
        points.push_back(
            {{centre + towards_corner * (forest.point(corner) - centre), forest.base_tet(zone)},
             forest.volume(zone) / 4.0});
    }
    return points;
}

// Direct light of the leaves summed into the coarse elements above them, then the linear system.
// With `lit`, what patches reflect of it is not left to the rows.
void Loop::solve(CoarseSolution& coarse, const LitPatches* lit) {
    const std::size_t bands = enclosure_->bands;
    const Elements& e = coarse.elements();
    incident_direct_.assign(e.size() * bands, 0.0);
    std::vector<double> measure(e.size(), 0.0);
    const auto add = [&](auto node, std::uint32_t element, double size) {
        measure[element] += size;
        for (std::size_t b = 0; b < bands; ++b)
            incident_direct_[element * bands + b] += size * direct_.mean(node, b);
    };
    const Forest& forest = mesh_.forest();
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) add(z, element_above(z, e.of_zone), forest.volume(z));
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) add(p, element_above(p, e.of_patch), forest.area(p));
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t b = 0; b < bands; ++b)
            if (measure[i] > 0.0) incident_direct_[i * bands + b] /= measure[i];
    if (lit)
        coarse.solve(incident_direct_, incident_lit(e, *lit));
    else
        coarse.solve(incident_direct_);
}

// The picture's mean radiance and the solution's mean square, against which errors are measured.
void Loop::rate(const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    double square = 0.0, capacity = 0.0;
    for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = i * e.bands + b;
            const double x = coarse.reflected(i, b);
            square += e.capacity[k] * x * x;
            capacity += e.capacity[k];
        }
    scale_.solution = capacity > 0.0 ? square / capacity : 0.0;
    if (!view_) return;
    const TetId eye = mesh::locate(enclosure_->mesh, view_->eye);
    if (!eye.valid() || enclosure_->solid(eye)) {
        view_.reset();
        return;
    }
    const Fields sources = coarse_sources(coarse);
    const GatherScene scene(*enclosure_, mesh_.forest(), sources);
    constexpr int across = 32, down = 24;
    Spectrum radiance(e.bands);
    double sum = 0.0;
    for (int y = 0; y < down; ++y)
        for (int x = 0; x < across; ++x) {
            const double s = (2.0 * (x + 0.5) / across - 1.0) * view_->tan_half_x;
            const double t = (1.0 - 2.0 * (y + 0.5) / down) * view_->tan_half_y;
            const mesh::Ray ray{view_->eye,
                                glm::normalize(view_->forward + s * view_->right + t * view_->up)};
            radiance_along(scene, ray, {eye}, radiance);
            sum += mean_over_bands(radiance);
        }
    scale_.picture = sum / (across * down);
}

template <class Node>
Affine Loop::direct_field(Node node, std::size_t band) {
    const Forest& forest = mesh_.forest();
    const auto samples = mesh_.lit_corners(node);
    std::array<Point, std::tuple_size_v<decltype(samples)>> points;
    std::array<double, std::tuple_size_v<decltype(samples)>> values;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        points[k] = forest.point(forest[node].corners[k]);
        values[k] = mesh_.samples().direct(samples[k], band);
    }
    return interpolate(points, values);
}

// Indirect light of the coarse elements, linear between the means of those that meet at a corner,
// each element's own mean kept ([element * bands + band]).
std::vector<Affine> Loop::linear_indirect(const CoarseSolution& coarse) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh_.forest();
    std::vector<double> sum, weight;
    std::vector<Affine> result(e.size() * e.bands);
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k].constant = coarse.indirect(k / e.bands, k % e.bands);
    if (!e.member_starts.empty()) return result;  // clusters have no corners
    const auto each_corner = [&](auto&& visit) {
        for (std::size_t i = 0; i < e.patches.size(); ++i)
            visit(i, e.patches[i], mesh_.corners(e.patches[i]), forest.area(e.patches[i]));
        for (std::size_t k = 0; k < e.zones.size(); ++k)
            visit(e.patches.size() + k, e.zones[k], mesh_.corners(e.zones[k]),
                  forest.volume(e.zones[k]));
    };
    each_corner([&](std::size_t i, auto, const auto& corners, double size) {
        for (const SampleId id : corners) {
            if (id.value >= weight.size()) {
                weight.resize(mesh_.samples().size());
                sum.resize(mesh_.samples().size() * e.bands);
            }
            weight[id.value] += size;
            for (std::size_t b = 0; b < e.bands; ++b)
                sum[id.value * e.bands + b] += size * coarse.indirect(i, b);
        }
    });
    each_corner([&](std::size_t i, auto node, const auto& corners, double) {
        std::array<Point, std::tuple_size_v<std::decay_t<decltype(corners)>>> points;
        std::array<double, points.size()> values;
        for (std::size_t b = 0; b < e.bands; ++b) {
            for (std::size_t k = 0; k < corners.size(); ++k) {
                points[k] = forest.point(forest[node].corners[k]);
                values[k] = sum[corners[k].value * e.bands + b] / weight[corners[k].value];
            }
            result[i * e.bands + b] = with_mean(interpolate(points, values), forest.centroid(node),
                                                coarse.indirect(i, b));
        }
    });
    return result;
}

// r of the leaves as the coarse solution knows it: their own direct light with its mean kept, the
// coarse element's indirect light. With `lit`, without what patches reflect of direct light: it is
// looked at apart.
Fields Loop::coarse_sources(const CoarseSolution& coarse, const LitPatches* lit) {
    const Elements& e = coarse.elements();
    const Forest& forest = mesh_.forest();
    Fields sources;
    sources.resize(forest, e.bands);
    const std::vector<Affine> indirect = linear_indirect(coarse);
    const auto fill = [&](auto node, std::uint32_t element) {
        for (std::size_t b = 0; b < e.bands; ++b) {
            const std::size_t k = element * e.bands + b;
            Affine f = direct_with_mean(node, b);
            const double a = e.scatter[k];
            if (lit && std::is_same_v<decltype(node), PatchId>) f = {};
            const Affine& g = indirect[k];
            sources.at(node, b) = {
                a * (f.gradient + g.gradient),
                e.emission[k] - coarse.split_emission(element, b) + a * (f.constant + g.constant)};
        }
    };
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) fill(z, element_above(z, e.of_zone));
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) fill(p, element_above(p, e.of_patch));
    if (options_.radiance == Radiance::constant) flatten(forest, sources);
    coarsen(forest, sources);
    return sources;
}

// Gives the zones of the sources what has been gathered there.
void Loop::update_zones(IndirectRefiner& indirect, Fields& sources) {
    const Forest& forest = mesh_.forest();
    extend(forest, sources);
    for (const ZoneId z : mesh_.zones()) {
        if (!forest.is_leaf(z)) continue;
        const MediumOptics& optics = enclosure_->media[medium_of(*enclosure_, forest, z)];
        for (std::size_t b = 0; b < sources.bands; ++b) {
            const Affine d = direct_with_mean(z, b), i = indirect.field(z, b);
            sources.at(z, b) = {optics.albedo[b] * (d.gradient + i.gradient),
                                optics.emission[b] + optics.albedo[b] * (d.constant + i.constant)};
        }
    }
    if (options_.radiance == Radiance::constant) flatten(forest, sources);
    coarsen(forest, sources);
}

Solution Loop::collect(const CoarseSolution& coarse, IndirectRefiner& indirect) {
    const Forest& forest = mesh_.forest();
    const std::size_t bands = enclosure_->bands;
    Solution solution;
    solution.enclosure = enclosure_;
    solution.direct_light = options_.direct_light;
    solution.direct.resize(forest, bands);
    solution.indirect.resize(forest, bands);
    solution.zone_error.resize(forest.zone_count());
    solution.patch_error.resize(forest.patch_count());
    const auto fill = [&](auto node, float& error) {
        for (std::size_t b = 0; b < bands; ++b) {
            // Zones are seen as integrals along rays, where the mean counts; patches are seen as
            // they are, where a jump from one to the next would show.
            if constexpr (std::is_same_v<decltype(node), ZoneId>)
                solution.direct.at(node, b) = direct_with_mean(node, b);
            else
                solution.direct.at(node, b) = direct_field(node, b);
            solution.indirect.at(node, b) = indirect.field(node, b);
        }
        error = static_cast<float>(direct_.error(node) + indirect.error(node));
    };
    for (const ZoneId z : mesh_.zones())
        if (forest.is_leaf(z)) fill(z, solution.zone_error[z.value]);
    for (const PatchId p : mesh_.patches())
        if (forest.is_leaf(p)) fill(p, solution.patch_error[p.value]);
    if (options_.radiance == Radiance::constant) {
        flatten(forest, solution.direct);
        flatten(forest, solution.indirect);
    }
    solution.forest = forest;
    solution.coarse = coarse.values(incident_direct_);
    return solution;
}

Report Loop::finish(const CoarseSolution& coarse) {
    Report report;
    report.patches = mesh_.patch_leaf_count();
    report.zones = mesh_.zone_leaf_count();
    report.solved_elements = coarse.elements().size();
    report.passes = passes_;
    report.solver = coarse.report();
    report.stopped = stopped_;
    report.lost_rays = coarse.lost_rays();
    report.estimated_error = std::sqrt(squared_error_);
    for (std::size_t b = 0; b < enclosure_->bands; ++b) {
        report.closure_error =
            std::max(report.closure_error, closure_error(coarse.areas(b), coarse.elements(), b));
        report.reciprocity_error = std::max(report.reciprocity_error,
                                            reciprocity_error(coarse.areas(b), coarse.elements()));
    }
    const Balance power =
        balance(*enclosure_, coarse, incident_direct_, light_, 16384, options_.seed);
    report.net_power = power.net_power;
    report.energy_balance = power.energy_balance;
    report.direct_power_check = power.direct_power_check;
    report.warnings = enclosure_->warnings;
    warn_of_thick_zones(*enclosure_, coarse, report);
    if (out_of_time_)
        report.warnings.push_back(
            fmt::format("refinement ended at max_time = {} s; the estimated error is {:.3g}.",
                        options_.max_time, report.estimated_error));
    if (limited_ && report.estimated_error > options_.error)
        report.warnings.push_back(
            fmt::format("refinement ended at a limit (max_elements = {}, max_memory = {} bytes) "
                        "before the error "
                        "goal of {}.",
                        options_.max_elements, options_.max_memory, options_.error));
    if (!report.solver.converged)
        report.warnings.push_back(
            fmt::format("the solver did not converge: residual {:.2e} after {} iterations.",
                        report.solver.residual, report.solver.iterations));
    return report;
}

}  // namespace

Solution solve_adaptively(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
                          const std::optional<View>& view, const ProgressCallback& progress) {
    if (options.exchange != "walked")
        throw mesh::InputError(fmt::format("there is no exchange method \"{}\". Choose \"walked\".",
                                           options.exchange));
    if (options.solver != "gmres")
        throw mesh::InputError(
            fmt::format("there is no solver \"{}\". Choose \"gmres\".", options.solver));
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    return Loop(std::move(enclosure), options, view, progress).run();
}

}  // namespace tyndall::radiosity
