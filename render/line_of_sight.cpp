#include "render/line_of_sight.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "mesh/entry.h"
#include "mesh/input_error.h"
#include "radiosity/direct_light.h"
#include "radiosity/point_set.h"
#include "radiosity/segment.h"
#include "render/picture_parts.h"

namespace tyndall::render {
namespace {

using mesh::Point;
using radiosity::Affine;
using radiosity::none;
using radiosity::PatchId;
using radiosity::ZoneId;

constexpr std::size_t parts = specular_reflection;  // of those there are: nothing is specular here

class LineOfSight {
  public:
    // `threshold`: error of a patch's direct light above which it is computed anew [W/m^2/sr].
    LineOfSight(const radiosity::Solution& solution, double threshold)
        : s_(solution),
          e_(*solution.enclosure),
          bands_(e_.bands),
          light_(e_, {.emitters = s_.direct_light == radiosity::DirectLightMode::closed_form}),
          threshold_(threshold) {}

    void look(const mesh::Ray& ray, mesh::WalkStart start, Seen& seen) const {
        seen.radiance.assign(parts * bands_, 0.0);
        seen.transmittance.assign(bands_, 1.0);
        seen.depth = std::numeric_limits<double>::infinity();
        const auto end =
            mesh::walk(e_.mesh, ray, start, [&](mesh::TetId tet, double t_in, double t_out) {
                const auto medium = e_.solid(tet) ? none : e_.medium_of(tet);
                if (medium == none) return true;
                return mesh::descend(s_.forest, mesh::root_zone(tet), ray, t_in, t_out,
                                     mesh::at_leaves, [&](ZoneId zone, double s_in, double s_out) {
                                         return cross(ray, e_.media[medium], zone, s_in, s_out,
                                                      seen);
                                     });
            });
        if (end.arrival == mesh::Arrival::struck)
            strike(ray, end, seen);
        else if (end.arrival == mesh::Arrival::left)
            for (std::size_t b = 0; b < bands_; ++b)
                seen.radiance[emission * bands_ + b] += seen.transmittance[b] * e_.environment[b];
    }

  private:
    bool cross(const mesh::Ray& ray, const radiosity::MediumOptics& optics, ZoneId zone,
               double t_in, double t_out, Seen& seen) const {
        const Point in = ray.origin + t_in * ray.direction,
                    out = ray.origin + t_out * ray.direction;
        double most = 0.0;
        radiosity::SegmentWeights w{};
        radiosity::SegmentOfBands segment(ray.origin, ray.direction, t_in, t_out);
        for (std::size_t b = 0; b < bands_; ++b) {
            if (!optics.varying.empty())
                w = segment.weights(optics.varying[b]);
            else if (b == 0 || optics.extinction[b] != optics.extinction[b - 1])
                w = radiosity::segment_weights(optics.extinction[b] * (t_out - t_in));
            double& transmittance = seen.transmittance[b];
            const auto gain = [&](Part part, double at_in, double at_out) {
                seen.radiance[part * bands_ + b] +=
                    transmittance *
                    (w.front * std::max(0.0, at_in) + w.back * std::max(0.0, at_out));
            };
            const double a = optics.albedo[b], emitted = radiosity::emission_of(s_, zone, b);
            const Affine& direct = s_.direct.at(zone, b);
            const Affine& indirect = s_.indirect.at(zone, b);
            gain(emission, emitted, emitted);
            gain(single_scattering, a * direct.at(in), a * direct.at(out));
            gain(multiple_scattering, a * indirect.at(in), a * indirect.at(out));
            transmittance *= w.transmittance;
            most = std::max(most, transmittance);
        }
        return most > 1e-9;
    }

    void strike(const mesh::Ray& ray, const mesh::WalkEnd& end, Seen& seen) const {
        const auto side = e_.facet_sides[end.facet.value][end.side == mesh::Side::back];
        seen.depth = end.distance;
        if (side == none) return;
        const auto& optics = e_.sides[side];
        const Point x = ray.origin + end.distance * ray.direction;
        const PatchId leaf = s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), x);
        thread_local std::vector<double> direct;
        direct.resize(bands_);
        if (s_.patch_direct_error[leaf.value] > threshold_) {
            const mesh::Direction n = radiosity::normal_of(s_.forest, leaf);
            light_.at_patch(x, n, end.tet, direct);
        } else {
            for (std::size_t b = 0; b < bands_; ++b)
                direct[b] = std::max(0.0, s_.direct.at(leaf, b).at(x));
        }
        for (std::size_t b = 0; b < bands_; ++b) {
            const double t = seen.transmittance[b], rho = optics.reflectance[b];
            seen.radiance[emission * bands_ + b] += t * radiosity::emission_of(s_, leaf, b);
            seen.radiance[surfaces_direct * bands_ + b] += t * rho * direct[b];
            seen.radiance[surfaces_indirect * bands_ + b] +=
                t * rho * std::max(0.0, s_.indirect.at(leaf, b).at(x));
        }
    }

