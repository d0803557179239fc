#include "radiosity/start_elements.h"

namespace tyndall::radiosity {

void make_initial_mesh(ElementMesh& mesh, const SolveOptions& options) {
    // Fine enough for smooth indirect light, coarse enough that rows cost about a second.
    ElementMesh::InitialSize size{0.0, 4000, 1500};
    if (options.start == Start::single_zone) return;
    if (options.element_size > 0.0)
        size = {options.element_size, options.max_elements, options.max_elements};
    else if (options.start != Start::uniform || options.refinement == Refinement::none)
        return;
    mesh.refine_to(size);
}

Elements start_elements(const Enclosure& enclosure, const Forest& forest, Start start) {
    if (start != Start::single_zone) return elements_of_leaves(enclosure, forest);
    const OpticalTags tags(enclosure);
    return elements_of_clusters(enclosure, forest, mesh::make_whole_clusters(enclosure.mesh, tags));
}

}  // namespace tyndall::radiosity
