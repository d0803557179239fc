#include "mesh/tet_file_fill.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

#include "mesh/input_error.h"
#include "mesh/tetgen_process.h"

namespace tyndall::mesh {
namespace {

using Key = std::array<std::uint32_t, 3>;

Key sorted(Key key) {
    std::sort(key.begin(), key.end());
    return key;
}

class Filler {
  public:
    Filler(const TetFile& file, const ConformingComplex& complex, const FittedNodes& nodes)
        : file_(file), complex_(complex), nodes_(nodes) {}

    Filling fill(std::span<const TetFace> faces, std::span<const FacetId> outside,
                 const tetgen::Hull& hull, const TetrahedralizeOptions& options) {
        for (const TetFace& face : faces)
            if (face.boundary) add_boundary(face);
        for (const FacetId facet : outside) add_facet(facet);
        add_hull(hull);
        const auto worker = tetgen::find_worker(options.worker);
        // Y: no face is split; M: coplanar faces are not merged (nor are those of different
        // markers, but an assertion of TetGen that fails one way may hold the other).
        auto run = attempt(worker, "pYMQ", options);
        if (run.outcome == tetgen::Outcome::died) run = attempt(worker, "pYQ", options);
        if (run.outcome != tetgen::Outcome::done) refuse(run.message, diagnose(worker, options));
        return result(run.output);
    }

  private:
    tetgen::Run attempt(const std::filesystem::path& worker, const char* switches,
                        const TetrahedralizeOptions& options) const {
        return tetgen::run(worker, switches, input_,
                           {options.max_seconds, options.max_seconds, options.max_bytes});
    }

    // The input's point for a node of the file.
    std::uint32_t point_of(std::uint32_t node) {
        const auto [found, added] =
            points_.try_emplace(node, static_cast<std::uint32_t>(input_.points.size()));
        if (added) {
            input_.points.push_back(nodes_.points[node]);
            origin_.push_back(node);
        }
        return found->second;
    }
    // … for a point of the complex, which a node of the boundary may stand for.
    std::uint32_t point_of(VertexId vertex) {
        if (const auto node = nodes_.at_corner.find(vertex.value);
            node != nodes_.at_corner.end() && points_.contains(node->second))
            return points_[node->second];
        const auto [found, added] =
            vertices_.try_emplace(vertex.value, static_cast<std::uint32_t>(input_.points.size()));
        if (added) add_point(complex_.points[vertex.value]);
        return found->second;
    }
    std::uint32_t add_point(Point x) {
        input_.points.push_back(x);
        origin_.push_back(none);
        return static_cast<std::uint32_t>(input_.points.size() - 1);
    }

    // Every triangle has a marker of its own, which tells it in what TetGen says.
    void add_triangle(const Key& corners) {
        input_.triangles.push_back(corners);
        input_.triangle_markers.push_back(static_cast<std::int32_t>(input_.triangles.size()));
    }

    void add_boundary(const TetFace& face) {
        Key corners;
        for (int k = 0; k < 3; ++k) corners[k] = point_of(face.corners[k]);
        boundary_.emplace(sorted(corners), boundary_tets_.size());
        boundary_corners_.push_back(corners);
        boundary_tets_.push_back(face.tet);
        add_triangle(corners);
    }

    // Nodes of the boundary inside an edge of the complex, from `a` to `b`.
    std::vector<std::uint32_t> between(VertexId a, VertexId b) {
        const auto found =
            nodes_.on_edge.find({std::min(a.value, b.value), std::max(a.value, b.value)});
        if (found == nodes_.on_edge.end()) return {};
        std::vector<std::uint32_t> list;
        for (const std::uint32_t node : found->second)
            if (const auto point = points_.find(node); point != points_.end())
                list.push_back(point->second);
        const Point from = complex_.points[a.value];
        std::sort(list.begin(), list.end(), [&](std::uint32_t i, std::uint32_t j) {
            return glm::distance(input_.points[i], from) < glm::distance(input_.points[j], from);
        });
        return list;
    }

