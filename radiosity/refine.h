// Where elements are too coarse for what they hold, and their refinement.
#pragma once

#include <algorithm>
#include <limits>

#include "radiosity/element_mesh.h"
#include "radiosity/importance.h"
#include "radiosity/indicators.h"
#include "radiosity/progress.h"
#include "radiosity/sampled_means.h"
#include "radiosity/shadow_cuts.h"

namespace tyndall::radiosity {

struct RefineLimits {
    std::size_t max_elements = 300000;
    std::size_t max_memory = 2ull << 30;  // [byte]
    std::size_t max_rounds = 100;         // a leaf is bisected once in each
    double smallest_edge = 0.0;  // an element whose longest edge is below is left alone [m]
    bool grow = true;            // else only leaves that are there already are descended to
};

struct RefineResult {
    double squared_error = 0.0;  // share of the squared relative error that remains [-]
    bool limited = false;        // a limit ended it, not the goal
    bool stopped = false;        // the caller did
    std::size_t rays = 0;
};

// Purpose: how much it counts what direct light is at the ends of a zone, beside its mean. One that
//   is thin is seen through, and a function that fits best in the mean is best. From a thick one
//   most light comes from its near end; there light that decays across it is not nearly linear.
// Equation: min(1, (κ h / τ)²), h the longest edge, τ = 0.25. Measured: E at the bottom of cubes
//   (tests/reference, 4def) is 1.4 % too low with zones of 0.4 that are taken for thin.
double share_of_ends(const Enclosure& enclosure, const Forest& forest, ZoneId zone);

// Direct light at elements: how far linear interpolation between corners is from the value in the
// middle of every edge and at the centroid. Those points double as quadrature points of the
// element's mean.
//
// Source: Cohen et al. (1986) for surfaces, Rushmeier (1988) for volumes: values of new elements
// are computed anew, not interpolated.
class DirectRefiner {
  public:
    // `boundaries`: of shadows, along which elements are cut; null: none. `radiance`: what leaves
    // are to hold.
    DirectRefiner(const Enclosure& enclosure, ElementMesh& mesh, const DirectLight& light,
                  const ShadowBoundaries* boundaries = nullptr,
                  Radiance radiance = Radiance::linear);

    // Evaluates what is new in the mesh.
    void update();
    // What leaves are bisected for, beside the jumps of `boundaries`.
    struct Asked {
        bool direct = true;                       // departures from linear
        std::function<IndicatedErrors()> more{};  // of the leaves there are; empty: none
        std::function<void()> bisected{};         // called when all leaves have their light again
    };
    // Bisects until Σ share ≤ goal, or a limit; share = weight (a error)², or weight error² of the
    // errors of `more`, which are those of what an element sends out. The largest counts.
    RefineResult refine(const Importance& importance, double goal, const RefineLimits& limits,
                        const ProgressCallback& progress, const Asked& asked = {true, {}, {}});

    // Gives means by many points to the leaves that are left with an error which the power of all
    // direct light would feel. To be called where refinement ends.
    void sample_means();
    // Mean of H^A over a leaf: sampled, or by the degree-2 rule of corners and centroid.
    double mean(ZoneId zone, std::size_t band);
    double mean(PatchId patch, std::size_t band);
    // H^A of a zone that has been sampled, the function nearest to it; null of others.
    const LeafFunction* fitted(ZoneId zone, std::size_t band) const {
        const LeafFunction* fits = sampled_.fit(zone);
        return fits ? fits + band : nullptr;
    }
    // Evaluates what marks of the mesh have made new since `update`, at all leaves: to be called
    // before `mean_difference`.
    void light_middles();
    // That mean less the one by the degree-2 rule that uses the middles of edges: exact for
    // quadratics, both miss what jumps, each in its own way.
    double mean_difference(ZoneId zone, std::size_t band);
    double mean_difference(PatchId patch, std::size_t band);
    // Error of what a leaf holds, from the departures at its edges' middles and centroid and from
    // jumps across it: as chords of a zone see it, as it stands on a patch [W/m^2/sr].
    double error(ZoneId zone) const {
        return std::max<double>(zone_error_[zone.value], cuts_ ? cuts_->error(zone) : 0.0);
    }
    double error(PatchId patch) const {
        return std::max<double>(patch_error_[patch.value], cuts_ ? cuts_->error(patch) : 0.0);
    }

