#include "radiosity/adaptive.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "radiosity/balance.h"
#include "radiosity/collect_solution.h"
#include "radiosity/error_estimate.h"
#include "radiosity/incident_lit.h"
#include "radiosity/leaf_light.h"
#include "radiosity/resources.h"
#include "radiosity/solve_checks.h"
#include "radiosity/solve_report.h"
#include "radiosity/start_elements.h"
#include "radiosity/temperatures.h"
#include "radiosity/thick_zones.h"
#include "radiosity/view_radiance.h"

namespace tyndall::radiosity {
namespace {

// How the squared error goal is shared out. Errors of direct light have either sign from leaf to
// leaf; those of zones' indirect light are smooth and add up along a ray, and need leaves only
// where direct light has made none: they get little of what is left. Patches get the rest.
constexpr double direct_share = 0.78, zone_share = 0.1;

// A gather's zone may stand for its leaves when it is no longer than this many spacings of its
// rays: measured, 1 and 4 give the same picture, 4 in half the time.
constexpr double detail_factor = 4.0;

// What the linear system may leave where bodies have moved, of the goal and at most: what is kept
// of the solution before is no better, and powers of small bodies bear no more.
constexpr double moved_tolerance = 1e-2, most_moved_tolerance = 2e-4;

// A mesh that is going to be promoted needs to be this much coarser than the next.
constexpr double coarser_goal = 4.0;

// Of max_elements: up to here zones of the coarse solution are bisected for their thickness. Rows
// cost more than leaves.
constexpr double thick_elements_share = 0.2;

// The loop's state, step by step; each step leaves something that a valid solution can be made of.
class Loop {
  public:
    Loop(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
         const std::optional<View>& view, const ProgressCallback& progress, const Passes& passes)
        : enclosure_(std::move(enclosure)),
          options_(options),
          kept_(passes),
          camera_(view),
          view_(view),
          progress_([this, progress, began = wall_seconds()](const Progress& now) {
              out_of_time_ = options_.max_time > 0.0 && wall_seconds() - began > options_.max_time;
              return !out_of_time_ && (!progress || progress(now));
          }),
          light_(*enclosure_, {.emitters = options.direct_light == DirectLightMode::closed_form}),
          mesh_(*enclosure_),
          boundaries_(shadow_boundaries(*enclosure_, options)),
          direct_(*enclosure_, mesh_, light_, boundaries_ ? &*boundaries_ : nullptr,
                  options.radiance),
          leaf_light_(*enclosure_, mesh_, direct_, options.radiance) {
        if (options_.refinement < Refinement::view) view_.reset();
        if (options_.shots == Shots::rows && !kept_.moved) sharing_ = kept_.rows;
        if (kept_.keep) light_.keep_in(&kept_.keep->direct);
        if (kept_.moved) {
            light_.take_from(kept_.moved->direct, kept_.moved->enclosure->mesh.bodies);
            options_.solver_tolerance =
                std::max(options_.solver_tolerance,
                         std::min(moved_tolerance * options_.error, most_moved_tolerance));
        }
        begin_pass();
    }

    Solution run() {
        make_initial_mesh();
        Elements elements = start_elements(*enclosure_, mesh_.forest(), options_.start);
        if (!kept_.moved && adaptive() && asks_for(options_, "optical_thickness") &&
            options_.start != Start::single_zone && refine_thick_zones(elements))
            elements = elements_of_leaves(*enclosure_, mesh_.forest());
        for (std::size_t promotions = options_.promotions;; --promotions) {
            const double looser = std::pow(coarser_goal, promotions);
            Solution solution = turn(std::move(elements), looser, promotions == 0);
            if (promotions == 0 || stopped_ || limited_) return solution;
            elements = elements_of_leaves(*enclosure_, mesh_.forest());
            mesh_.samples().forget_indirect();
        }
    }

