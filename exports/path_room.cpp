#include "exports/path_room.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <tuple>

#include "mesh/input_error.h"
#include "render/glossy_lobe.h"

namespace tyndall::exports {
namespace {

using mesh::FacetId;
using mesh::InputError;
using mesh::Point;
using mesh::TetId;
using mesh::VertexId;
using radiosity::Enclosure;
using radiosity::none;
using radiosity::SurfaceSide;

constexpr double sheets_apart = 1e-5;  // of the hull's diagonal

double ratio(double part, double whole) {
    return whole > 0.0 ? part / whole : 0.0;
}

// Triangles of a sheet, with the mesh's points that they use.
class SheetBuilder {
  public:
    explicit SheetBuilder(const mesh::BaseMesh& mesh) : mesh_(mesh) {}

    void add(const std::array<VertexId, 3>& corners) {
        auto& triangle = triangles_.corners.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const auto [place, is_new] = index_.try_emplace(
                corners[k].value, static_cast<std::uint32_t>(triangles_.points.size()));
            if (is_new) triangles_.points.push_back(mesh_.points[corners[k].value]);
            triangle[k] = place->second;
        }
    }
    Triangles take() { return std::move(triangles_); }

  private:
    const mesh::BaseMesh& mesh_;
    Triangles triangles_;
    std::map<std::uint32_t, std::uint32_t> index_;
};

// The triangles from behind.
void turn(Triangles& triangles) {
    for (auto& corners : triangles.corners) std::swap(corners[1], corners[2]);
}

// Every triangle with points of its own, moved along its normal [m].
Triangles moved(const Triangles& triangles, double distance) {
    Triangles result;
    for (const auto& corners : triangles.corners) {
        std::array<Point, 3> p;
        for (int k = 0; k < 3; ++k) p[k] = triangles.points[corners[k]];
        const auto normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        const auto first = static_cast<std::uint32_t>(result.points.size());
        for (const Point& x : p) result.points.push_back(x + distance * normal);
        result.corners.push_back({first, first + 1, first + 2});
    }
    return result;
}

// "room.floor" of "room.floor+".
std::string surface_of(const SurfaceSide& side) {
    return side.name.substr(0, side.name.size() - 1);
}

class RoomMaker {
  public:
    RoomMaker(const Enclosure& enclosure, const PathRoomOptions& options)
        : e_(enclosure), options_(options) {
        if (options.band) {
            if (*options.band >= e_.bands)
                throw InputError(fmt::format("--band {}: the scene has the bands 0 to {}.",
                                             *options.band, e_.bands - 1));
            room_.bands = 1;
        } else if (e_.bands == 1 || e_.bands == 3) {
            room_.bands = e_.bands;
        } else {
            throw InputError(
                fmt::format("The scene has {} bands, and path tracers show grey or red, green and "
                            "blue. Export one band at a time: --band 0 to --band {}.",
                            e_.bands, e_.bands - 1));
        }
        room_.size = glm::distance(e_.mesh.hull_min, e_.mesh.hull_max);
        room_.centre = 0.5 * (e_.mesh.hull_min + e_.mesh.hull_max);
    }

    PathRoom make() {
        add_media();
        add_walls();
        add_boundaries();
        add_lights();
        return std::move(room_);
    }

  private:
    Spectrum picked(const Spectrum& all) const {
        if (all.empty()) return Spectrum(room_.bands, 0.0);
        return options_.band ? Spectrum{all[*options_.band]} : all;
    }

    Finish finish(const SurfaceSide& side) const {
        if (side.settled_flux)
            throw InputError(
                fmt::format("\"{}\" finds its temperature in several bands with the solution: a "
                            "path tracer cannot know what it emits. Give it a temperature.",
                            side.name));
        Finish result{picked(side.reflectance), picked(side.specular),
                      side.specular.empty() ? 0.0 : side.roughness, picked(side.emission)};
        for (std::size_t b = 0; b < room_.bands; ++b)
            result.diffuse[b] = std::max(0.0, result.diffuse[b] - result.specular[b]);
        if (std::ranges::any_of(result.emission, [](double v) { return v < 0.0; }))
            throw InputError(fmt::format(
                "\"{}\" takes in a given flux, which path tracers have no word for. Give the wall "
                "a temperature, or a flux of 0 or more.",
                side.name));
        return result;
    }

