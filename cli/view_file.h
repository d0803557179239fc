// view.html: a solution to walk through in a browser.
#pragma once

#include <filesystem>
#include <string>

#include "cli/scene_file.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// Purpose: writes the page (view/view_page.h), with the cameras and the exposure of `settings`;
//   `report`: the text of report.json, "": the solution's own. `untitled`: what the page is called
//   if the scene has no title.
// Errors: mesh::InputError: bodies that move; a file that cannot be written.
void write_view(const std::filesystem::path& path, const radiosity::Solution& solution,
                const ViewSettings& settings, const std::string& report,
                const std::string& untitled);

}  // namespace tyndall::cli
