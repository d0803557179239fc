#include "radiosity/own_tetrahedra.h"

#include <fmt/format.h>

namespace tyndall::radiosity {

void note_own_tetrahedra(const mesh::FittedMesh& fitted, const std::string& file,
                         Enclosure& enclosure) {
    double volume = 0.0;
    for (const auto& tet : fitted.filled)
        if (const TetId at = mesh::locate(enclosure.mesh, tet.centroid);
            at.valid() && !enclosure.solid(at))
            volume += tet.volume;
    enclosure.warnings.insert(enclosure.warnings.end(), fitted.notes.begin(), fitted.notes.end());
    if (volume > 0.0)
        enclosure.warnings.push_back(fmt::format(
            "{} leaves {:.4g} m3 in which light can be without tetrahedra, up to the scene's hull: "
            "TetGen filled them.",
            file, volume));
}

}  // namespace tyndall::radiosity
