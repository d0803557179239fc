// report.html: what was solved, how well, and at what cost.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/scene_file.h"
#include "radiosity/solution.h"

namespace tyndall::cli {

// What a report takes from a scene's text (SceneFile::effective_toml): it is left empty where the
// text is no scene.
struct ReportedScene {
    std::map<std::string, std::string> materials;   // of a surface's front, by its name
    std::map<std::string, std::string> backs;       // of its back, where that is another
    double goal = radiosity::SolveOptions{}.error;  // solve.error [-]
};
ReportedScene reported_scene(const std::string& toml);

// The material of a side: "room.floor+" is of "room.floor", or else of "room". "": not known.
std::string material_of(const ReportedScene& scene, const std::string& side);

// What goes into the page beside the solution and its settings.
struct ReportParts {
    std::string report;              // text of report.json; "": the solution's own
    std::string scene_text;          // SceneFile::effective_toml
    std::filesystem::path picture;   // a PNG file; empty: none
    std::string view_link;           // "": no view.html
    std::vector<std::string> notes;  // sentences beside the warnings
    std::string untitled;            // what the page is called if the scene has no title
};

// Purpose: writes the page (view/report_page.h).
// Errors: mesh::InputError: a file that cannot be read or written.
void write_report(const std::filesystem::path& path, const radiosity::Solution& solution,
                  const ViewSettings& settings, const ReportParts& parts);

}  // namespace tyndall::cli
