#include "view/pass_meshes.h"

#include "radiosity/coarsen_nodes.h"

namespace tyndall::view {
namespace {

using mesh::PatchId;
using mesh::ZoneId;
using radiosity::Affine;
using radiosity::Fields;
using radiosity::Forest;
using radiosity::none;
using radiosity::Solution;

constexpr std::uint32_t patch_bit = 0x80000000u;  // Forest::Bisection::node

// Bisections are done again, as far as counts of elements go.
class History {
  public:
    explicit History(const Solution& solution) : s_(&solution) {
        const auto& e = *s_->enclosure;
        for (std::size_t t = 0; t < e.mesh.tets.size(); ++t) zones_ += lit(ZoneId(t));
        for (std::size_t p = 0; p < 2 * e.mesh.facets.size(); ++p) patches_ += lit(PatchId(p));
    }

    bool lit(ZoneId zone) const {
        return radiosity::medium_of(*s_->enclosure, s_->forest, zone) != none;
    }
    bool lit(PatchId patch) const {
        return radiosity::side_of(*s_->enclosure, s_->forest, patch) != none;
    }

    // Steps until there are so many elements; false: there never are from here on.
    bool go_to(std::size_t patches, std::size_t zones) {
        while (patches_ < patches || zones_ < zones) {
            if (done_ == s_->forest.history().size()) return false;
            const auto node = s_->forest.history()[done_++].node;
            if ((node & patch_bit) != 0)
                patches_ += lit(PatchId(node & ~patch_bit));
            else
                zones_ += lit(ZoneId(node));
        }
        return patches_ == patches && zones_ == zones;
    }
    std::size_t done() const { return done_; }

  private:
    const Solution* s_;
    std::size_t patches_ = 0, zones_ = 0, done_ = 0;
};

// How many bisections had been done when each mesh was ready.
std::vector<std::size_t> ends_of_passes(const Solution& s, std::vector<PassMesh>& meshes) {
    std::vector<std::size_t> ends;
    History history(s);
    for (const auto& pass : s.report.passes) {
        History tried = history;
        if (!tried.go_to(pass.patches, pass.zones)) continue;
        history = tried;
        if (!meshes.empty() && meshes.back().patches == pass.patches &&
            meshes.back().zones == pass.zones) {
            meshes.back().passes += ", " + pass.stage;
            continue;
        }
        meshes.push_back({pass.stage, pass.patches, pass.zones});
        ends.push_back(history.done());
    }
    return ends;
}

template <class Node>
void average(const Forest& forest, std::size_t nodes, std::size_t bands,
             std::vector<double>& values) {
    if (values.empty()) return;
    for (std::size_t n = nodes; n-- > 0;) {
        const Node parent(n);
        if (forest.is_leaf(parent)) continue;
        const Node first = forest[parent].first_child, second(first.value + 1ull);
        const double s0 = radiosity::size_of(forest, first),
                     s1 = radiosity::size_of(forest, second);
        const double w = s0 + s1 > 0.0 ? s0 / (s0 + s1) : 0.5;
        for (std::size_t b = 0; b < bands; ++b)
            values[n * bands + b] =
                w * values[first.value * bands + b] + (1.0 - w) * values[second.value * bands + b];
    }
}

}  // namespace

PassMeshes pass_meshes(const Solution& s) {
    PassMeshes result;
    const auto ends = ends_of_passes(s, result.meshes);
    const auto& history = s.forest.history();
    result.zone_born.assign(s.forest.zone_count(), 0);
    result.patch_born.assign(s.forest.patch_count(), 0);
    if (ends.empty()) return result;
    // What was bisected after the last pass that is known belongs to no pass: the mesh is not told.
    if (ends.back() != history.size()) {
        result.meshes.clear();
        return result;
    }
    std::size_t mesh = 0;
    for (std::size_t k = 0; k < history.size(); ++k) {
        while (k >= ends[mesh]) ++mesh;
        const auto born = static_cast<std::int32_t>(mesh);
        const auto mark = [&](auto node, std::vector<std::int32_t>& of) {
            const auto first = s.forest[node].first_child.value;
            of[first] = of[first + 1ull] = born;
        };
        if ((history[k].node & patch_bit) != 0)
            mark(PatchId(history[k].node & ~patch_bit), result.patch_born);
        else
            mark(ZoneId(history[k].node), result.zone_born);
    }
    return result;
}

Solution with_inner_nodes(const Solution& solution) {
    Solution s = solution;
    for (Fields* fields : {&s.direct, &s.indirect}) {
        radiosity::coarsen(s.forest, *fields);
        radiosity::coarsen_nodes<PatchId>(s.forest, s.forest.patch_count(), *fields);
    }
    const std::size_t bands = s.enclosure->bands;
    average<ZoneId>(s.forest, s.forest.zone_count(), bands, s.settled.zone);
    average<PatchId>(s.forest, s.forest.patch_count(), bands, s.settled.patch);
    return s;
}

}  // namespace tyndall::view