    void add_media() {
        for (const auto& medium : e_.media) {
            if (medium.settled_heat)
                throw InputError(fmt::format(
                    "medium \"{}\" finds its temperature in several bands with the solution: a "
                    "path tracer cannot know what it emits. Give it a temperature.",
                    medium.name));
            room_.media.push_back(optics(medium));
        }
    }

    RoomMedium optics(const radiosity::MediumOptics& medium) const {
        RoomMedium result;
        result.name = medium.name;
        result.phase = medium.phase;
        for (std::size_t b = 0; b < e_.bands; ++b) {
            const double absorbed = medium.absorption[b];
            double scattered = medium.scattering.empty()
                                   ? std::max(0.0, medium.extinction[b] - absorbed)
                                   : medium.scattering[b];
            const double extinction = absorbed + scattered;
            const double emitted = medium.emission[b] * medium.extinction[b];
            if (medium.albedo[b] == 1.0 && absorbed > 0.0) {  // gives back what it takes in
                if (emitted > 0.0 || !medium.phase.isotropic())
                    throw InputError(fmt::format(
                        "medium \"{}\" is heated, or in equilibrium and not isotropic, which path "
                        "tracers have no word for. Give it a temperature or an emission.",
                        medium.name));
                scattered = extinction;
            }
            result.extinction.push_back(extinction);
            result.albedo.push_back(ratio(scattered, extinction));
            result.emission.push_back(ratio(emitted, absorbed));
        }
        if (!medium.varying.empty()) bind_shape(medium, result);
        result.extinction = picked(result.extinction);
        result.albedo = picked(result.albedo);
        result.emission = picked(result.emission);
        return result;
    }

    void bind_shape(const radiosity::MediumOptics& medium, RoomMedium& result) const {
        const std::size_t first = options_.band.value_or(0);
        result.shape = medium.varying[first].shape;
        for (std::size_t b = 0; b < e_.bands; ++b) {
            if (!options_.band && medium.varying[b].shape != result.shape)
                throw InputError(fmt::format(
                    "medium \"{}\" has an extinction of another shape in every band, and path "
                    "tracers have one density. Export one band at a time: --band 0 to --band {}.",
                    medium.name, e_.bands - 1));
            // The solve's factor, with the coefficient not reduced.
            result.extinction[b] =
                medium.varying[b].factor * ratio(result.extinction[b], medium.extinction[b]);
        }
    }

    std::uint32_t medium_of(TetId tet) const { return tet.valid() ? e_.medium_of(tet) : none; }

    void add_walls() {
        using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
        std::map<Key, SheetBuilder> builders;
        for (std::size_t f = 0; f < e_.mesh.facets.size(); ++f) {
            const auto& facet = e_.mesh.facets[f];
            const auto [front, back] = e_.facet_sides[f];
            if (facet.opacity != mesh::Opacity::opaque || (front == none && back == none)) continue;
            const Key key{front, back, medium_of(facet.tets[0]), medium_of(facet.tets[1])};
            builders.try_emplace(key, e_.mesh).first->second.add(facet.corners);
        }
        for (auto& [key, builder] : builders) {
            const auto [front, back, before, behind] = key;
            const SurfaceSide& named = e_.sides[front != none ? front : back];
            Sheet sheet{surface_of(named), builder.take(), {}, {}, before, behind};
            if (front == none) {
                turn(sheet.triangles);
                std::swap(sheet.medium_front, sheet.medium_back);
                sheet.front = finish(e_.sides[back]);
            } else {
                sheet.front = finish(e_.sides[front]);
                if (back != none) sheet.back = finish(e_.sides[back]);
            }
            add_wall(std::move(sheet));
        }
    }

    // With the side that emits in front, or as two sheets.
    void add_wall(Sheet sheet) {
        if (!sheet.back) {
            room_.walls.push_back(std::move(sheet));
            return;
        }
        const bool differ = !(sheet.front == *sheet.back);
        if ((options_.one_material && differ) || (sheet.front.emits() && sheet.back->emits())) {
            Sheet other = sheet;
            turn(other.triangles);
            other.front = *sheet.back;
            std::swap(other.medium_front, other.medium_back);
            for (Sheet* side : {&sheet, &other}) {
                side->triangles = moved(side->triangles, sheets_apart * room_.size);
                side->back.reset();
            }
            room_.walls.push_back(std::move(sheet));
            room_.walls.push_back(std::move(other));
            return;
        }
        if (sheet.back->emits()) {
            turn(sheet.triangles);
            std::swap(sheet.medium_front, sheet.medium_back);
            std::swap(sheet.front, *sheet.back);
        }
        room_.walls.push_back(std::move(sheet));
    }

