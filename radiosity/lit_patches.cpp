#include "radiosity/lit_patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/body.h"
#include "mesh/visible_polygon.h"
#include "radiosity/closed_forms.h"
#include "radiosity/point_set.h"

namespace tyndall::radiosity {
namespace {

using std::numbers::pi;

// A node is looked at as one when its longest edge is below this share of its distance.
constexpr double small_enough = 0.4;
// What brings less than this share of the typical radiance is not looked at closer, once it is no
// longer than it is far.
constexpr double little_enough = 5e-4;
// A leaf beside the point is cut this many times at most: what is left in the corner is small.
constexpr int most_cuts = 8;

}  // namespace

struct LitPatches::Triangle {
    std::array<Point, 3> corners;
    Point centroid;
    double longest_edge, area;
};

LitPatches::LitPatches(const Enclosure& enclosure, const Forest& forest, const Fields& lit)
    : enclosure_(enclosure),
      bands_(enclosure.bands),
      depth_(enclosure, 1e-11 * glm::distance(enclosure.mesh.hull_min, enclosure.mesh.hull_max)),
      occlusion_(enclosure.mesh) {
    double power = 0.0, area = 0.0;
    for (std::size_t root = 0; root < 2 * enclosure.mesh.facets.size(); ++root) {
        const PatchId patch(root);
        if (side_of(enclosure, forest, patch) == none) continue;
        area += forest.area(patch);
        const std::uint32_t node = add(forest, lit, patch);
        if (node == none) continue;
        roots_.push_back(node);
        normals_.push_back(normal_of(forest, patch));
        const auto start = mesh::start_before(enclosure.mesh, static_cast<std::uint32_t>(root),
                                              forest.centroid(patch));
        const bool body = mesh::on_body(enclosure.mesh, FacetId(root / 2));
        fronts_.push_back(
            {start, {enclosure.mesh, start.tet}, body ? static_cast<std::uint32_t>(root) : none});
        for (std::size_t b = 0; b < bands_; ++b)
            power += nodes_[node].area * radiance_[node * bands_ + b].at(nodes_[node].centroid) /
                     double(bands_);
    }
    typical_ = area > 0.0 ? power / area : 0.0;
}

// The node of a patch and all below it that are lit; none where nothing is.
std::uint32_t LitPatches::add(const Forest& forest, const Fields& lit, PatchId patch) {
    Node node;
    for (int k = 0; k < 3; ++k) node.corners[k] = forest.point(forest[patch].corners[k]);
    node.centroid = forest.centroid(patch);
    node.longest_edge = forest[patch].longest_edge;
    node.area = forest.area(patch);
    std::vector<Affine> radiance(bands_);
    if (forest.is_leaf(patch)) {
        bool dark = true;
        for (std::size_t b = 0; b < bands_; ++b) {
            radiance[b] = lit.at(patch, b);
            dark = dark && !(radiance[b].at(node.centroid) > 0.0);
        }
        if (dark) return none;
    } else {
        const PatchId first = forest[patch].first_child;
        node.children = {add(forest, lit, first), add(forest, lit, PatchId(first.value + 1ull))};
        if (node.children[0] == none) std::swap(node.children[0], node.children[1]);
        if (node.children[0] == none) return none;
        for (const auto child : node.children)
            for (std::size_t b = 0; child != none && b < bands_; ++b)
                radiance[b].constant += nodes_[child].area / node.area *
                                        radiance_[child * bands_ + b].at(nodes_[child].centroid);
    }
    nodes_.push_back(node);
    radiance_.insert(radiance_.end(), radiance.begin(), radiance.end());
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

// One receiver's way through the trees.
class LitPatches::Visit {
  public:
    Visit(const LitPatches& lit, const Receiver& receiver, std::span<double> incident,
          const BrightCones* cones)
        : lit_(lit),
          receiver_(receiver),
          incident_(incident),
          cones_(cones && !cones->empty() ? cones : nullptr),
          depths_(incident.size()),
          here_{{receiver.tet}, {lit.enclosure_.mesh, receiver.tet}} {}

    void tree(std::size_t root) {
        front_ = &lit_.fronts_[root];
        node(lit_.roots_[root]);
    }

  private:
    void node(std::uint32_t index) {
        const Node& n = lit_.nodes_[index];
        if (hidden(n.corners)) return;
        if (accepted(n.centroid, n.longest_edge, n.area, index)) {
            add({n.corners, n.centroid, n.longest_edge, n.area}, index, index);
        } else if (n.children[0] == none) {
            cut({n.corners, n.centroid, n.longest_edge, n.area}, index, 0, index);
        } else {
            for (const auto child : n.children)
                if (child != none) node(child);
        }
    }

    // Whether a triangle lies below the receiver's horizon.
    bool hidden(const std::array<Point, 3>& corners) const {
        return receiver_.on_surface &&
               std::all_of(corners.begin(), corners.end(), [&](const Point& p) {
                   return glm::dot(receiver_.normal, p - receiver_.x) <= 0.0;
               });
    }

    double radiance(std::uint32_t index, Point at) const {
        double sum = 0.0;
        for (std::size_t b = 0; b < incident_.size(); ++b)
            sum += lit_.radiance_[index * incident_.size() + b].at(at);
        return sum / static_cast<double>(incident_.size());
    }

    bool accepted(Point centroid, double longest_edge, double area, std::uint32_t index) const {
        const auto d = centroid - receiver_.x;
        const double square = glm::dot(d, d), edge = longest_edge * longest_edge;
        if (edge <= small_enough * small_enough * square) return true;
        return edge <= square &&
               radiance(index, centroid) * area <= little_enough * lit_.typical_ * pi * square;
    }

    // A leaf that is too near: by halves, as linear as its function is.
    void cut(const Triangle& t, std::uint32_t index, int cuts, std::uint64_t stream) {
        int from = 0;
        double longest = -1.0;
        for (int k = 0; k < 3; ++k) {
            const auto edge = t.corners[(k + 1) % 3] - t.corners[k];
            if (const double length = glm::dot(edge, edge); length > longest) {
                longest = length;
                from = k;
            }
        }
        const Point middle = 0.5 * (t.corners[from] + t.corners[(from + 1) % 3]);
        for (const int replaced : {from, (from + 1) % 3}) {
            Triangle half = t;
            half.corners[replaced] = middle;
            half.centroid = (half.corners[0] + half.corners[1] + half.corners[2]) / 3.0;
            half.area = 0.5 * t.area;
            half.longest_edge = 0.0;
            for (int k = 0; k < 3; ++k)
                half.longest_edge = std::max(
                    half.longest_edge, glm::distance(half.corners[k], half.corners[(k + 1) % 3]));
            if (hidden(half.corners)) continue;
            const std::uint64_t next = hash_seed(stream, std::uint64_t(replaced) + 1);
            if (cuts + 1 == most_cuts ||
                accepted(half.centroid, half.longest_edge, half.area, index))
                add(half, index, next);
            else
                cut(half, index, cuts + 1, next);
        }
    }

    void add(const Triangle& t, std::uint32_t index, std::uint64_t stream) {
        const std::uint64_t bits = hash_seed(0, stream);
        const auto w = uniform_in_triangle(unit_number(bits), unit_number(hash_seed(bits, 1)));
        const Direction path =
            w[0] * t.corners[0] + w[1] * t.corners[1] + w[2] * t.corners[2] - receiver_.x;
        if (cones_ && cones_->bring_lit(path)) return;
        const double share = weight(t);
        if (share <= 0.0 || blocked(path)) return;
        std::fill(depths_.begin(), depths_.end(), 0.0);
        if (!lit_.depth_.transparent()) lit_.depth_(receiver_.x, receiver_.tet, path, depths_);
        for (std::size_t b = 0; b < incident_.size(); ++b)
            incident_[b] +=
                share * std::exp(-depths_[b]) *
                std::max(0.0, lit_.radiance_[index * incident_.size() + b].at(t.centroid));
    }

    // Shadow rays leave out a bit at both ends; a wall that close is met by walking.
    bool blocked(Direction path) const {
        const double length = glm::length(path), bit = 2.0 * lit_.occlusion_.end_gap();
        const double step = std::min(length, bit);
        const auto meets_wall = [&](Point from, Direction way, const Front& front) {
            if (front.planes.keep(from, (step / length) * way)) return false;
            const mesh::Ray ray{from, way / length, step};
            return mesh::walk(lit_.enclosure_.mesh, ray, front.start, [](TetId, double, double) {
                       return true;
                   }).arrival == mesh::Arrival::struck;
        };
        return meets_wall(receiver_.x, path, here_) ||
               meets_wall(receiver_.x + path, -path, front_at(receiver_.x + path)) ||
               lit_.occlusion_.blocked(receiver_.x, path);
    }

    Front front_at(Point x) const {
        const auto& mesh = lit_.enclosure_.mesh;
        if (front_->facet_side == none) return *front_;
        const auto start = mesh::start_before(mesh, front_->facet_side, x);
        return {start, {mesh, start.tet}};
    }

    double weight(const Triangle& t) {
        std::array<Point, 3> relative;
        for (int k = 0; k < 3; ++k) relative[k] = t.corners[k] - receiver_.x;
        if (!receiver_.on_surface) return solid_angle(relative) / (4.0 * pi);
        above_.clear();
        mesh::clip(relative, receiver_.normal, 0.0, above_);
        return above_.size() < 3 ? 0.0 : projected_solid_angle(above_, receiver_.normal) / pi;
    }

    const LitPatches& lit_;
    const Receiver& receiver_;
    std::span<double> incident_;
    const BrightCones* cones_;
    std::vector<double> depths_;
    std::vector<Point> above_;
    Front here_;                    // the receiver's own tet
    const Front* front_ = nullptr;  // of the tree that is visited
};

void LitPatches::gather(const Receiver& receiver, std::span<double> incident,
                        const BrightCones* cones) const {
    Visit visit(*this, receiver, incident, cones);
    for (std::size_t k = 0; k < roots_.size(); ++k)
        if (glm::dot(normals_[k], receiver.x - nodes_[roots_[k]].centroid) > 0.0) visit.tree(k);
}

}  // namespace tyndall::radiosity
