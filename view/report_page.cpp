#include "view/report_page.h"

#include <fmt/format.h>

#include "view/base64.h"
#include "view/markup.h"
#include "view/mesh_statistics.h"
#include "view/page_sources.h"
#include "view/report_facts.h"
#include "view/report_mesh.h"
#include "view/report_notes.h"
#include "view/report_scene.h"
#include "view/report_sections.h"

namespace tyndall::view {
namespace {

constexpr SectionLevel level{2};
constexpr std::size_t longest_scene = 200000;  // that is shown [byte]

std::string picture_section(const ReportPageOptions& options) {
    if (options.picture.empty()) return "";
    return section(level, "picture", "Picture",
                   fmt::format("<figure class=\"picture\"><img alt=\"{0}\" "
                               "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption>"
                               "</figure>\n",
                               escaped(options.picture_alternative), base64(options.picture)));
}

// What makes the same solution again.
std::string again_section(const ReportFacts& facts, const ReportPageOptions& options) {
    Table table{"What made it", {"what", "value"}, {}, false};
    table.rows.push_back({"Tyndall", TYNDALL_VERSION});
    if (facts.seed) table.rows.push_back({"seed", std::to_string(*facts.seed)});
    if (facts.threads > 0) table.rows.push_back({"threads", std::to_string(facts.threads)});
    if (!facts.resumed_from.empty()) table.rows.push_back({"went on from", facts.resumed_from});
    if (facts.wall_seconds > 0.0)
        table.rows.push_back({"time", fmt::format("{}, {} of CPU", seconds(facts.wall_seconds),
                                                  seconds(facts.cpu_seconds))});
    if (facts.peak_memory_bytes > 0.0)
        table.rows.push_back({"most memory", megabytes(facts.peak_memory_bytes)});
    std::string text;
    if (!facts.command.empty())
        text += "<p>The command, from the folder that it was given in:</p>\n<pre><code>" +
                escaped(facts.command) + "</code></pre>\n";
    text += table_markup(table);
    text +=
        "<p>The same scene, seed and version give the same bits at any number of threads, unless "
        "a limit of time or a stop ended the run.</p>\n";
    if (!options.scene_text.empty() && options.scene_text.size() < longest_scene)
        text += folded_markup("The scene as it was solved, with all that --set had changed",
                              "<pre><code>" + multiline(options.scene_text) + "</code></pre>") +
                "\n";
    return section(level, "again", "To make it again", text);
}

std::string link_to_view(const ReportPageOptions& options) {
    if (options.view_link.empty()) return "";
    return fmt::format("<p><a href=\"{}\">Walk through the solution</a></p>",
                       escaped(options.view_link));
}

}  // namespace

std::string report_page(const radiosity::Solution& solution, const ReportPageOptions& options) {
    const ReportFacts facts = report_facts(solution, options.report);
    const MeshStatistics mesh = mesh_statistics(solution);
    const auto sizes = named_sizes(*solution.enclosure);
    auto notes = report_notes(solution, facts, mesh, options.goal);
    notes.insert(notes.end(), options.notes.begin(), options.notes.end());
    return filled(page_source("report.html"), [&](std::string_view name) -> std::string {
        if (name == "title") return escaped(options.title);
        if (name == "view_link") return link_to_view(options);
        if (name == "picture") return picture_section(options);
        if (name == "warnings")
            return section(level, "warnings", "Warnings and remarks", warnings_list(facts, notes));
        if (name == "solution")
            return section(level, "solution", "How good it is",
                           solution_table(facts, options.goal));
        if (name == "scene")
            return section(level, "scene", "Scene", scene_tables(solution, facts, options, sizes));
        if (name == "power")
            return section(level, "power", "Where the light goes",
                           power_figures(facts, sizes) + temperature_table(facts));
        if (name == "passes")
            return section(level, "passes", "Passes", passes_figures(facts, options.goal));
        if (name == "solver") return section(level, "solver", "Solver", solver_figures(facts));
        if (name == "mesh") return section(level, "mesh", "Mesh", mesh_figures(mesh));
        if (name == "again") return again_section(facts, options);
        return std::string(page_source(name));
    });
}

}  // namespace tyndall::view