    const radiosity::Solution& s_;
    const radiosity::Enclosure& e_;
    std::size_t bands_;
    radiosity::DirectLight light_;
    double threshold_;
};

// Mean radiance of the surfaces, a measure of the picture's before there is one [W/m^2/sr].
double typical_radiance(const radiosity::Solution& s) {
    double sum = 0.0, area = 0.0;
    for (std::size_t p = 0; p < s.forest.patch_count(); ++p) {
        const PatchId patch(p);
        if (!s.forest.is_leaf(patch) || radiosity::side_of(*s.enclosure, s.forest, patch) == none)
            continue;
        const double a = s.forest.area(patch);
        const Point centroid = s.forest.centroid(patch);
        for (std::size_t b = 0; b < s.enclosure->bands; ++b)
            sum += a * radiosity::scatter_of(s, patch, b) *
                   (s.direct.at(patch, b).at(centroid) + s.indirect.at(patch, b).at(centroid));
        area += a * static_cast<double>(s.enclosure->bands);
    }
    return area > 0.0 ? sum / area : 0.0;
}

Image blank(const Camera& camera, std::size_t bands) {
    Image image;
    image.width = camera.width;
    image.height = camera.height;
    const auto add = [&](const char* name, std::size_t channels) {
        image.layers.push_back(
            {name, channels, std::vector<float>(image.width * image.height * channels)});
    };
    add("beauty", bands);
    for (std::size_t p = 0; p < parts; ++p) add(part_names[p], bands);
    add("transmittance", bands);
    add("depth", 1);
    return image;
}

}  // namespace

Image line_of_sight(const radiosity::Solution& solution, const Camera& camera,
                    const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    const auto& enclosure = *solution.enclosure;
    const std::size_t bands = enclosure.bands;
    const mesh::TetId eye = mesh::locate(enclosure.mesh, camera.eye);
    if (eye.valid() && enclosure.solid(eye))
        throw mesh::InputError(fmt::format(
            "camera \"{}\" at [{}, {}, {}] stands inside a solid. Move its eye into the open.",
            camera.name, camera.eye.x, camera.eye.y, camera.eye.z));
    Image image = blank(camera, bands);
    const LineOfSight line(solution, options.direct_tolerance * typical_radiance(solution));
    // A scrambled (0,2)-net in every pixel: stratified in x and in y, so that edges along the axes
    // are as smooth as slanted ones.
    const radiosity::PointSet points(std::max<std::size_t>(options.samples, 1));
    const double share = 1.0 / static_cast<double>(points.size());
    std::optional<tbb::global_control> threads;
    if (options.threads > 0)
        threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    std::atomic<std::size_t> rows_done = 0;
    std::atomic<bool> stop = false;

    const CameraRays camera_ray(camera);
    tbb::parallel_for(std::size_t(0), camera.height, [&](std::size_t y) {
        if (stop) return;
        Seen seen;
        std::vector<double> sum;
        for (std::size_t x = 0; x < camera.width; ++x) {
            const std::size_t pixel = y * camera.width + x;
            sum.assign((parts + 1) * bands, 0.0);
            double depth = std::numeric_limits<double>::infinity();
            const auto seed = radiosity::hash_seed(options.seed, pixel);
            for (std::size_t k = 0; k < points.size(); ++k) {
                const auto u = points(k, seed);
                mesh::Ray ray = camera_ray(double(x) + u[0], double(y) + u[1], {u[3], u[4]});
                const mesh::Entry entry = mesh::entry_near(enclosure.mesh, ray, camera.eye, eye);
                if (!entry.tet.valid() || enclosure.solid(entry.tet)) {
                    for (std::size_t b = 0; b < bands; ++b) {
                        sum[emission * bands + b] +=
                            entry.tet.valid() ? 0.0 : enclosure.environment[b];
                        sum[parts * bands + b] += 1.0;
                    }
                    continue;
                }
                ray.origin += entry.distance * ray.direction;
                line.look(ray, {entry.tet}, seen);
                for (std::size_t n = 0; n < parts * bands; ++n) sum[n] += seen.radiance[n];
                for (std::size_t b = 0; b < bands; ++b)
                    sum[parts * bands + b] += seen.transmittance[b];
                depth = std::min(depth, entry.distance + seen.depth);
            }
            for (std::size_t b = 0; b < bands; ++b) {
                double beauty = 0.0;
                for (std::size_t part = 0; part < parts; ++part) {
                    const double value = share * sum[part * bands + b];
                    image.layers[1 + part].values[pixel * bands + b] = static_cast<float>(value);
                    beauty += value;
                }
                image.layers[0].values[pixel * bands + b] = static_cast<float>(beauty);
                image.layers[1 + parts].values[pixel * bands + b] =
                    static_cast<float>(share * sum[parts * bands + b]);
            }
            image.layers[2 + parts].values[pixel] = static_cast<float>(depth);
        }
        const std::size_t done = ++rows_done;
        if (progress && !progress({"picture", double(done) / double(camera.height), 0, 0.0}))
            stop = true;
    });
    return image;
}

}  // namespace tyndall::render
