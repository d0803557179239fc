// What the zones of a solution send out in one direction, by their media's phase functions.
#pragma once

#include <span>
#include <vector>

#include "radiosity/direct_light.h"
#include "radiosity/gather.h"
#include "radiosity/solution.h"
#include "render/path_media.h"

namespace tyndall::render {

// The enclosure with extinction as it is in place of the reduced one.
radiosity::Enclosure with_whole_extinction(const radiosity::Enclosure& reduced);

// e of a leaf over the extinction as it is, not the reduced one [W/m^2/sr].
double emission_of_whole(const radiosity::Solution& solution, const radiosity::Enclosure& whole,
                         mesh::ZoneId leaf, std::uint32_t medium, std::size_t band);

// Purpose: J(x, ω) of every zone, for any direction ω of a ray that looks at it:
//     J = e + s^I(ω) H^I + s^A(ω) H^A                                                          (61)
//   with H^I and H^A the solution's linear functions, s^I a caller's, and s^A what Φ makes of
//   direct light over its mean, from where it comes at the leaf.
// Media that scatter evenly have s^A = Ω.
class TurnedSources {
  public:
    // Keeps references to all. Cost: direct light in closed form, twice a leaf.
    TurnedSources(const radiosity::Solution& solution, const radiosity::Enclosure& whole,
                  const PathMedia& media);

    // s^A of a leaf, with the light that whole extinction leaves on its way, or the reduced one,
    // over the solution's H^A (which is by the reduced one) [-].
    double direct(mesh::ZoneId leaf, std::size_t band, Direction ray, Coefficients on_way) const;

    // Mean of s^A over all zones, weighed by their direct light, over its mean over directions; 1
    // where there is none. From some hundred leaves [-].
    double brightness(Direction ray) const;

    // Gives all zones their J for rays along `ray`. `indirect`: s^I, [node * bands + band]; leaves
    // are taken, inner nodes are overwritten.
    // Cost: the nodes, and Φ once for each part of the direct light of each leaf.
    void fill(Direction ray, Coefficients on_way, std::vector<float>& indirect,
              radiosity::GatherScene& scene) const;

    // H^A that whole extinction leaves, over the solution's, of a patch; 1 where it is dark [-].
    double kept(mesh::PatchId leaf, std::size_t band) const {
        return patch_kept_[leaf.value * bands_ + band];
    }

  private:
    // A part of the direct light that arrives at a leaf, over all of it by reduced extinction.
    struct LightPart {
        float towards[3];
        std::uint32_t first;  // of shares_: one value a band
    };
    struct Parts {
        std::uint32_t begin = 0, end = 0;
    };
    struct LeafParts;

    std::uint32_t medium_of(mesh::ZoneId zone) const;
    void look_from_leaves(const radiosity::DirectLight& whole,
                          const radiosity::DirectLight& reduced);
    void look_from_patches(const radiosity::DirectLight& whole,
                           const radiosity::DirectLight& reduced);
    LeafParts parts_at(mesh::ZoneId leaf, const radiosity::DirectLight& whole,
                       const radiosity::DirectLight& reduced) const;
    void weigh_nodes();
    void choose_lit();

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    const radiosity::Enclosure& whole_;
    const PathMedia& media_;
    std::size_t bands_;
    std::vector<mesh::ZoneId> zones_;          // all nodes in media, parents before children
    std::array<std::vector<Parts>, 2> parts_;  // of zone nodes, by Coefficients
    struct Lit {
        mesh::ZoneId leaf;
        double weight;  // of its light in that of all
    };
    std::vector<Lit> lit_;  // some of the leaves with direct light
    std::vector<LightPart> all_parts_;
    std::vector<float> shares_;
    radiosity::Fields direct_, indirect_;         // of all nodes
    std::vector<float> emission_;                 // [node * bands + band]
    std::vector<float> of_direct_, of_indirect_;  // share of a node in its parent's light [-]
    std::vector<double> patch_kept_;
};

}  // namespace tyndall::render