    void add_boundaries() {
        std::map<std::array<std::uint32_t, 2>, SheetBuilder> builders;
        const auto add = [&](std::uint32_t before, std::uint32_t behind,
                             const std::array<VertexId, 3>& corners) {
            if (before != behind)
                builders.try_emplace({before, behind}, e_.mesh).first->second.add(corners);
        };
        for (const auto& facet : e_.mesh.facets)
            if (facet.opacity == mesh::Opacity::interface)
                add(medium_of(facet.tets[0]), medium_of(facet.tets[1]), facet.corners);
        for (std::size_t t = 0; t < e_.mesh.tets.size(); ++t)
            for (int k = 0; k < 4; ++k)
                if (!e_.mesh.neighbours[t][k].valid() && !e_.mesh.tet_facets[t][k].valid())
                    add(none, medium_of(TetId(t)), outward_face(TetId(t), k));
        for (auto& [media, builder] : builders)
            room_.boundaries.push_back({"boundary", builder.take(), {}, {}, media[0], media[1]});
    }

    // Opposite corner k, counter-clockwise seen from outside the tet.
    std::array<VertexId, 3> outward_face(TetId tet, int k) const {
        const auto& c = e_.mesh.tets[tet.value];
        std::array<VertexId, 3> face{c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4]};
        std::array<Point, 3> p;
        for (int i = 0; i < 3; ++i) p[i] = e_.mesh.points[face[i].value];
        const Point inside = e_.mesh.points[c[k].value];
        if (glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), inside - p[0]) > 0.0)
            std::swap(face[1], face[2]);
        return face;
    }

    void add_lights() {
        room_.environment = picked(e_.environment);
        for (radiosity::Light light : e_.lights) {
            std::visit(
                [&](auto& source) {
                    if constexpr (requires { source.irradiance; })
                        source.irradiance = picked(source.irradiance);
                    else
                        source.intensity = picked(source.intensity);
                },
                light.source);
            room_.lights.push_back(std::move(light));
        }
    }

    const Enclosure& e_;
    const PathRoomOptions& options_;
    PathRoom room_;
};

}  // namespace

bool Finish::emits() const {
    return any(emission);
}

PathRoom path_room(const Enclosure& enclosure, const PathRoomOptions& options) {
    return RoomMaker(enclosure, options).make();
}

std::uint32_t medium_at(const Enclosure& enclosure, Point x) {
    const TetId tet = mesh::locate(enclosure.mesh, x);
    return tet.valid() ? enclosure.medium_of(tet) : none;
}

double specular_share(const Finish& finish, const std::string& name) {
    const double least = std::ranges::max(finish.specular);
    const double most = 1.0 - std::ranges::max(finish.diffuse);
    if (least > most + 1e-12)
        throw InputError(fmt::format(
            "\"{}\": the largest reflectance and the largest specular part, of all bands, add up "
            "to {:.4g}. Path tracers blend both by one share for all bands, which needs 1 or less. "
            "Export one band at a time: --band 0 and so on.",
            name, least + 1.0 - most));
    return 0.5 * (least + most);
}

Finish with_lost_light(Finish finish) {
    if (finish.roughness <= 0.0 || !any(finish.specular)) return finish;
    const render::GlossyLobe lobe(finish.roughness);
    double lost = 0.0;
    constexpr std::size_t steps = 256;
    for (std::size_t k = 0; k < steps; ++k) {
        const double cosine = (double(k) + 0.5) / steps;
        lost += 2.0 * cosine * (1.0 - lobe.single(cosine)) / steps;
    }
    const double most = 1.0 - std::ranges::max(finish.specular);
    for (std::size_t b = 0; b < finish.diffuse.size(); ++b)
        finish.diffuse[b] = std::max(finish.diffuse[b],
                                     std::min(most, finish.diffuse[b] + lost * finish.specular[b]));
    return finish;
}

std::vector<std::string> plain_names(const std::vector<std::string>& names) {
    std::vector<std::string> result;
    std::set<std::string> taken;
    for (const std::string& name : names) {
        std::string plain;
        for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
        std::string free = plain;
        for (int k = 2; !taken.insert(free).second; ++k) free = fmt::format("{}_{}", plain, k);
        result.push_back(free);
    }
    return result;
}

}  // namespace tyndall::exports