  private:
    // Coarse solution of the elements, refinement to `looser` times the error, gather.
    Solution turn(Elements elements, double looser, bool last) {
        const double goal = looser * looser * options_.error * options_.error;
        std::optional<KeptRows> rows;
        if (kept_.moved)
            rows.emplace(KeptRows{
                {*kept_.moved->enclosure, kept_.moved->coarse_forest, kept_.moved->elements},
                *kept_.moved->rows,
                kept_.moved->directions,
                kept_.moved->gathered_from.sent});
        if (kept_.keep) kept_.keep->coarse_forest = mesh_.forest();
        CoarseSolution coarse(*enclosure_, mesh_.forest(), std::move(elements), options_, progress_,
                              rows ? &*rows : nullptr, shared_rows());
        leave(coarse.rows());
        rays_ += coarse.rays();
        begin(coarse);

        const Importance importance(*enclosure_, mesh_.forest(), view_, scale_);
        if (last && kept_.begin_with) mesh_.replay(kept_.begin_with->forest);
        if (kept_.moved) mesh_.replay(kept_.moved->forest);
        direct_.update();
        note(direct_.refine(importance, adaptive() ? direct_share * goal : 1e300, limits(0.8),
                            progress_,
                            {asks_for(options_, "direct"), other_indicators(coarse),
                             [&] { show("direct light", coarse); }}));
        direct_.sample_means();
        const Fields reflected = leaf_light_.lit_patches();
        const LitPatches lit(*enclosure_, mesh_.forest(), reflected);
        solve(coarse, &lit);
        end_pass("direct light");
        if (saving(last)) kept_.save(collect(coarse));
        show("direct light", coarse);

        IndirectRefiner indirect(*enclosure_, mesh_, coarse.elements(), options_.gather_rays,
                                 options_.seed, options_.radiance);
        if (kept_.moved) indirect.begin_with(kept_.moved->settled);
        gather(coarse, lit, reflected, importance,
               refines() && asks_for(options_, "indirect") ? (1.0 - direct_share) * goal
                                                           : IndirectRefiner::no_goal,
               indirect);
        Solution solution =
            collect(coarse, [&](auto leaf, std::size_t b) { return indirect.function(leaf, b); });
        end_pass("indirect light");
        // Bodies that have moved change little of the coarse solution's error.
        const std::vector<double> carried =
            kept_.moved ? kept_.moved->coarse_errors
                        : coarse_errors(mesh_, direct_, leaf_light_, coarse, solution.indirect);
        if (kept_.keep) kept_.keep->coarse_errors = carried;
        const LeafErrors errors = leaf_errors(*enclosure_, mesh_, direct_, indirect, leaf_light_,
                                              coarse, carried, options_.radiance);
        estimate_errors(errors, camera_, solution);
        solution.report =
            solve_report(*enclosure_, coarse, incident_direct_, light_, options_,
                         {std::sqrt(squared_error_), solution.report.picture_error,
                          solution.report.solution_error, *escaped_direct_, direct_power_check_,
                          view_.has_value(), stopped_, limited_, out_of_time_});
        report_temperatures(solution);
        solution.report.patches = mesh_.patch_leaf_count();
        solution.report.zones = mesh_.zone_leaf_count();
        solution.report.passes = passes_;
        if (saving(last)) kept_.save(solution);
        if (!last && kept_.watch) kept_.watch("indirect light", [&] { return solution; });
        return solution;
    }

    // Of the elements that there are before any is bisected: those of the first coarse solution.
    std::shared_ptr<const RowSet> shared_rows() {
        return sharing_ ? sharing_->of(enclosure_, options_) : nullptr;
    }
    void leave(const std::shared_ptr<const RowSet>& rows) {
        if (const auto sharing = std::exchange(sharing_, {})) sharing->leave(rows);
    }

    // A first solution; of bodies that have moved the one before is near enough to weigh errors by.
    void begin(CoarseSolution& coarse) {
        if (kept_.moved) {
            scale_ = kept_.moved->scale;
            if (!(scale_.picture > 0.0)) view_.reset();
        } else {
            direct_.update();
            solve(coarse);
            rate(coarse);
        }
        squared_error_ = 0.0;
        end_pass("coarse solution");
        if (!kept_.moved) show("coarse solution", coarse);
    }

