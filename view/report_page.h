// The report of a solution as a page: one HTML file that needs no server, no network, no script.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "radiosity/solution.h"
#include "render/camera.h"

namespace tyndall::view {

// What a report says beyond the solution itself; what is empty is left out.
struct ReportPageOptions {
    std::string title = "Tyndall";
    std::string report;                            // text of report.json; "": the solution's own
    std::map<std::string, std::string> materials;  // of a side, by its name
    std::vector<render::Camera> cameras;
    std::string view_camera;          // that was solved for; "": none
    double goal = 0.0;                // solve.error; 0: not known [-]
    std::string picture;              // a PNG file's bytes
    std::string picture_alternative;  // what it shows, in words
    std::string scene_text;           // the scene as it was solved, TOML
    std::string view_link;            // where view.html is
    std::vector<std::string> notes;   // sentences beside the warnings
};

// Purpose: the page's bytes: scene, picture, warnings, the solution's errors and checks, passes,
//   solver, power by name, temperatures, the mesh and its quality, and how to make it again. Charts
//   are SVG within the page, with their numbers in tables. The same input gives the same bytes.
// Errors: mesh::InputError where `report` is no report.
// Cost: linear in the leaves.
std::string report_page(const radiosity::Solution& solution, const ReportPageOptions& options);

}  // namespace tyndall::view