  private:
    void make_samples(const std::vector<ZoneId>& zones, const std::vector<PatchId>& patches);
    struct Candidate {
        double share;
        std::uint32_t index;
        bool is_zone;
        bool to_cut;        // along a shadow's edge
        bool longest_edge;  // not that of the largest departure
    };
    template <class Node>
    void measure(Node node, std::vector<float>& errors, std::vector<std::uint8_t>& edges,
                 const std::vector<double>& centroid);
    // Deviation of H^A from the linear function nearest to it, by the samples there are.
    double left_by_linear(ZoneId zone, const std::vector<double>& centroid);
    double collect(const Importance& importance, const RefineLimits& limits, const Asked& asked,
                   std::vector<Candidate>& candidates) const;
    bool keep_worst(std::vector<Candidate>& candidates, double& evenness, double sum,
                    double goal) const;
    void bisect(const Candidate& candidate, std::size_t max_leaves);
    // What the larger of its own error and its jump is worth on a leaf.
    template <class Node>
    double worst_error(Node node) const {
        return std::max(error(node), cuts_ ? cuts_->error(node) : 0.0);
    }

    const Enclosure& enclosure_;
    ElementMesh& mesh_;
    const DirectLight& light_;
    std::optional<ShadowCuts> cuts_;
    SampledMeans sampled_;
    double left_;  // share of what linear functions leave that is left by those of the leaves
    std::size_t bands_;
    std::size_t zones_done_ = 0, patches_done_ = 0;       // entries of the mesh's lists
    std::vector<float> zone_error_, patch_error_;         // by node
    std::vector<std::uint8_t> zone_edge_, patch_edge_;    // 4 i + j of the edge to bisect, by node
    std::vector<double> zone_centroid_, patch_centroid_;  // H^A at centroids, by node and band
};

// What indirect light is gathered from.
struct IndirectSources {
    Fields fields;                     // r of the leaves, coarsened, without what look.lit holds
    OnPurpose look{};                  // at what patches reflect of direct light, at bright places
    double detail = 0.0;               // see GatherScene [-]
    std::vector<Affine> in_mirrors{};  // GatherScene::set_in_mirrors
    std::vector<Affine> lit{};         // GatherScene::set_lit

    // What gathers walk through with these.
    GatherScene scene(const Enclosure& enclosure, const Forest& forest) const;
};

// Indirect light: gathered at the corners of the coarse elements and in the middle of their edges;
// where interpolation departs by more than the noise of the gather, the element is bisected and so
// on. An element below one that was found good enough takes over its linear function.
class IndirectRefiner {
  public:
    // The goal of a refinement that is to end where it begins.
    static constexpr double no_goal = std::numeric_limits<double>::infinity();

    // `coarse`: the elements where the descent starts; `radiance`: what leaves are to hold.
    IndirectRefiner(const Enclosure& enclosure, ElementMesh& mesh, const Elements& coarse,
                    std::size_t rays, std::uint64_t seed, Radiance radiance = Radiance::linear);

    // Zones first, from the coarse solution; then patches, which see the haze beside them, from
    // sources in which the zones' values stand already. Sources by value: new nodes take over their
    // parents' functions on the way.
    RefineResult refine_zones(IndirectSources sources, const Importance& importance, double goal,
                              const RefineLimits& limits, const ProgressCallback& progress);
    RefineResult refine_patches(IndirectSources sources, const Importance& importance, double goal,
                                const RefineLimits& limits, const ProgressCallback& progress);

    // The nodes where a descent has ended, by node, and patches found linear there.
    struct Ends {
        std::vector<bool> zones, patches, linear_patches;
    };
    // Those of this refinement.
    Ends settled() const { return {zones_.flags, patches_.flags, patches_.linear}; }
    // A descent in the same forest before bodies moved ended there: this one goes on only where the
    // error has grown to twice what an element may have. Light on bodies is new, but bends over
    // their elements about as it did: what was linear is gathered at corners alone, if these do not
    // differ by so much that more could be between them.
    void begin_with(const Ends& before) { before_ = &before; }

