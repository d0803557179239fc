#include "render/line_of_sight.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "mesh/entry.h"
#include "radiosity/point_set.h"
#include "render/eye.h"
#include "render/seen_solution.h"

namespace tyndall::render {
namespace {

using mesh::Point;
using mesh::ZoneId;
using radiosity::none;

class LineOfSight {
  public:
    LineOfSight(const radiosity::Solution& solution, const Camera& camera, double direct_tolerance)
        : s_(solution),
          e_(*solution.enclosure),
          eye_(camera.eye),
          eye_tet_(tet_of_eye(e_, camera)),
          seen_(solution, direct_tolerance) {}

    void look(mesh::Ray ray, Seen& seen) const {
        seen.clear(e_.bands);
        const mesh::Entry entry = mesh::entry_near(e_.mesh, ray, eye_, eye_tet_);
        if (!entry.tet.valid()) return seen_.leave(seen);
        if (e_.solid(entry.tet)) return;
        ray.origin += entry.distance * ray.direction;
        const auto end =
            mesh::walk(e_.mesh, ray, {entry.tet}, [&](mesh::TetId tet, double t_in, double t_out) {
                if (e_.solid(tet) || e_.medium_of(tet) == none) return true;
                return mesh::descend(s_.forest, mesh::root_zone(tet), ray, t_in, t_out,
                                     mesh::at_leaves, [&](ZoneId zone, double s_in, double s_out) {
                                         return seen_.cross(ray, zone, s_in, s_out, seen);
                                     });
            });
        seen_.arrive(ray, end, entry.distance, seen);
    }

  private:
    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    Point eye_;
    mesh::TetId eye_tet_;
    SeenSolution seen_;
};

}  // namespace

Image line_of_sight(const radiosity::Solution& solution, const Camera& camera,
                    const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    const LineOfSight line(solution, camera, options.direct_tolerance);
    PictureSums picture(camera, solution.enclosure->bands);
    // A scrambled (0,2)-net in every pixel: stratified in x and in y, so that edges along the axes
    // are as smooth as slanted ones.
    const radiosity::PointSet points(std::max<std::size_t>(options.samples, 1));
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    std::atomic<std::size_t> rows_done = 0;
    std::atomic<bool> stop = false;

    const CameraRays camera_ray(camera);
    tbb::parallel_for(std::size_t(0), camera.height, [&](std::size_t y) {
        if (stop) return;
        Seen seen;
        PictureSums::Sums sums;
        for (std::size_t x = 0; x < camera.width; ++x) {
            const std::size_t pixel = y * camera.width + x;
            picture.begin(sums);
            const auto seed = radiosity::hash_seed(options.seed, pixel);
            for (std::size_t k = 0; k < points.size(); ++k) {
                const auto u = points(k, seed);
                line.look(camera_ray(double(x) + u[0], double(y) + u[1], {u[3], u[4]}), seen);
                picture.add(seen, sums);
            }
            picture.end(sums, pixel, points.size());
        }
        const std::size_t done = ++rows_done;
        if (progress && !progress({"picture", double(done) / double(camera.height), 0, 0.0}))
            stop = true;
    });
    return picture.take();
}

}  // namespace tyndall::render