    // Indirect light of the leaves: zones first, then patches.
    void gather(const CoarseSolution& coarse, const LitPatches& lit, const Fields& reflected,
                const Importance& importance, double goal, IndirectRefiner& indirect) {
        IndirectSources sources{leaf_light_.sources(coarse, &lit),
                                {.lit = &lit},
                                gather_detail(),
                                leaf_light_.in_mirrors(coarse, true),
                                reflected.patch};
        const auto bright = bright_places(sources);
        sources.look.bright = bright.get();
        std::optional<GatherChange> change;
        if (kept_.moved)
            change.emplace(*kept_.moved,
                           GatherChange::Now{
                               *enclosure_, gathered_from(coarse, incident_direct_, incident_lit_)},
                           options_.error);
        mesh_.samples().take_from(change ? &*change : nullptr);
        mesh_.samples().keep_in(kept_.keep ? &kept_.keep->gathers : nullptr);
        const Fields in_zones = kept_.keep ? sources.fields : Fields{};
        RefineLimits all = limits(1.0);
        all.grow = !kept_.moved && !kept_.frozen;
        const auto zones =
            indirect.refine_zones(sources, importance, zone_share * goal, all, progress_);
        note(zones);
        direct_.update();
        direct_.sample_means();
        leaf_light_.update_zones(coarse, indirect, sources.fields);
        note(indirect.refine_patches(sources, importance,
                                     goal - std::min(zones.squared_error, zone_share * goal), all,
                                     progress_));
        direct_.update();
        direct_.sample_means();
        mesh_.samples().take_from(nullptr);
        if (kept_.keep) keep(coarse, in_zones, sources, lit, indirect);
        if (kept_.keep) kept_.keep->bright = bright;
    }

    // Where bodies have moved those before, so that the same rays are spread.
    std::shared_ptr<const BrightPlaces> bright_places(const IndirectSources& sources) const {
        if (kept_.moved) return kept_.moved->bright;
        if (!may_be_bright_somewhere(*enclosure_)) return nullptr;
        return std::make_shared<const BrightPlaces>(
            *enclosure_, sources.scene(*enclosure_, mesh_.forest()), sources.look, options_.seed);
    }

    void keep(const CoarseSolution& coarse, const Fields& in_zones,
              const IndirectSources& on_patches, const LitPatches& lit,
              const IndirectRefiner& indirect) {
        KeptLight& kept = *kept_.keep;
        light_.keep_in(nullptr);
        kept.take(coarse, incident_direct_, incident_lit_);
        kept.lit_in_middles = lit_in_middles(*enclosure_, mesh_.forest(), coarse.elements(), lit);
        kept.scale = scale_;
        kept.settled = indirect.settled();
        kept.finish(enclosure_, mesh_.forest(), in_zones, on_patches.fields, on_patches.detail);
    }

    // Before the last turn the mesh to begin with is not in yet: what there is, is coarser.
    bool saving(bool last) const { return kept_.save && (last || !kept_.begin_with); }
    bool refines() const { return options_.refinement >= Refinement::adaptive; }
    bool adaptive() const { return refines() && !kept_.frozen; }
    // `share` of the elements allowed: what direct light may not use is left for indirect light.
    RefineLimits limits(double share) const {
        const auto& base = enclosure_->mesh;
        return {static_cast<std::size_t>(share * static_cast<double>(options_.max_elements)),
                options_.max_memory, options_.max_passes,
                1e-4 * glm::distance(base.hull_min, base.hull_max)};
    }
    double gather_detail() const {
        return detail_factor * std::sqrt(4.0 * M_PI / static_cast<double>(options_.gather_rays));
    }

    // Those that look at what leaves send out as a whole.
    std::function<IndicatedErrors()> other_indicators(const CoarseSolution& coarse);
    bool refine_thick_zones(const Elements& elements);
    void make_initial_mesh();
    void solve(CoarseSolution& coarse, const LitPatches* lit = nullptr);
    void rate(const CoarseSolution& coarse);
    template <class Field>
    Solution collect(const CoarseSolution& coarse, Field&& indirect) {
        return collect_solution({enclosure_, options_, mesh_, direct_, leaf_light_}, coarse,
                                incident_direct_, indirect);
    }
    // With indirect light as the coarse solution knows it.
    Solution collect(const CoarseSolution& coarse) {
        const Fields indirect = leaf_light_.indirect(coarse);
        return collect(coarse, [&](auto leaf, std::size_t b) { return indirect.at(leaf, b); });
    }

