#include "radiosity/element_grid.h"

#include <array>
#include <numbers>

#include "radiosity/leaves_in_order.h"
#include "radiosity/temperatures.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// x = e + a H of an element, with what of it is known.
struct Equation {
    double emission, scatter;
    Affine incident;  // H

    Affine radiance() const {
        return {scatter * incident.gradient, emission + scatter * incident.constant};
    }
};

template <class Node>
Equation equation(const Solution& s, Node node, std::size_t band) {
    const Affine direct = s.direct.at(node, band), indirect = s.indirect.at(node, band);
    return {emission_of(s, node, band),
            scatter_of(s, node, band),
            {direct.gradient + indirect.gradient, direct.constant + indirect.constant}};
}

// The arrays of the grid, filled element by element.
class Grid {
  public:
    explicit Grid(const Solution& solution)
        : s_(solution), e_(*solution.enclosure), bands_(e_.bands) {
        const Elements elements = leaves_in_order(e_, s_.forest);
        for (const PatchId patch : elements.patches) add(patch);
        for (const ZoneId zone : elements.zones) add(zone);
    }

    ElementGrid take() {
        ElementGrid grid;
        grid.bands = bands_;
        grid.points = std::move(points_);
        grid.connectivity = std::move(connectivity_);
        grid.offsets = std::move(offsets_);
        grid.types = std::move(types_);
        grid.radiance = std::move(radiance_);
        const auto add = [&](const std::string& name, std::size_t components, auto& values) {
            grid.cells.push_back({name, components, std::move(values)});
        };
        for (std::size_t k = 0; k < quantities; ++k) add(quantity_names[k], bands_, values_[k]);
        add("source_radiance_gradient", 3 * bands_, gradient_);
        if (e_.thermal) add("temperature", 1, temperature_);
        add("error", 1, error_);
        add("level", 1, level_);
        add("parent", 1, parent_);
        add("kind", 1, kind_);
        add("name_id", 1, name_id_);
        for (const auto& side : e_.sides) grid.names.push_back(side.name);
        for (const auto& medium : e_.media) grid.names.push_back(medium.name);
        return grid;
    }

  private:
    template <class Node>
    void add_common(Node node, Point centroid) {
        const auto& corners = s_.forest[node].corners;
        for (const VertexId corner : corners) {
            const Point p = s_.forest.point(corner);
            connectivity_.push_back(static_cast<std::int64_t>(points_.size() / 3));
            points_.insert(points_.end(), {p.x, p.y, p.z});
            for (std::size_t b = 0; b < bands_; ++b)
                radiance_.push_back(emission_of(s_, node, b) +
                                    scatter_of(s_, node, b) * (s_.direct.at(node, b).at(p) +
                                                               s_.indirect.at(node, b).at(p)));
        }
        offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
        const auto parent = s_.forest[node].parent;
        level_.push_back(static_cast<std::int32_t>(s_.forest[node].level));
        parent_.push_back(parent.valid() ? static_cast<std::int64_t>(parent.value) : -1);
        for (std::size_t b = 0; b < bands_; ++b) {
            const Equation q = equation(s_, node, b);
            const Affine radiance = q.radiance();
            const double x = radiance.at(centroid);
            for (int k = 0; k < 3; ++k) gradient_.push_back(radiance.gradient[k]);
            values_[radiosity].push_back(pi * x);
            values_[source_radiance].push_back(x);
            values_[incident].push_back(q.incident.at(centroid));
            values_[albedo].push_back(q.scatter);
        }
        if (e_.thermal) temperature_.push_back(temperature_of(s_, node));
    }

    // Of the material: a of the one equation is another where a flux is given.
    double rho(PatchId patch, std::size_t band) const {
        const SurfaceSide& side = e_.sides[side_of(e_, s_.forest, patch)];
        return side.emissivity.empty() ? side.reflectance[band] : 1.0 - side.emissivity[band];
    }

    void add(PatchId patch) {
        const Point centroid = s_.forest.centroid(patch);
        add_common(patch, centroid);
        types_.push_back(vtk_triangle);
        kind_.push_back(0);
        error_.push_back(s_.patch_error[patch.value]);
        name_id_.push_back(static_cast<std::int32_t>(side_of(e_, s_.forest, patch)));
        for (std::size_t b = 0; b < bands_; ++b) {
            const Equation q = equation(s_, patch, b);
            const double h = q.incident.at(centroid);
            values_[irradiance].push_back(pi * h);
            // x − H, written so that nothing cancels where everything is reflected.
            values_[net_flux].push_back(pi * (q.emission - (1.0 - q.scatter) * h));
            values_[flux_divergence].push_back(0.0);
            values_[emission].push_back(q.emission + (q.scatter - rho(patch, b)) * h);
            values_[extinction].push_back(0.0);
        }
    }

    void add(ZoneId zone) {
        const Point centroid = s_.forest.centroid(zone);
        add_common(zone, centroid);
        types_.push_back(vtk_tetra);
        kind_.push_back(1);
        error_.push_back(s_.zone_error[zone.value]);
        const auto medium = medium_of(e_, s_.forest, zone);
        name_id_.push_back(static_cast<std::int32_t>(e_.sides.size() + medium));
        const MediumOptics& optics = e_.media[medium];
        for (std::size_t b = 0; b < bands_; ++b) {
            const Equation q = equation(s_, zone, b);
            const auto [kappa, centre] = extinction_in(e_, s_.forest, zone, b);
            const double h = q.incident.at(centre);
            values_[irradiance].push_back(0.0);
            values_[net_flux].push_back(0.0);
            // 4 pi kappa_a (J_e − H), likewise.
            values_[flux_divergence].push_back(4.0 * pi * kappa *
                                               (q.emission - (1.0 - q.scatter) * h));
            // J_e, of a heated medium too: (1 − Omega) J_e = x − Omega H.
            const double absorbed =  // 1 − Omega
                optics.extinction[b] > 0.0 ? optics.absorption[b] / optics.extinction[b] : 0.0;
            values_[emission].push_back(
                absorbed > 0.0 ? (q.emission + (q.scatter - (1.0 - absorbed)) * h) / absorbed
                               : 0.0);
            values_[extinction].push_back(kappa);
        }
    }

    enum Quantity {
        radiosity,
        source_radiance,
        incident,
        irradiance,
        net_flux,
        flux_divergence,
        emission,
        extinction,
        albedo,
        quantities
    };
    static constexpr std::array<const char*, quantities> quantity_names{
        "radiosity",       "source_radiance", "incident",   "irradiance", "net_flux",
        "flux_divergence", "emission",        "extinction", "albedo"};

    const Solution& s_;
    const Enclosure& e_;
    std::size_t bands_;
    std::vector<double> points_, radiance_, gradient_, temperature_;
    std::vector<std::int64_t> connectivity_, offsets_{0}, parent_;
    std::vector<std::uint8_t> types_, kind_;
    std::vector<std::int32_t> level_, name_id_;
    std::vector<float> error_;
    std::array<std::vector<double>, quantities> values_;
};

}  // namespace

ElementGrid element_grid(const Solution& solution) {
    return Grid(solution).take();
}

}  // namespace tyndall::radiosity
