#include "render/line_of_sight.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "mesh/entry.h"
#include "radiosity/final_gather.h"
#include "radiosity/mirrored_ray.h"
#include "render/eye.h"
#include "render/seen_solution.h"
#include "render/sight_zones.h"

namespace tyndall::render {
namespace {

using mesh::Point;
using radiosity::none;

constexpr double darkest_share = 0.1;  // of the surfaces' mean radiance: contrast is against

class LineOfSight {
  public:
    LineOfSight(const radiosity::Solution& solution, const Camera& camera,
                const RenderOptions& options)
        : e_(*solution.enclosure),
          eye_(camera.eye),
          eye_tet_(tet_of_eye(e_, camera)),
          zones_(solution),
          seen_(solution, options.direct_tolerance, AtMirrors::go_on),
          scattered_(solution, seen_.light(), options.scattering_tolerance) {
        if (options.final_gather > 0) gather_.emplace(solution);
    }

    // What the ray sees; `points`, scrambled by `seed`: of the final gather, if there is one.
    // `anew`: as SightZones::cross has it; 0: single scattering is what zones hold.
    void look(mesh::Ray ray, const radiosity::PointSet& points, std::uint64_t seed, double anew,
              Seen& seen) const {
        seen.clear(e_.bands);
        const mesh::Entry entry = mesh::entry_near(e_.mesh, ray, eye_, eye_tet_);
        if (!entry.tet.valid()) return seen_.leave(seen);
        if (e_.solid(entry.tet)) return;
        ray.origin += entry.distance * ray.direction;
        SeenSolution::Indirect gathered;
        if (gather_)
            gathered = [&](mesh::PatchId leaf, Point x, std::span<double> incident) {
                gather_->on_surface(leaf, x, points, seed, incident);
            };
        const auto follow = [&](const mesh::Ray& along, mesh::WalkStart start, double before) {
            const SightRay sight(along);
            const auto end =
                mesh::walk(e_.mesh, along, start, [&](mesh::TetId tet, double t_in, double t_out) {
                    if (e_.solid(tet) || e_.medium_of(tet) == none) return true;
                    return zones_.cross(sight, tet, t_in, t_out, seen,
                                        anew > 0.0 ? &scattered_ : nullptr, anew);
                });
            seen_.arrive(along, end, before, seen, gathered);
            return end;
        };
        const auto end = follow(ray, {entry.tet}, entry.distance);
        if (radiosity::mirror_struck(e_, end)) mirror(ray, end, follow, seen);
    }

    std::size_t bands() const { return e_.bands; }
    // Of the layers; with one for what mirrors show where there are any.
    std::size_t parts() const { return e_.has_mirrors() ? part_count : solved_parts; }
    // Radiance below which differences do not count more [W/m^2/sr].
    double dark() const { return darkest_share * seen_.typical_radiance(); }

  private:
    // Follows a ray on from mirror to mirror (64); what it gains is their reflection.
    template <class Follow>
    void mirror(mesh::Ray ray, mesh::WalkEnd end, const Follow& follow, Seen& seen) const {
        const Seen first = seen;
        double before = seen.depth;
        for (std::size_t mirrors = 0; mirrors < radiosity::most_mirrors; ++mirrors) {
            const auto* side = radiosity::mirror_struck(e_, end);
            if (!side) break;
            for (std::size_t b = 0; b < e_.bands; ++b) seen.transmittance[b] *= side->mirror[b];
            if (!(*std::ranges::max_element(seen.transmittance) > radiosity::little_mirrored))
                break;
            const radiosity::MirroredRay next = radiosity::mirrored_ray(e_.mesh, ray, end);
            ray = next.ray;
            end = follow(ray, next.start, before);
            before += end.distance;
        }
        for (std::size_t k = 0; k < solved_parts * e_.bands; ++k) {
            seen.radiance[specular_reflection * e_.bands + k % e_.bands] +=
                seen.radiance[k] - first.radiance[k];
            seen.radiance[k] = first.radiance[k];
        }
        seen.transmittance = first.transmittance;
        seen.depth = first.depth;
    }

    const radiosity::Enclosure& e_;
    Point eye_;
    mesh::TetId eye_tet_;
    SightZones zones_;
    SeenSolution seen_;
    SingleScattering scattered_;
    std::optional<radiosity::FinalGather> gather_;
};

double radiance(const Seen& seen, std::size_t band, std::size_t bands) {
    double sum = 0.0;
    for (std::size_t part = 0; part < part_count; ++part) sum += seen.radiance[part * bands + band];
    return sum;
}

// Radiance in the middle of every pixel, and of those around the picture: crops are the same then.
class Middles {
  public:
    Middles(const Camera& camera, std::size_t bands)
        : row_((camera.width + 2) * bands), bands_(bands), values_(row_ * (camera.height + 2)) {}

    void set(std::size_t x, std::size_t y, const Seen& seen) {  // both from 0, around the picture
        float* to = at(x, y);
        for (std::size_t b = 0; b < bands_; ++b)
            to[b] = static_cast<float>(radiance(seen, b, bands_));
    }

