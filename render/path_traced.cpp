#include "render/path_traced.h"

#include "render/light_paths.h"
#include "render/sampled_picture.h"

namespace tyndall::render {

Image path_traced(const radiosity::Enclosure& enclosure, const Camera& camera,
                  const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    const LightPaths paths(enclosure);
    const Sampler sampler = [&](const mesh::Ray& ray, const SampleAt&, RandomNumbers& random,
                                Seen& seen) { paths.sample(ray, random, seen); };
    return sampled_picture(enclosure, camera, options, {.specular = paths.specular()}, sampler,
                           progress);
}

Image path_traced_scene(const radiosity::Solution& solution, const Camera& camera,
                        const RenderOptions& options, const radiosity::ProgressCallback& progress) {
    return path_traced(*solution.enclosure, camera, options, progress);
}

}  // namespace tyndall::render