    // The linear function of a leaf: its own, or that of the settled element above it.
    Affine field(ZoneId zone, std::size_t band);
    Affine field(PatchId patch, std::size_t band);
    // What a leaf is to hold: of a patch all that the settled element keeps, where leaves are to be
    // quadratic. Zones are linear: what they hold too coarsely comes from the coarse solution.
    Affine function(ZoneId zone, std::size_t band) { return field(zone, band); }
    LeafFunction function(PatchId patch, std::size_t band);
    // One throw of the noise in that function, from the half differences of its samples.
    Affine noise(ZoneId zone, std::size_t band);
    Affine noise(PatchId patch, std::size_t band);
    // Error of a leaf: what is left of the departure from linear found at the settled element; all
    // of it where a patch is linear and has no leaves that show more, mean over bands [W/m^2/sr].
    double error(ZoneId leaf) const { return zones_.errors[settled_above(leaf).value]; }
    double error(PatchId leaf) const;

  private:
    // By node: where the descent ended, and the error left there.
    struct Settled {
        std::vector<bool> flags, linear;
        std::vector<float> errors;
        void resize(std::size_t nodes) {
            flags.resize(nodes);
            linear.resize(nodes);
            errors.resize(nodes);
        }
    };
    Settled& settled_of(ZoneId) { return zones_; }
    Settled& settled_of(PatchId) { return patches_; }
    const Settled& settled_of(ZoneId) const { return zones_; }
    const Settled& settled_of(PatchId) const { return patches_; }
    const std::vector<bool>& before_of(ZoneId) const { return before_->zones; }
    const std::vector<bool>& before_of(PatchId) const { return before_->patches; }
    // Whether the descent before ended at the node, or above it.
    template <class Node>
    bool ended_before(Node node) const {
        while (before_ && node.valid() && !is_set(before_of(node), node.value))
            node = mesh_.forest()[node].parent;
        return before_ && node.valid();
    }
    static bool is_set(const std::vector<bool>& flags, std::size_t k) {
        return k < flags.size() && flags[k];
    }
    template <class Node>
    Node settled_above(Node node) const;
    template <class Node>
    RefineResult refine(std::vector<Node> frontier, IndirectSources sources,
                        const Importance& importance, double goal, const RefineLimits& limits,
                        const ProgressCallback& progress);
    // Of a sample and band: H, or its noise.
    using SampleValue = double (SampleSet::*)(SampleId, std::size_t) const;
    template <class Node>
    auto quadratic(Node node, std::size_t band, SampleValue value);
    template <class Node>
    Affine linear_part(Node leaf, std::size_t band);
    template <class Node>
    Affine noise_part(Node leaf, std::size_t band);
    void divide(const std::vector<PatchId>& patches, const RefineLimits& limits);
    bool room_for_more(const RefineLimits& limits) const;
    double scatter(ZoneId zone) const;
    double scatter(PatchId patch) const;
    void bisect(ZoneId zone, std::array<int, 2> edge) { mesh_.bisect(zone, edge); }
    void bisect(PatchId patch, std::array<int, 2>) { mesh_.bisect(patch); }
    // At corners and middles of the elements; where corners will do, at these alone. Returns rays.
    template <class Node, class Share>
    std::size_t gather(const std::vector<Node>& frontier, const IndirectSources& sources,
                       const Share& share, double threshold);
    template <class Node>
    void add_middles(Node node, std::vector<SampleId>& ids);
    // On a body that has moved.
    bool was_linear(ZoneId) const { return false; }
    bool was_linear(PatchId patch) const;
    // The error at most, if light bends by no more than its corners differ.
    template <class Node>
    double error_by_corners(Node node);
    // Error beyond the noise, and the edge where it is largest.
    template <class Node>
    std::pair<double, std::array<int, 2>> measure(Node node);

    const Enclosure& enclosure_;
    ElementMesh& mesh_;
    const Elements& coarse_;
    // Zones are seen many at a time, and need a quarter of the rays.
    PointSet on_surfaces_, in_zones_;
    std::uint64_t seed_;
    bool quadratic_;  // patches; else they are given leaves that show what one would hold
    Settled zones_, patches_;
    const Ends* before_ = nullptr;
};

}  // namespace tyndall::radiosity