    void note(const RefineResult& result) {
        stopped_ = stopped_ || result.stopped;
        limited_ = limited_ || result.limited;
        rays_ += result.rays;
        squared_error_ += result.squared_error;
    }
    void show(const std::string& pass, const CoarseSolution& coarse) {
        if (!kept_.watch) return;
        const double cpu = cpu_seconds(), wall = wall_seconds();
        kept_.watch(pass, [&] { return collect(coarse); });
        cpu_ += cpu_seconds() - cpu;  // is no part of the pass
        wall_ += wall_seconds() - wall;
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
    Passes kept_;
    std::shared_ptr<SharedRows> sharing_;  // Passes::rows, until the first rows are made
    std::optional<View> camera_;           // whose picture's error is estimated
    std::optional<View> view_;             // for which is refined
    ProgressCallback progress_;
    DirectLight light_;
    ElementMesh mesh_;
    std::optional<ShadowBoundaries> boundaries_;  // along which elements are cut
    DirectRefiner direct_;
    LeafLight leaf_light_;
    std::vector<double> incident_direct_;  // of the coarse elements
    std::vector<double> incident_lit_;     // the same, from lit patches
    std::optional<Escaped> escaped_direct_;
    double direct_power_check_ = 0.0;
    Importance::Scale scale_;
    std::vector<PassReport> passes_;
    double squared_error_ = 0.0;
    bool stopped_ = false, limited_ = false, out_of_time_ = false;
    double cpu_ = 0.0, wall_ = 0.0;
    std::size_t rays_ = 0;
};

void Loop::make_initial_mesh() {
    if (kept_.moved) return mesh_.replay(kept_.moved->coarse_forest);
    radiosity::make_initial_mesh(mesh_, options_);
}

std::function<IndicatedErrors()> Loop::other_indicators(const CoarseSolution& coarse) {
    std::vector<Indicator> asked;
    if (asks_for(options_, "jump")) asked.push_back(jump_error);
    if (options_.indicator) asked.push_back(*options_.indicator);
    if (asked.empty()) return {};
    return [this, &coarse, asked] {
        return indicated_errors(asked, *enclosure_, mesh_, leaf_light_.sources(coarse));
    };
}

// Zones of the mesh that the coarse solution is made on, as a solution before it tells what their
// thickness costs. Whether any has been bisected.
bool Loop::refine_thick_zones(const Elements& elements) {
    if (!any_thick(*enclosure_, mesh_, options_.optical_thickness)) return false;
    CoarseSolution coarse(*enclosure_, mesh_.forest(), elements, options_, progress_, nullptr,
                          shared_rows());
    leave(coarse.rows());
    rays_ += coarse.rays();
    direct_.update();
    solve(coarse);
    rate(coarse);
    const std::size_t before = mesh_.leaf_count();
    bisect_thick_zones(*enclosure_, mesh_, {*enclosure_, mesh_.forest(), view_, scale_},
                       leaf_light_.sources(coarse),
                       {options_.optical_thickness, options_.error * options_.error,
                        limits(thick_elements_share).max_elements});
    direct_.update();
    end_pass("optical thickness");
    return mesh_.leaf_count() > before;
}

// Direct light of the leaves summed into the coarse elements above them, then the linear system.
// With `lit`, what patches reflect of it is not left to the rows.
void Loop::solve(CoarseSolution& coarse, const LitPatches* lit) {
    const Elements& e = coarse.elements();
    incident_direct_ = leaf_light_.means_of_direct(e);
    if (!escaped_direct_)
        escaped_direct_ = escaped_direct(*enclosure_, coarse, 16384, options_.seed);
    direct_power_check_ =
        conserve_direct_power(*enclosure_, e, light_, *escaped_direct_, incident_direct_);
    const std::size_t rays = coarse.rays();
    if (lit) {
        incident_lit_ = kept_.moved
                            ? moved_incident_lit(*kept_.moved, *enclosure_, mesh_.forest(), e, *lit)
                            : incident_lit(*enclosure_, mesh_.forest(), e, *lit);
        coarse.solve(incident_direct_, incident_lit_);
    } else {
        coarse.solve(incident_direct_);
    }
    rays_ += coarse.rays() - rays;  // of shots on the fly
}

// The picture's mean radiance and the solution's mean square, against which errors are measured.
void Loop::rate(const CoarseSolution& coarse) {
    scale_.solution = coarse.mean_square();
    if (!view_) return;
    GatherScene scene(*enclosure_, mesh_.forest(), leaf_light_.sources(coarse));
    scene.set_in_mirrors(leaf_light_.in_mirrors(coarse, false));
    scale_.picture = mean_radiance(scene, *enclosure_, *view_);
    if (!(scale_.picture > 0.0)) view_.reset();  // it sees nothing
}

}  // namespace

Solution solve_adaptively(std::shared_ptr<const Enclosure> enclosure, const SolveOptions& options,
                          const std::optional<View>& view, const ProgressCallback& progress,
                          const Passes& passes) {
    check_solve(*enclosure, options, passes);
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    return Loop(std::move(enclosure), options, view, progress, passes).run();
}

}  // namespace tyndall::radiosity
