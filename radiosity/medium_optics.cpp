#include "radiosity/medium_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <numbers>

#include "mesh/input_error.h"

namespace tyndall::radiosity {
namespace {

// One medium.
class Varying {
  public:
    Varying(const Medium& medium, std::vector<TetId> tets, const SampleOptions& options,
            Enclosure& enclosure, MediumOptics& optics)
        : medium_(medium),
          tets_(std::move(tets)),
          options_(options),
          e_(enclosure),
          optics_(optics) {
        low_ = Point(std::numeric_limits<double>::max());
        high_ = -low_;
        for (const TetId tet : tets_)
            for (const auto corner : e_.mesh.tets[tet.value]) {
                low_ = glm::min(low_, e_.mesh.points[corner.value]);
                high_ = glm::max(high_, e_.mesh.points[corner.value]);
            }
    }

    void bind() {
        refuse_heat();
        const std::size_t shapes = medium_.shape.size();
        if (shapes != 1 && shapes != e_.bands)
            throw mesh::InputError(fmt::format(
                "{} has {} shapes of its extinction for {} bands. Give one, or one a band.",
                named(), shapes, e_.bands));
        std::vector<SampledFunction> sampled;
        for (const ExtinctionShape& shape : medium_.shape) sampled.push_back(sample(shape));
        if (std::ranges::all_of(sampled, &SampledFunction::uniform)) {
            for (std::size_t b = 0; b < e_.bands; ++b) {
                optics_.extinction[b] *= sampled[shapes == 1 ? 0 : b].first;
                optics_.absorption[b] *= sampled[shapes == 1 ? 0 : b].first;
                optics_.scattering[b] *= sampled[shapes == 1 ? 0 : b].first;
            }
            return;
        }
        for (std::size_t b = 0; b < e_.bands; ++b)
            optics_.varying.push_back({sampled[shapes == 1 ? 0 : b].grid, optics_.extinction[b]});
        for (std::size_t b = 0; b < e_.bands; ++b) {
            const double mean = this->mean(optics_.varying[b]);
            optics_.absorption[b] *= mean;
            optics_.scattering[b] *= mean;
            optics_.extinction[b] *= mean;
        }
    }

  private:
    std::string named() const {
        return medium_.where.empty()
                   ? fmt::format("medium \"{}\"", medium_.name)
                   : fmt::format("{}: medium \"{}\"", medium_.where, medium_.name);
    }

    void refuse_heat() const {
        const bool still = std::ranges::all_of(medium_.heat, [](double q) { return q == 0.0; });
        if (still && !optics_.settled_heat) return;
        throw mesh::InputError(fmt::format(
            "{} has {}, and an extinction that varies in space: it needs an extinction that is the "
            "same everywhere. Give one number, or emission or temperature in place of heat.",
            named(), still ? "heat in several bands" : "a heat source"));
    }

    SampledFunction sample(const ExtinctionShape& shape) const {
        if (const auto* grid = std::get_if<std::shared_ptr<const RegularGrid>>(&shape.values))
            return {*grid, false, 0.0, 0.0};
        const auto& function = std::get<std::function<double(Point)>>(shape.values);
        try {
            SampledFunction result = sample_function(function, low_, high_, options_);
            if (result.error > options_.tolerance) warn(result);
            return result;
        } catch (const mesh::InputError& error) {
            const std::string where = shape.where.empty() ? "" : shape.where + ": ";
            throw mesh::InputError(fmt::format(
                "{}the extinction of medium \"{}\" is looked at in the box [{:.6g}, {:.6g}, "
                "{:.6g}] to [{:.6g}, {:.6g}, {:.6g}] m around the medium: {}. Write, for instance, "
                "max(0, …) around what may fall below 0.",
                where, medium_.name, low_.x, low_.y, low_.z, high_.x, high_.y, high_.z,
                error.what()));
        }
    }

    void warn(const SampledFunction& sampled) const {
        const auto& n = sampled.grid->counts();
        e_.warnings.push_back(fmt::format(
            "the extinction of medium \"{}\" changes faster than its grid of {} × {} × {} points "
            "follows: halfway between them it is off by up to {:.2g} % of its largest value. Where "
            "it jumps, an interface between two media is exact.",
            medium_.name, n[0], n[1], n[2], 100.0 * sampled.error));
    }

    // Of the shape over the medium [-].
    double mean(const ExtinctionBand& band) const {
        double amount = 0.0, volume = 0.0;
        for (const TetId tet : tets_) {
            std::array<Point, 4> corners;
            for (int k = 0; k < 4; ++k)
                corners[k] = e_.mesh.points[e_.mesh.tets[tet.value][k].value];
            const double size = mesh::volume(e_.mesh, tet);
            amount += size * over_tet({band.shape, 1.0}, corners).mean;
            volume += size;
        }
        return volume > 0.0 ? amount / volume : 0.0;
    }

    const Medium& medium_;
    std::vector<TetId> tets_;
    const SampleOptions& options_;
    Enclosure& e_;
    MediumOptics& optics_;
    Point low_, high_;
};

}  // namespace

MediumOptics medium_optics(const Medium& medium, const Enclosure& enclosure) {
    MediumOptics result;
    result.name = medium.name;
    result.phase = {medium.phase, medium.asymmetry};
    const bool heated = !medium.heat.empty() && !enclosure.settles();
    if (!medium.heat.empty() && enclosure.settles()) result.settled_heat = medium.heat[0];
    for (std::size_t b = 0; b < enclosure.bands; ++b) {
        const double scattering =
            medium.extinction[b] * medium.albedo[b] * (1.0 - medium.asymmetry);
        const double absorption = medium.extinction[b] * (1.0 - medium.albedo[b]);
        // Without a forward part that of the medium, to the bit, whatever its albedo.
        const double extinction =
            medium.extinction[b] * (1.0 - medium.albedo[b] * medium.asymmetry);
        const double albedo = extinction > 0.0 ? scattering / extinction : 0.0;
        result.extinction.push_back(extinction);
        result.absorption.push_back(absorption);
        result.scattering.push_back(medium.extinction[b] * medium.albedo[b]);
        result.albedo.push_back(heated ? 1.0 : albedo);
        double emission = medium.emission.empty() ? 0.0 : (1.0 - albedo) * medium.emission[b];
        if (heated && extinction > 0.0)
            emission = medium.heat[b] / (4.0 * std::numbers::pi * extinction);
        result.emission.push_back(emission);
    }
    return result;
}

void bind_varying(const Scene& scene, std::span<const std::size_t> claimed,
                  const SampleOptions& options, Enclosure& e) {
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
        if (scene.media[m].shape.empty()) continue;
        std::vector<TetId> tets;
        for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
            if (claimed[e.mesh.regions[t].value] == m) tets.push_back(TetId(t));
        if (tets.empty()) continue;  // it fills nothing
        Varying(scene.media[m], std::move(tets), options, e, e.media[m]).bind();
    }
}

bool Enclosure::varies() const {
    return std::ranges::any_of(media, [](const MediumOptics& m) { return !m.varying.empty(); });
}

Spectrum SurfaceSide::scattered() const {
    Spectrum result = reflectance;
    for (std::size_t b = 0; b < mirror.size(); ++b) result[b] -= mirror[b];
    return result;
}

bool Enclosure::has_mirrors() const {
    return std::ranges::any_of(sides, [](const SurfaceSide& side) { return !side.mirror.empty(); });
}

}  // namespace tyndall::radiosity
