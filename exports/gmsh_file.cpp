#include "exports/gmsh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <span>

#include "mesh/input_error.h"

namespace tyndall::exports {
namespace {

using mesh::FacetId;
using mesh::Point;
using mesh::TetId;
using radiosity::none;

constexpr int gmsh_triangle = 2, gmsh_tetrahedron = 4;

// Elements of one physical name: an entity of Gmsh.
struct Entity {
    int dimension;
    std::string name;
    std::vector<std::size_t> elements;  // facets or tets
    Point low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

class GmshWriter {
  public:
    explicit GmshWriter(const radiosity::Enclosure& enclosure) : e_(enclosure), m_(e_.mesh) {
        if (!m_.bodies.empty())
            throw mesh::InputError(
                "Bodies move in this mesh, and their triangles are on no face of its tetrahedra: "
                "a mesh file cannot hold both. Export the scene of one frame.");
        collect();
    }

    std::string write() {
        text_ = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
        write_names();
        write_entities();
        write_nodes();
        write_elements();
        return std::move(text_);
    }

  private:
    template <class... Values>
    void print(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    void add(int dimension, const std::string& name, std::size_t element,
             std::span<const mesh::VertexId> corners) {
        const auto [place, is_new] = index_.try_emplace({dimension, name}, entities_.size());
        if (is_new) entities_.push_back({dimension, name, {}});
        Entity& entity = entities_[place->second];
        entity.elements.push_back(element);
        for (const auto corner : corners) {
            const Point& x = m_.points[corner.value];
            entity.low = glm::min(entity.low, x);
            entity.high = glm::max(entity.high, x);
        }
    }

    std::string name_of(FacetId facet) const {
        if (m_.facets[facet.value].opacity == mesh::Opacity::interface) return "openings";
        for (const auto side : e_.facet_sides[facet.value])
            if (side != none) return e_.sides[side].name.substr(0, e_.sides[side].name.size() - 1);
        return "inside solids";
    }

    void collect() {
        for (std::size_t f = 0; f < m_.facets.size(); ++f)
            add(2, name_of(FacetId(f)), f, m_.facets[f].corners);
        for (std::size_t t = 0; t < m_.tets.size(); ++t) {
            const auto medium = e_.medium_of(TetId(t));
            add(3,
                medium != none       ? e_.media[medium].name
                : e_.solid(TetId(t)) ? "solid"
                                     : "empty",
                t, m_.tets[t]);
        }
    }

    std::size_t count(int dimension) const {
        return static_cast<std::size_t>(
            std::ranges::count(entities_, dimension, &Entity::dimension));
    }

    // Entities and physical groups have the same numbers, from 1.
    void write_names() {
        print("$PhysicalNames\n{}\n", entities_.size());
        for (std::size_t k = 0; k < entities_.size(); ++k) {
            std::string name = entities_[k].name;
            std::ranges::replace(name, '"', '\'');
            print("{} {} \"{}\"\n", entities_[k].dimension, k + 1, name);
        }
        print("$EndPhysicalNames\n");
    }

    void write_entities() {
        print("$Entities\n0 0 {} {}\n", count(2), count(3));
        for (const int dimension : {2, 3})
            for (std::size_t k = 0; k < entities_.size(); ++k) {
                const Entity& e = entities_[k];
                if (e.dimension != dimension) continue;
                print("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} 1 {} 0\n", k + 1, e.low.x,
                      e.low.y, e.low.z, e.high.x, e.high.y, e.high.z, k + 1);
            }
        print("$EndEntities\n");
    }

    // All of them in the first volume: faces are looked up by their nodes.
    void write_nodes() {
        const auto first = std::ranges::find(entities_, 3, &Entity::dimension) - entities_.begin();
        print("$Nodes\n1 {0} 1 {0}\n3 {1} 0 {0}\n", m_.points.size(), first + 1);
        for (std::size_t p = 0; p < m_.points.size(); ++p) print("{}\n", p + 1);
        for (const Point& x : m_.points) print("{:.17g} {:.17g} {:.17g}\n", x.x, x.y, x.z);
        print("$EndNodes\n");
    }

    void write_elements() {
        const std::size_t all = m_.facets.size() + m_.tets.size();
        print("$Elements\n{} {} 1 {}\n", entities_.size(), all, all);
        std::size_t number = 0;
        const auto line = [&](std::span<const mesh::VertexId> corners) {
            print("{}", ++number);
            for (const auto corner : corners) print(" {}", corner.value + 1);
            print("\n");
        };
        for (std::size_t k = 0; k < entities_.size(); ++k) {
            const Entity& e = entities_[k];
            print("{} {} {} {}\n", e.dimension, k + 1,
                  e.dimension == 2 ? gmsh_triangle : gmsh_tetrahedron, e.elements.size());
            for (const std::size_t element : e.elements)
                e.dimension == 2 ? line(m_.facets[element].corners) : line(m_.tets[element]);
        }
        print("$EndElements\n");
    }

    const radiosity::Enclosure& e_;
    const mesh::BaseMesh& m_;
    std::vector<Entity> entities_;
    std::map<std::pair<int, std::string>, std::size_t> index_;
    std::string text_;
};

}  // namespace

ExportedFiles gmsh_file(const radiosity::Enclosure& enclosure) {
    return {GmshWriter(enclosure).write(), {}, {}};
}

}  // namespace tyndall::exports
