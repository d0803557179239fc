// A solution as a page to walk through: one HTML file that needs no server and no network.
#pragma once

#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "render/camera.h"
#include "render/options.h"
#include "view/sharpened_patches.h"

namespace tyndall::view {

// What a page shows beyond the solution itself.
struct PageOptions {
    std::string title = "Tyndall";
    std::vector<render::Camera> cameras;  // none: the page begins somewhere
    std::string view_camera;              // the one to begin with; "": the first
    render::ToneMapOptions tone_map;
    // A JSON object with the keys of report.json; "": that of the solution.
    std::string report;
    double goal = 0.0;        // solve.error; 0: not known [-]
    std::string report_link;  // where report.html is; "": nowhere
    SharpenOptions sharpen;
    std::size_t threads = 0;  // 0: all
};

// Purpose: the page's bytes. It holds the elements, the cameras, the report, and a program that
//   draws them: the walk through the leaves for every pixel on the GPU (docs/guide/13-viewer.md).
// Equation: (4) with J linear in each leaf, as render/line_of_sight.h; direct light on surfaces by
//   sharpened patches.
// Errors: mesh::InputError for moving bodies in the mesh, which the page cannot draw.
// Cost: direct light at about six points a piece; 100 bytes an element and band.
std::string view_page(const radiosity::Solution& solution, const PageOptions& options);

}  // namespace tyndall::view
