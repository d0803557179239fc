#include "view/sharpened_patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "mesh/body.h"
#include "radiosity/direct_light.h"
#include "render/seen_solution.h"

namespace tyndall::view {
namespace {

using mesh::PatchId;
using mesh::Point;
using radiosity::none;
using radiosity::Solution;

constexpr double inward = 1e-4;      // of the way to the centroid: rims belong to two walls
constexpr double coarse = 0.02;      // of the hull's diagonal: a larger piece may hide a lit spot
constexpr std::size_t batch = 1024;  // pieces bisected at a time

// A triangle that may be bisected, with H^A at its corners and at the middles opposite them.
struct Piece {
    PatchId id;
    PatchId patch;                         // of the solution
    std::vector<double> corners, middles;  // [3 × bands]
    double gain = 0.0;                     // error times area: who goes first
};

class Sharpener {
  public:
    Sharpener(const Solution& solution, const SharpenOptions& options)
        : s_(solution),
          e_(*solution.enclosure),
          options_(options),
          light_(e_, {.emitters = s_.direct_light == radiosity::DirectLightMode::closed_form}),
          mean_(render::SeenSolution(solution, 0.0).typical_radiance()),
          size_(glm::length(e_.mesh.hull_max - e_.mesh.hull_min)),
          result_{s_.forest, s_.direct} {}

    SharpenedPatches sharpen() {
        std::vector<Piece> fresh = first_pieces();
        measure(fresh);
        keep(fresh);
        while (!waiting_.empty() && result_.made < options_.most_pieces) {
            fresh = bisect_best();
            measure(fresh);
            keep(fresh);
        }
        result_.left = waiting_.size();
        return std::move(result_);
    }

  private:
    struct Less {
        bool operator()(const Piece& a, const Piece& b) const {
            return a.gain != b.gain ? a.gain < b.gain : b.id < a.id;
        }
    };

    // Leaves whose own functions would show.
    std::vector<Piece> first_pieces() const {
        std::vector<Piece> pieces;
        if (light_.empty() || !(mean_ > 0.0)) return pieces;
        for (std::size_t p = 0; p < s_.forest.patch_count(); ++p) {
            const PatchId patch(p);
            if (!s_.forest.is_leaf(patch) || radiosity::side_of(e_, s_.forest, patch) == none ||
                !(brightest(patch) * s_.patch_direct_error[p] > 0.5 * options_.tolerance * mean_))
                continue;
            pieces.push_back({patch, patch, {}, {}});
        }
        return pieces;
    }

    double brightest(PatchId patch) const {
        double most = 0.0;
        for (std::size_t b = 0; b < e_.bands; ++b)
            most = std::max(most, radiosity::scatter_of(s_, patch, b));
        return most;
    }

    // H^A at a point of a patch of the solution, moved in from the patch's rim.
    void light_at(PatchId patch, Point x, double* incident) const {
        x += inward * (s_.forest.centroid(patch) - x);
        const auto before = mesh::tet_before(e_.mesh, s_.forest.base_facet_side(patch), x);
        light_.at_patch(x, radiosity::normal_of(s_.forest, patch), before, {incident, e_.bands});
    }

    Point corner(const Piece& piece, int k) const {
        return result_.forest.point(result_.forest[piece.id].corners[k]);
    }

    // Fills what is not known of pieces, and their functions.
    void measure(std::vector<Piece>& pieces) {
        tbb::parallel_for(std::size_t(0), pieces.size(), [&](std::size_t n) {
            Piece& piece = pieces[n];
            if (piece.corners.empty()) {
                piece.corners.resize(3 * e_.bands);
                for (int k = 0; k < 3; ++k)
                    light_at(piece.patch, corner(piece, k), &piece.corners[k * e_.bands]);
            }
            piece.middles.resize(3 * e_.bands);
            for (int k = 0; k < 3; ++k)
                light_at(piece.patch,
                         0.5 * (corner(piece, (k + 1) % 3) + corner(piece, (k + 2) % 3)),
                         &piece.middles[k * e_.bands]);
            weigh(piece);
            for (std::size_t b = 0; b < e_.bands; ++b)
                result_.direct.at(piece.id, b) = radiosity::interpolate(
                    std::array{corner(piece, 0), corner(piece, 1), corner(piece, 2)},
                    {piece.corners[b], piece.corners[e_.bands + b],
                     piece.corners[2 * e_.bands + b]});
        });
    }

    // 0: the piece is good as it is.
    void weigh(Piece& piece) const {
        double error = 0.0;
        for (int k = 0; k < 3; ++k)
            for (std::size_t b = 0; b < e_.bands; ++b) {
                const double between = 0.5 * (piece.corners[(k + 1) % 3 * e_.bands + b] +
                                              piece.corners[(k + 2) % 3 * e_.bands + b]);
                error = std::max(error, radiosity::scatter_of(s_, piece.patch, b) *
                                            std::abs(piece.middles[k * e_.bands + b] - between));
            }
        const auto& node = result_.forest[piece.id];
        if (node.longest_edge > coarse * size_)
            error = std::max(
                error, 0.1 * brightest(piece.patch) * s_.patch_direct_error[piece.patch.value]);
        const bool wanted = error > options_.tolerance * mean_ &&
                            node.longest_edge > options_.smallest_edge * size_;
        piece.gain = wanted ? error * result_.forest.area(piece.id) : 0.0;
    }

    void keep(std::vector<Piece>& pieces) {
        for (Piece& piece : pieces)
            if (piece.gain > 0.0) waiting_.push(std::move(piece));
    }

    std::vector<Piece> bisect_best() {
        std::vector<Piece> children;
        const std::size_t count =
            std::min({batch, waiting_.size(), options_.most_pieces - result_.made});
        for (std::size_t n = 0; n < count; ++n) {
            const Piece piece = waiting_.top();
            waiting_.pop();
            bisect(piece, children);
        }
        result_.made += count;
        radiosity::extend(result_.forest, result_.direct);
        return children;
    }

    void bisect(const Piece& piece, std::vector<Piece>& children) {
        const auto [i, j] = result_.forest.longest_edge(piece.id);
        const PatchId first = result_.forest.bisect(piece.id, i, j);
        const int apex = 3 - i - j;
        for (const int replaced : {j, i}) {
            Piece child{replaced == j ? first : PatchId(first.value + 1ull),
                        piece.patch,
                        piece.corners,
                        {}};
            for (std::size_t b = 0; b < e_.bands; ++b)
                child.corners[replaced * e_.bands + b] = piece.middles[apex * e_.bands + b];
            children.push_back(std::move(child));
        }
    }

    const Solution& s_;
    const radiosity::Enclosure& e_;
    SharpenOptions options_;
    radiosity::DirectLight light_;
    double mean_;  // of the surfaces' radiance [W/m^2/sr]
    double size_;  // of the hull [m]
    SharpenedPatches result_;
    std::priority_queue<Piece, std::vector<Piece>, Less> waiting_;
};

}  // namespace

SharpenedPatches sharpen_patches(const Solution& solution, const SharpenOptions& options) {
    return Sharpener(solution, options).sharpen();
}

}  // namespace tyndall::view
