// Small scenes that paths are followed in, and what their samples say.
#pragma once

#include <cmath>

#include "render/path_traced.h"
#include "support/rooms.h"

namespace tyndall::test {

// A value with its standard error.
struct Estimate {
    double mean = 0.0, error = 0.0;

    // How many standard errors a value is off.
    double off(double value) const { return (mean - value) / error; }
};

// Of independent samples sample(k).
template <class Sample>
Estimate estimate(std::size_t count, Sample&& sample) {
    double sum = 0.0, square = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const double v = sample(k);
        sum += v;
        square += v * v;
    }
    const double n = double(count), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, square / n - mean * mean) / (n - 1.0))};
}

// Of a layer over a whole picture, whose pixels are independent.
inline Estimate over(const render::Image& image, const std::string& layer) {
    const auto* values = image.find(layer);
    REQUIRE(values);
    return estimate(values->values.size(), [&](std::size_t k) { return values->values[k]; });
}

inline render::Camera camera_at(mesh::Point eye, mesh::Point target, double fov_x,
                                std::size_t width, std::size_t height) {
    render::Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.fov_x = fov_x;
    camera.width = width;
    camera.height = height;
    return camera;
}

// A camera whose pixels all look at the same point, but for a thousandth of a degree.
inline render::Camera narrow_camera(mesh::Point eye, mesh::Point target, std::size_t size = 16) {
    render::Camera camera = camera_at(eye, target, 1e-5, size, size);
    if (std::abs(glm::normalize(target - eye).z) > 0.9) camera.up = {0, 1, 0};
    return camera;
}

inline std::shared_ptr<const radiosity::Enclosure> enclosed(const radiosity::Scene& scene) {
    return std::make_shared<const radiosity::Enclosure>(radiosity::make_enclosure(scene));
}

// A black room of 4 × 4 × 3 m whose floor alone reflects, evenly.
inline radiosity::Scene floor_room(double reflectance) {
    radiosity::Scene scene;
    scene.materials = {material(reflectance), material(0.0)};
    add_surfaces(scene, "room", mesh::room({0, 0, 0}, {4, 4, 3}), 1);
    scene.surfaces[surface_named(scene, "room.floor")].material = 0;
    return scene;
}

// The same without walls: a floor under the sky.
inline radiosity::Scene open_floor(double reflectance) {
    radiosity::Scene scene;
    scene.materials = {material(reflectance)};
    add_surfaces(scene, "floor", mesh::rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), 0);
    return scene;
}

}  // namespace tyndall::test
