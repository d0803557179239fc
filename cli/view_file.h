// view.html: a solution to walk through in a browser.
#pragma once

#include <filesystem>
#include <string>

#include "cli/scene_file.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// What a page needs beside the solution and the settings of its scene.
struct ViewParts {
    std::string report;       // the text of report.json; "": the solution's own
    std::string untitled;     // what the page is called if the scene has no title
    double goal = 0.0;        // solve.error; 0: not known [-]
    std::string report_link;  // "": no report.html
};

// Purpose: writes the page (view/view_page.h), with the cameras and the exposure of `settings`.
// Errors: mesh::InputError: bodies that move; a file that cannot be written.
void write_view(const std::filesystem::path& path, const radiosity::Solution& solution,
                const ViewSettings& settings, const ViewParts& parts);

}  // namespace tyndall::cli
