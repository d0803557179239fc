#include <tbb/parallel_for.h>

#include <cmath>

#include "mesh/entry.h"
#include "radiosity/error_estimate.h"
#include "radiosity/mirrored_ray.h"
#include "radiosity/segment.h"

namespace tyndall::radiosity {
namespace {

constexpr int rays_across = 64, rays_down = 48;

// Sums over rays and bands: radiance, and squares of its errors.
struct ErrorSums {
    double radiance = 0.0, elements = 0.0, gathers = 0.0, coarse = 0.0;
    std::size_t rays = 0;

    void operator+=(const ErrorSums& other) {
        radiance += other.radiance;
        elements += other.elements;
        gathers += other.gathers;
        coarse += other.coarse;
        rays += other.rays;
    }
};

// What one ray and band see of a solution and of its errors.
class ErrorWalk {
  public:
    ErrorWalk(const Solution& solution, const LeafErrors& errors, const mesh::Ray& ray,
              mesh::TetId start, std::size_t band)
        : s_(solution), errors_(errors), e_(*solution.enclosure), ray_(ray), band_(band) {
        mesh::WalkStart at{start};
        for (std::size_t mirrors = 0;; ++mirrors) {
            const auto end = mesh::walk_zones(
                e_.mesh, s_.forest, ray_, at, mesh::at_leaves,
                [&](ZoneId zone, double t_in, double t_out) { return cross(zone, t_in, t_out); });
            if (end.arrival == mesh::Arrival::struck)
                strike(end);
            else if (end.arrival == mesh::Arrival::left)
                radiance_ += transmittance_ * e_.environment[band];
            const SurfaceSide* mirror = mirror_struck(e_, end);
            if (!mirror || mirrors == most_mirrors) return;
            transmittance_ *= mirror->mirror[band];
            if (!(transmittance_ > little_mirrored)) return;
            const MirroredRay next = mirrored_ray(e_.mesh, ray_, end);
            ray_ = next.ray;
            at = next.start;
        }
    }

    void add_to(ErrorSums& sums) const {
        sums.radiance += radiance_;
        sums.elements += squares_;
        sums.gathers += gathers_ * gathers_;
        sums.coarse += coarse_ * coarse_;
        ++sums.rays;
    }

  private:
    bool cross(ZoneId zone, double t_in, double t_out) {
        const auto medium = medium_of(e_, s_.forest, zone);
        if (medium == none) return true;
        const MediumOptics& optics = e_.media[medium];
        const auto w =
            optics.varying.empty()
                ? segment_weights(optics.extinction[band_] * (t_out - t_in))
                : optics.varying[band_].weights(ray_.origin, ray_.direction, t_in, t_out);
        const Point in = ray_.origin + t_in * ray_.direction,
                    out = ray_.origin + t_out * ray_.direction;
        const double front = transmittance_ * w.front, back = transmittance_ * w.back;
        const auto seen = [&](const Fields& fields) {
            const Affine& f = fields.at(zone, band_);
            return front * f.at(in) + back * f.at(out);
        };
        const double a = optics.albedo[band_];
        radiance_ += (front + back) * emission_of(s_, zone, band_) +
                     a * std::max(0.0, seen(s_.direct) + seen(s_.indirect));
        gathers_ += a * seen(errors_.gathers);
        coarse_ += a * seen(errors_.coarse);
        const double departure = a * (front + back) * errors_.zone_elements[zone.value];
        squares_ += departure * departure;
        transmittance_ *= w.transmittance;
        return transmittance_ > 1e-7;
    }

    void strike(const mesh::WalkEnd& end) {
        const Point x = ray_.origin + end.distance * ray_.direction;
        const PatchId leaf = s_.forest.leaf_at(mesh::root_patch(end.facet, end.side), x);
        if (side_of(e_, s_.forest, leaf) == none) return;
        const double a = transmittance_ * scattered_of(s_, leaf, band_);
        const auto at = [&](const Fields& fields) { return fields.at(leaf, band_).at(x); };
        radiance_ += transmittance_ * emission_of(s_, leaf, band_) +
                     a * std::max(0.0, at(s_.direct) + at(s_.indirect));
        gathers_ += a * at(errors_.gathers);
        coarse_ += a * at(errors_.coarse);
        const double all = errors_.patch_elements[leaf.value];
        const double direct = errors_.patch_direct[leaf.value];
        squares_ += a * a * std::max(0.0, all * all - direct * direct);
    }

    const Solution& s_;
    const LeafErrors& errors_;
    const Enclosure& e_;
    mesh::Ray ray_;
    std::size_t band_;
    double transmittance_ = 1.0, radiance_ = 0.0, squares_ = 0.0, gathers_ = 0.0, coarse_ = 0.0;
};

// Over the view's rays, in the bands from `first` up to `end`.
ErrorSums sums_of(const Solution& solution, const LeafErrors& errors, const View& view,
                  std::size_t first, std::size_t end) {
    const mesh::BaseMesh& base = solution.enclosure->mesh;
    const mesh::TetId eye = mesh::locate(base, view.eye);
    std::vector<ErrorSums> lines(rays_down);
    tbb::parallel_for(0, rays_down, [&](int y) {
        for (int x = 0; x < rays_across; ++x) {
            mesh::Ray ray =
                view.ray(2.0 * (x + 0.5) / rays_across - 1.0, 1.0 - 2.0 * (y + 0.5) / rays_down);
            const mesh::Entry entry = mesh::entry_near(base, ray, view.eye, eye);
            ray.origin += entry.distance * ray.direction;
            for (std::size_t b = first; b < end; ++b) {
                if (entry.tet.valid() && !solution.enclosure->solid(entry.tet)) {
                    ErrorWalk(solution, errors, ray, entry.tet, b).add_to(lines[y]);
                } else {
                    lines[y].radiance +=
                        entry.tet.valid() ? 0.0 : solution.enclosure->environment[b];
                    ++lines[y].rays;
                }
            }
        }
    });
    // In order: the same bits at any number of threads.
    ErrorSums sum;
    for (const ErrorSums& line : lines) sum += line;
    return sum;
}

}  // namespace

std::optional<ErrorParts> picture_error(const Solution& solution, const LeafErrors& errors,
                                        const View& view) {
    const ErrorSums sum = sums_of(solution, errors, view, 0, solution.enclosure->bands);
    const double count = static_cast<double>(sum.rays), mean = sum.radiance / count;
    if (!(mean > 0.0)) return {};
    return ErrorParts{std::sqrt(sum.elements / count) / mean, std::sqrt(sum.gathers / count) / mean,
                      std::sqrt(sum.coarse / count) / mean};
}

Spectrum picture_radiance(const Solution& solution, const View& view) {
    const std::size_t bands = solution.enclosure->bands;
    LeafErrors exact;
    exact.gathers.resize(solution.forest, bands);
    exact.coarse.resize(solution.forest, bands);
    exact.zone_elements.resize(solution.forest.zone_count());
    exact.patch_elements.resize(solution.forest.patch_count());
    exact.patch_direct.resize(solution.forest.patch_count());
    Spectrum result;
    for (std::size_t b = 0; b < bands; ++b) {
        const ErrorSums sum = sums_of(solution, exact, view, b, b + 1);
        result.push_back(sum.radiance / static_cast<double>(sum.rays));
    }
    return result;
}

}  // namespace tyndall::radiosity
