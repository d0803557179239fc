#include "radiosity/linear_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall::radiosity {
namespace {

std::array<Point, 3> corners_of(const Forest& forest, PatchId patch) {
    const auto& ids = forest[patch].corners;
    return {forest.point(ids[0]), forest.point(ids[1]), forest.point(ids[2])};
}

class Divider {
  public:
    Divider(const Solution& whole, double tolerance, int levels)
        : whole_(whole), bands_(whole.enclosure->bands), pieces_(whole), of_(count()) {
        limit_ = tolerance * mean_reflected();
        for (std::size_t p = 0; p < count(); ++p) of_[p] = PatchId(p);
        for (std::size_t p = 0; p < count(); ++p)
            if (whole_.forest.is_leaf(PatchId(p)) &&
                side_of(*whole_.enclosure, whole_.forest, PatchId(p)) != none)
                divide(PatchId(p), levels);
    }

    Solution take() {
        pieces_.direct.zone_bend.clear();
        pieces_.indirect.patch_bend.clear();
        extend(pieces_.forest, pieces_.direct);
        extend(pieces_.forest, pieces_.indirect);
        for (std::size_t p = 0; p < of_.size(); ++p)
            if (pieces_.forest.is_leaf(PatchId(p))) fill(PatchId(p), of_[p]);
        // The mesh of the last pass is the one that is shown.
        pieces_.report.patches += made_;
        if (!pieces_.report.passes.empty()) pieces_.report.passes.back().patches += made_;
        extend(pieces_.patch_error, 1);
        extend(pieces_.patch_direct_error, 1);
        if (!pieces_.settled.patch.empty()) extend(pieces_.settled.patch, bands_);
        return std::move(pieces_);
    }

  private:
    std::size_t count() const { return whole_.forest.patch_count(); }

    // Over all sides, ∫ a H dA / ∫ dA, mean over bands.
    double mean_reflected() const {
        double sum = 0.0, area = 0.0;
        for (std::size_t p = 0; p < count(); ++p) {
            const PatchId patch(p);
            if (!whole_.forest.is_leaf(patch) ||
                side_of(*whole_.enclosure, whole_.forest, patch) == none)
                continue;
            const double a = whole_.forest.area(patch);
            area += a;
            const Point x = whole_.forest.centroid(patch);
            for (std::size_t b = 0; b < bands_; ++b)
                sum += a * scatter_of(whole_, patch, b) / double(bands_) *
                       (whole_.direct.at(patch, b).Affine::at(x) +
                        whole_.indirect.at(patch, b).Affine::at(x));
        }
        return area > 0.0 ? sum / area : 0.0;
    }

    // How far linear functions between the corners of a piece are from the leaf's at most.
    double departure(PatchId piece, PatchId leaf) const {
        const auto corners = corners_of(pieces_.forest, piece);
        double most = 0.0;
        for (std::size_t b = 0; b < bands_; ++b) {
            const LeafFunction f = whole_.indirect.at(leaf, b);
            for (std::size_t k = 0; k < 3; ++k)
                most = std::max(most, scatter_of(whole_, leaf, b) *
                                          std::abs(f.between(corners[k], corners[(k + 1) % 3])));
        }
        return most;
    }

    void divide(PatchId piece, int levels) {
        const PatchId leaf = of_[piece.value];
        if (levels == 0 || !(departure(piece, leaf) > limit_)) return;
        ++made_;
        const auto [i, j] = pieces_.forest.longest_edge(piece);
        pieces_.forest.bisect(piece, i, j);
        of_.resize(pieces_.forest.patch_count(), leaf);
        const PatchId first = pieces_.forest[piece].first_child;
        divide(first, levels - 1);
        divide(PatchId(first.value + 1), levels - 1);
    }

    void fill(PatchId piece, PatchId leaf) {
        const auto corners = corners_of(pieces_.forest, piece);
        for (std::size_t b = 0; b < bands_; ++b) {
            const LeafFunction f = whole_.indirect.at(leaf, b);
            pieces_.indirect.set(
                piece, b,
                interpolate(corners, {f.at(corners[0]), f.at(corners[1]), f.at(corners[2])}));
        }
    }

    template <class Value>
    void extend(std::vector<Value>& values, std::size_t each) const {
        const std::size_t known = values.size() / each;
        values.resize(of_.size() * each);
        for (std::size_t p = known; p < of_.size(); ++p)
            for (std::size_t b = 0; b < each; ++b)
                values[p * each + b] = values[of_[p].value * each + b];
    }
    static void extend(const Forest& forest, Fields& fields) { radiosity::extend(forest, fields); }

    const Solution& whole_;
    std::size_t bands_;
    Solution pieces_;
    std::vector<PatchId> of_;  // the leaf that a piece is of, by node
    double limit_ = 0.0;       // [W/m^2/sr]
    std::size_t made_ = 0;     // bisections
};

}  // namespace

Solution linear_pieces(const Solution& solution, double tolerance, int levels) {
    return Divider(solution, tolerance, levels).take();
}

}  // namespace tyndall::radiosity
