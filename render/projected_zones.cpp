#include "render/projected_zones.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <ranges>

#include "mesh/input_error.h"
#include "radiosity/item_buffer.h"
#include "render/eye.h"
#include "render/renderers.h"
#include "render/seen_solution.h"

namespace tyndall::render {
namespace {

using mesh::PatchId;
using mesh::TetId;
using mesh::ZoneId;
using radiosity::CubeFace;
using radiosity::ItemBuffer;

constexpr std::size_t rows_at_once = 8;  // of pixels: one piece of work

void refuse(const radiosity::Enclosure& enclosure, const Camera& camera) {
    refuse_bodies(enclosure);
    if (camera.projection != radiosity::PictureProjection::perspective || camera.lens)
        throw mesh::InputError(fmt::format(
            "camera \"{}\": projected_zones draws perspective pictures without a lens. Choose "
            "another camera or --method line_of_sight.",
            camera.name));
    tet_of_eye(enclosure, camera);  // refuses solids
}

class Projector {
  public:
    Projector(const radiosity::Solution& solution, const Camera& camera,
              const RenderOptions& options)
        : s_(solution),
          camera_(camera),
          view_(camera.view()),
          across_(static_cast<std::size_t>(
              std::ceil(std::sqrt(double(std::max<std::size_t>(options.samples, 1))) - 1e-9))),
          drawn_(*solution.enclosure, solution.forest),
          seen_(solution, options.direct_tolerance),
          picture_(camera, solution.enclosure->bands) {}

    // Rows of pixels from `first`, `count` of them.
    void draw(std::size_t first, std::size_t count) {
        bool fresh = false;
        auto& buffer = buffers_.local(fresh);
        if (!buffer) {
            buffer.emplace(drawn_);
            buffer->look_from(view_.eye, {view_.right, -view_.up, view_.forward});
        }
        std::vector<PictureSums::Sums> sums(count * camera_.width);
        for (auto& sum : sums) picture_.begin(sum);
        Seen seen, zone;
        const CubeFace shown = face(first, count);
        buffer->look(shown, [&](const ItemBuffer::Pixel& pixel) {
            lay(pixel, shown.direction(pixel.u, pixel.v), seen, zone);
            picture_.add(seen, sums[pixel.v / across_ * camera_.width + pixel.u / across_]);
        });
        for (std::size_t k = 0; k < sums.size(); ++k)
            picture_.end(sums[k], first * camera_.width + k, across_ * across_);
    }

    Image take() { return picture_.take(); }

  private:
    // The part of the plane before the eye that those rows show: u to the right, v down, so that
    // the cube's frame is right-handed.
    CubeFace face(std::size_t first, std::size_t count) const {
        const double width = double(camera_.whole_width ? camera_.whole_width : camera_.width);
        const double height = double(camera_.whole_height ? camera_.whole_height : camera_.height);
        const auto u = [&](std::size_t x) {
            return view_.half_x * (2.0 * double(camera_.left + x) / width - 1.0);
        };
        const auto v = [&](std::size_t y) {
            return view_.half_y * (2.0 * double(camera_.top + y) / height - 1.0);
        };
        return {.u_min = u(0),
                .u_max = u(camera_.width),
                .v_min = v(first),
                .v_max = v(first + count),
                .nu = across_ * camera_.width,
                .nv = across_ * count};
    }

    // The surface first, then what stands before it, from back to front. `d`: through the pixel, in
    // the cube's frame; `zone`: memory for what one zone adds.
    void lay(const ItemBuffer::Pixel& pixel, mesh::Direction d, Seen& seen, Seen& zone) const {
        const auto& e = *s_.enclosure;
        const mesh::Ray ray{view_.eye,
                            glm::normalize(d.x * view_.right - d.y * view_.up + view_.forward)};
        seen.clear(e.bands);
        if (pixel.column == radiosity::none) {
            seen_.leave(seen);
        } else {
            const PatchId patch(pixel.column);
            seen.depth = pixel.depth * pixel.length;
            seen_.strike(patch, ray.origin + seen.depth * ray.direction, tet_before(patch), seen);
        }
        for (const auto& f : std::views::reverse(pixel.zones)) {
            if (!(f.far > f.near)) continue;
            zone.clear(e.bands);
            seen_.cross(ray, ZoneId(f.column), f.near * pixel.length, f.far * pixel.length, zone);
            for (std::size_t n = 0; n < seen.radiance.size(); ++n)
                seen.radiance[n] =
                    seen.radiance[n] * zone.transmittance[n % e.bands] + zone.radiance[n];
            for (std::size_t b = 0; b < e.bands; ++b)
                seen.transmittance[b] *= zone.transmittance[b];
        }
    }

    // On the side of its facet that a patch faces.
    TetId tet_before(PatchId patch) const {
        const std::uint32_t facet_side = s_.forest.base_facet_side(patch);
        return s_.enclosure->mesh.facets[facet_side / 2].tets[facet_side % 2];
    }

    const radiosity::Solution& s_;
    const Camera& camera_;
    radiosity::View view_;
    std::size_t across_;  // sub-pixels along a pixel
    radiosity::DrawnElements drawn_;
    SeenSolution seen_;
    PictureSums picture_;
    tbb::enumerable_thread_specific<std::optional<ItemBuffer>> buffers_;
};

}  // namespace

Image projected_zones(const radiosity::Solution& solution, const Camera& camera,
                      const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    refuse(*solution.enclosure, camera);
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    Projector projector(solution, camera, options);
    const std::size_t pieces = (camera.height + rows_at_once - 1) / rows_at_once;
    std::atomic<std::size_t> done = 0;
    std::atomic<bool> stop = false;
    tbb::parallel_for(std::size_t(0), pieces, [&](std::size_t k) {
        if (stop) return;
        const std::size_t first = k * rows_at_once;
        projector.draw(first, std::min(rows_at_once, camera.height - first));
        if (progress && !progress({"picture", double(++done) / double(pieces), 0, 0.0}))
            stop = true;
    });
    return projector.take();
}

}  // namespace tyndall::render
