#include "radiosity/start_elements.h"

namespace tyndall::radiosity {

Elements start_elements(const Enclosure& enclosure, const Forest& forest, Start start) {
    if (start != Start::single_zone) return elements_of_leaves(enclosure, forest);
    const OpticalTags tags(enclosure);
    return elements_of_clusters(enclosure, forest, mesh::make_whole_clusters(enclosure.mesh, tags));
}

}  // namespace tyndall::radiosity
