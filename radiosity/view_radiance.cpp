#include "radiosity/view_radiance.h"

#include "mesh/entry.h"
#include "radiosity/importance.h"

namespace tyndall::radiosity {

double mean_radiance(const GatherScene& scene, const Enclosure& enclosure, const View& view) {
    const mesh::TetId eye = mesh::locate(enclosure.mesh, view.eye);
    constexpr int across = 32, down = 24;
    Spectrum radiance(enclosure.bands);
    double sum = 0.0;
    for (int y = 0; y < down; ++y)
        for (int x = 0; x < across; ++x) {
            mesh::Ray ray = view.ray(2.0 * (x + 0.5) / across - 1.0, 1.0 - 2.0 * (y + 0.5) / down);
            const mesh::Entry entry = mesh::entry_near(enclosure.mesh, ray, view.eye, eye);
            if (!entry.tet.valid() || enclosure.solid(entry.tet)) continue;
            ray.origin += entry.distance * ray.direction;
            radiance_along(scene, ray, {entry.tet}, radiance);
            sum += mean_over_bands(radiance);
        }
    return sum / (across * down);
}

}  // namespace tyndall::radiosity