    void add_facet(FacetId facet) {
        const auto& c = complex_.facets[facet.value].corners;
        std::vector<std::uint32_t> outline;
        for (int k = 0; k < 3; ++k) {
            outline.push_back(point_of(c[k]));
            for (const auto node : between(c[k], c[(k + 1) % 3])) outline.push_back(node);
        }
        const auto piece = [&](const Key& corners) {
            sources_.push_back(facet);
            add_triangle(corners);
        };
        if (outline.size() == 3) return piece({outline[0], outline[1], outline[2]});
        const auto middle = add_point((complex_.points[c[0].value] + complex_.points[c[1].value] +
                                       complex_.points[c[2].value]) /
                                      3.0);
        for (std::size_t k = 0; k < outline.size(); ++k)
            piece({middle, outline[k], outline[(k + 1) % outline.size()]});
    }

    void add_hull(const tetgen::Hull& hull) {
        std::array<std::uint32_t, 8> p;
        for (std::uint32_t k = 0; k < 8; ++k)
            p[k] = add_point({k & 1 ? hull.max.x : hull.min.x, k & 2 ? hull.max.y : hull.min.y,
                              k & 4 ? hull.max.z : hull.min.z});
        constexpr std::array<std::array<int, 4>, 6> sides{
            {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
        for (const auto& s : sides) {
            input_.quads.push_back({p[s[0]], p[s[1]], p[s[2]], p[s[3]]});
            input_.quad_markers.push_back(static_cast<std::int32_t>(input_.triangles.size() + 1));
        }
    }

    // A tet of the file whose face TetGen finds crossing or doubled; none found: the first.
    std::uint32_t diagnose(const std::filesystem::path& worker,
                           const TetrahedralizeOptions& options) const {
        const auto run = tetgen::run(worker, "pdQ", input_, {20.0, 20.0, options.max_bytes});
        if (run.outcome == tetgen::Outcome::done && run.output.tets.empty())
            for (const auto marker : run.output.face_markers)
                if (marker >= 1 && static_cast<std::size_t>(marker) <= boundary_tets_.size())
                    return boundary_tets_[static_cast<std::size_t>(marker - 1)];
        return none;
    }

    [[noreturn]] void refuse(const std::string& why, std::uint32_t tet) const {
        const auto at = [&](std::uint32_t t) {
            const Point x = nodes_.points[file_.tets[t].corners[0]];
            return fmt::format("{} near [{:.6g}, {:.6g}, {:.6g}]", file_.place(t), x.x, x.y, x.z);
        };
        throw InputError(fmt::format(
            "{}: what is between the tetrahedra and the scene's hull cannot be filled ({}). Mesh "
            "the volume again: tetrahedra may meet in whole faces only, and neither overlap nor "
            "cross a surface.",
            tet == none ? file_.name : at(tet), why));
    }

    std::vector<bool> find_inner(const tetgen::Output& output) const;
    Filling result(const tetgen::Output& output) const;

    static constexpr std::uint32_t none = 0xffffffffu;
    const TetFile& file_;
    const ConformingComplex& complex_;
    const FittedNodes& nodes_;
    tetgen::Input input_;
    std::vector<std::uint32_t> origin_;  // of each input point: node of the file, or none
    std::map<std::uint32_t, std::uint32_t> points_,
        vertices_;                         // node, point of the complex → input
    std::map<Key, std::size_t> boundary_;  // sorted corners → index
    std::vector<Key> boundary_corners_;    // counter-clockwise seen from the file's tet
    std::vector<std::uint32_t> boundary_tets_;
    std::vector<FacetId> sources_;  // of each triangle behind the boundary's
};

// Which of TetGen's tets lie where the file has its own: flood fill between the boundary's faces,
// from the sides of these.
std::vector<bool> Filler::find_inner(const tetgen::Output& output) const {
    constexpr std::array<std::array<int, 3>, 4> opposite{
        {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
    enum Mark : char { unknown, inner, outer };
    std::vector<Mark> marks(output.tets.size(), unknown);
    std::vector<std::size_t> seen(boundary_corners_.size(), 0);
    std::map<Key, std::uint32_t> open;
    std::vector<std::array<std::uint32_t, 4>> next(output.tets.size(), {none, none, none, none});
    std::vector<std::uint32_t> stack;
    for (std::uint32_t t = 0; t < output.tets.size(); ++t)
        for (int k = 0; k < 4; ++k) {
            const auto& tet = output.tets[t];
            const Key key = sorted({tet[opposite[k][0]], tet[opposite[k][1]], tet[opposite[k][2]]});
            if (const auto found = boundary_.find(key); found != boundary_.end()) {
                const auto& c = boundary_corners_[found->second];
                const Point& a = output.points[c[0]];
                const bool inside =
                    glm::dot(glm::cross(output.points[c[1]] - a, output.points[c[2]] - a),
                             output.points[tet[k]] - a) > 0.0;
                const Mark mark = inside ? inner : outer;
                if (marks[t] != unknown && marks[t] != mark)
                    refuse("the boundary does not part inside from outside",
                           boundary_tets_[found->second]);
                if (marks[t] == unknown) stack.push_back(t);
                marks[t] = mark;
                ++seen[found->second];
            } else if (const auto other = open.find(key); other != open.end()) {
                next[t][k] = other->second / 4;
                next[other->second / 4][other->second % 4] = t;
                open.erase(other);
            } else {
                open.emplace(key, 4 * t + static_cast<std::uint32_t>(k));
            }
        }
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (seen[i] != 2) refuse("a face of the boundary is lost", boundary_tets_[i]);
    while (!stack.empty()) {
        const auto t = stack.back();
        stack.pop_back();
        for (const auto n : next[t]) {
            if (n == none) continue;
            if (marks[n] != unknown && marks[n] != marks[t])
                refuse("the boundary does not part inside from outside", none);
            if (marks[n] == unknown) stack.push_back(n);
            marks[n] = marks[t];
        }
    }
    std::vector<bool> inside;
    for (const Mark mark : marks) inside.push_back(mark == inner);
    return inside;
}

Filling Filler::result(const tetgen::Output& output) const {
    Filling filling;
    const auto inside = find_inner(output);
    std::vector<std::uint32_t> numbers(output.points.size(), none);
    const auto number = [&](std::uint32_t point) {
        auto& n = numbers[point];
        if (n == none && point < origin_.size()) n = origin_[point];
        if (n == none) {
            n = static_cast<std::uint32_t>(nodes_.points.size() + filling.points.size());
            filling.points.push_back(output.points[point]);
        }
        return n;
    };
    for (std::size_t t = 0; t < output.tets.size(); ++t)
        if (!inside[t]) {
            auto& tet = filling.tets.emplace_back();
            for (int k = 0; k < 4; ++k) tet[k] = number(output.tets[t][k]);
        }
    for (std::size_t f = 0; f < output.faces.size(); ++f) {
        const auto marker = static_cast<std::size_t>(std::max(output.face_markers[f], 0));
        if (marker <= boundary_tets_.size() || marker > input_.triangles.size()) continue;
        const FacetId source = sources_[marker - 1 - boundary_tets_.size()];
        Key corners;
        for (int k = 0; k < 3; ++k) corners[k] = number(output.faces[f][k]);
        filling.faces.push_back({corners, source});
    }
    return filling;
}

}  // namespace

Filling fill_hull(const TetFile& file, const ConformingComplex& complex, const FittedNodes& nodes,
                  std::span<const TetFace> faces, std::span<const FacetId> outside,
                  const tetgen::Hull& hull, const TetrahedralizeOptions& options) {
    return Filler(file, complex, nodes).fill(faces, outside, hull, options);
}

}  // namespace tyndall::mesh