    // Whether radiance is linear across a pixel of the picture, so that the middle is the mean: it
    // differs from the mean of any two opposite neighbours by no more than half of `contrast` of
    // the brightest of them, or of `dark`.
    bool even(std::size_t x, std::size_t y, double contrast, double dark) const {
        const float* here = at(x + 1, y + 1);
        constexpr std::ptrdiff_t opposite[4][2]{{1, 0}, {0, 1}, {1, 1}, {1, -1}};
        for (const auto& [i, j] : opposite) {
            const float* one = at(x + 1 + i, y + 1 + j);
            const float* other = at(x + 1 - i, y + 1 - j);
            for (std::size_t b = 0; b < bands_; ++b)
                if (std::abs(one[b] + other[b] - 2.0f * here[b]) >
                    contrast * std::max<double>(std::max({here[b], one[b], other[b]}), dark))
                    return false;
        }
        return true;
    }

  private:
    float* at(std::size_t x, std::size_t y) { return &values_[y * row_ + x * bands_]; }
    const float* at(std::size_t x, std::size_t y) const { return &values_[y * row_ + x * bands_]; }

    std::size_t row_, bands_;
    std::vector<float> values_;
};

// Makes the picture row by row: the middles of all pixels, then all samples where they differ.
class Painter {
  public:
    Painter(const LineOfSight& line, const Camera& camera, const RenderOptions& options,
            const radiosity::ProgressCallback& progress)
        : line_(line),
          camera_(camera),
          options_(options),
          progress_(progress),
          ray_(camera),
          points_(std::max<std::size_t>(options.samples, 1)),
          gathered_((options.final_gather + points_.size() - 1) / points_.size()),
          gathered_once_(options.final_gather),
          picture_(camera, line.bands(), line.parts()) {}

    Image paint() {
        // The middle of a pixel says nothing of what a lens blurs.
        if (options_.contrast > 0.0 && !camera_.lens && points_.size() > 1) {
            middles_.emplace(camera_, line_.bands());
            rows_ = 2 * camera_.height + 2;
            in_rows(camera_.height + 2, [&](std::size_t y) { paint_middles(y); });
        } else {
            rows_ = camera_.height;
        }
        in_rows(camera_.height, [&](std::size_t y) { paint_samples(y); });
        return picture_.take();
    }

  private:
    template <class Paint>
    void in_rows(std::size_t count, Paint&& paint) {
        tbb::parallel_for(std::size_t(0), count, [&](std::size_t y) {
            if (stop_) return;
            paint(y);
            const std::size_t done = ++done_;
            if (progress_ && !progress_({"picture", double(done) / double(rows_), 0, 0.0}))
                stop_ = true;
        });
    }

    // Of the row above the picture, those in it, and the one below.
    void paint_middles(std::size_t y) {
        Seen seen;
        PictureSums::Sums sums;
        for (std::size_t x = 0; x < camera_.width + 2; ++x) {
            const auto seed = radiosity::hash_seed(options_.seed, y * (camera_.width + 2) + x);
            line_.look(ray_(double(x) - 0.5, double(y) - 0.5), gathered_once_, seed, 1.0, seen);
            middles_->set(x, y, seen);
            if (x < 1 || y < 1 || x > camera_.width || y > camera_.height) continue;
            picture_.begin(sums);
            picture_.add(seen, sums);
            picture_.end(sums, (y - 1) * camera_.width + x - 1, 1);
        }
    }

    void paint_samples(std::size_t y) {
        // What elements leave out of single scattering varies little within a pixel: the first
        // points of a net, which are one themselves, tell it for all.
        const std::size_t anew = (points_.size() + 3) / 4;
        const double each = static_cast<double>(points_.size()) / static_cast<double>(anew);
        Seen seen;
        PictureSums::Sums sums;
        for (std::size_t x = 0; x < camera_.width; ++x) {
            if (middles_ && middles_->even(x, y, options_.contrast, line_.dark())) continue;
            const std::size_t pixel = y * camera_.width + x;
            picture_.begin(sums);
            // A scrambled (0,2)-net in every pixel: stratified in x and in y, so that edges along
            // the axes are as smooth as slanted ones.
            const auto seed = radiosity::hash_seed(options_.seed, pixel);
            for (std::size_t k = 0; k < points_.size(); ++k) {
                const auto u = points_(k, seed);
                line_.look(ray_(double(x) + u[0], double(y) + u[1], {u[3], u[4]}), gathered_,
                           radiosity::hash_seed(seed, k), k < anew ? each : 0.0, seen);
                picture_.add(seen, sums);
            }
            picture_.end(sums, pixel, points_.size());
        }
    }

    const LineOfSight& line_;
    const Camera& camera_;
    const RenderOptions& options_;
    const radiosity::ProgressCallback& progress_;
    CameraRays ray_;
    radiosity::PointSet points_, gathered_, gathered_once_;  // of a pixel; of a hit
    PictureSums picture_;
    std::optional<Middles> middles_;
    std::size_t rows_ = 0;
    std::atomic<std::size_t> done_ = 0;
    std::atomic<bool> stop_ = false;
};

}  // namespace

Image line_of_sight(const radiosity::Solution& solution, const Camera& camera,
                    const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    const LineOfSight line(solution, camera, options);
    return Painter(line, camera, options, progress).paint();
}

}  // namespace tyndall::render
