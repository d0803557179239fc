#include "cli/view_file.h"

#include "mesh/file_bytes.h"
#include "view/view_page.h"

namespace tyndall::cli {

void write_view(const std::filesystem::path& path, const radiosity::Solution& solution,
                const ViewSettings& settings, const ViewParts& parts) {
    view::PageOptions options;
    options.title = settings.title.empty() ? parts.untitled : settings.title;
    options.cameras = settings.cameras;
    options.view_camera = settings.view_camera;
    options.tone_map = settings.tone_map;
    options.report = parts.report;
    options.goal = parts.goal;
    options.report_link = parts.report_link;
    options.threads = settings.render.threads;
    mesh::write_file(path, view::view_page(solution, options));
}

}  // namespace tyndall::cli
