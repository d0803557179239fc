#include "radiosity/steady_state.h"

#include <fmt/format.h>

#include <numeric>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

// Regions that light can pass between are one group, named by one of them.
class Groups {
  public:
    explicit Groups(const mesh::BaseMesh& mesh) : parent_(mesh.region_count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
        for (const auto& facet : mesh.facets)
            if (facet.opacity == mesh::Opacity::interface && facet.tets[0].valid() &&
                facet.tets[1].valid())
                parent_[of(mesh.regions[facet.tets[0].value].value)] =
                    of(mesh.regions[facet.tets[1].value].value);
    }
    std::uint32_t of(std::uint32_t region) {
        while (parent_[region] != region) region = parent_[region] = parent_[parent_[region]];
        return region;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

// What happens to light in a group of regions.
struct Fate {
    bool absorbed = false;  // for good, or it leaves the hull
    bool made = false;
    bool given_back = false;  // something absorbs that has a given flux or heat
    bool settled = false;     // and gives it back in other bands
};

bool gives_back(const SurfaceSide& side, std::size_t band) {
    return !side.emissivity.empty() && side.reflectance[band] > 1.0 - side.emissivity[band];
}

bool gives_back(const MediumOptics& medium, std::size_t band) {
    return (1.0 - medium.albedo[band]) * medium.extinction[band] < medium.absorption[band];
}

void add(Fate& fate, const SurfaceSide& side, std::size_t band) {
    const bool settled = side.settled_flux.has_value();
    if (!settled && side.reflectance[band] < 1.0) fate.absorbed = true;
    if (side.emission[band] != 0.0) fate.made = true;
    if (settled || gives_back(side, band)) fate.given_back = true;
    if (settled) fate.settled = true;
}

void add(Fate& fate, const MediumOptics& medium, std::size_t band) {
    const bool settled = medium.settled_heat.has_value();
    if (!settled && medium.albedo[band] < 1.0 && medium.extinction[band] > 0.0)
        fate.absorbed = true;
    if (medium.emission[band] > 0.0) fate.made = true;
    if (settled || gives_back(medium, band)) fate.given_back = true;
    if (settled) fate.settled = true;
}

class SteadyState {
  public:
    SteadyState(const Scene& scene, const Enclosure& enclosure)
        : scene_(scene), e_(enclosure), groups_(enclosure.mesh) {}

    void check() {
        std::vector<std::vector<Fate>> bands;
        for (std::size_t band = 0; band < e_.bands; ++band) bands.push_back(fates(band));
        for (std::uint32_t group = 0; group < e_.mesh.region_count; ++group) {
            if (groups_.of(group) != group || e_.region_solid[group]) continue;
            // What absorbs in one band ends the light of all where it can change its band.
            bool absorbed = false;
            for (const auto& fates : bands) absorbed = absorbed || fates[group].absorbed;
            for (const auto& fates : bands)
                if (!(fates[group].settled ? absorbed : fates[group].absorbed))
                    refuse(group, fates[group]);
        }
    }

  private:
    std::uint32_t group_of(TetId tet) { return groups_.of(e_.mesh.regions[tet.value].value); }

    std::vector<Fate> fates(std::size_t band) {
        std::vector<Fate> result(e_.mesh.region_count);
        for (std::size_t f = 0; f < e_.mesh.facets.size(); ++f)
            for (const int k : {0, 1})
                if (const auto side = e_.facet_sides[f][k]; side != none)
                    add(result[group_of(e_.mesh.facets[f].tets[k])], e_.sides[side], band);
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t) {
            if (e_.solid(TetId(t))) continue;
            Fate& fate = result[group_of(TetId(t))];
            for (const TetId next : e_.mesh.neighbours[t])
                if (!next.valid()) fate.absorbed = true;
            if (const auto medium = e_.medium_of(TetId(t)); medium != none)
                add(fate, e_.media[medium], band);
        }
        for (const Light& light : scene_.lights) {
            const auto* point = std::get_if<PointLight>(&light.source);
            const auto* spot = std::get_if<SpotLight>(&light.source);
            if (!point && !spot) continue;
            const TetId tet = mesh::locate(e_.mesh, point ? point->position : spot->position);
            if (tet.valid()) result[group_of(tet)].made = true;
        }
        return result;
    }

    void refuse(std::uint32_t group, const Fate& fate) {
        if (fate.given_back)
            throw mesh::InputError(fmt::format(
                "{}the closed region it bounds has no steady state: whatever absorbs in it has a "
                "given flux (adiabatic: 0) or a given heat and gives all back, so nothing says how "
                "hot it is. Give a wall or a medium a temperature, or open the region.",
                boundary_of(group)));
        if (fate.made)
            throw mesh::InputError(fmt::format(
                "{}the closed region it bounds has a source of light but nothing that absorbs "
                "(every reflectance is 1, every albedo 1) and no opening: its light grows for "
                "ever. Lower a reflectance or an albedo, or open the region.",
                boundary_of(group)));
    }

    // "file:line:column: surface "room.floor": " of the first surface that bounds the group.
    std::string boundary_of(std::uint32_t group) {
        for (std::size_t f = 0; f < e_.mesh.facets.size(); ++f)
            for (const int k : {0, 1}) {
                if (e_.facet_sides[f][k] == none) continue;
                if (group_of(e_.mesh.facets[f].tets[k]) != group) continue;
                const Surface& surface = scene_.surfaces[e_.sides[e_.facet_sides[f][k]].surface];
                return surface.where.empty()
                           ? fmt::format("surface \"{}\": ", surface.name)
                           : fmt::format("{}: surface \"{}\": ", surface.where, surface.name);
            }
        return {};
    }

    const Scene& scene_;
    const Enclosure& e_;
    Groups groups_;
};

}  // namespace

void refuse_unsteady(const Scene& scene, const Enclosure& enclosure) {
    SteadyState(scene, enclosure).check();
}

}  // namespace tyndall::radiosity
