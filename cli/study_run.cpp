#include "cli/study_run.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <csignal>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/child_process.h"
#include "cli/job.h"
#include "cli/study_quality.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"
#include "render/image_files.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

// Appends what the files hold that a value below `node` names.
void add_files(const toml::node& node, const fs::path& folder, std::string& text) {
    if (const auto* table = node.as_table()) {
        for (const auto& [key, value] : *table) add_files(value, folder, text);
    } else if (const auto* array = node.as_array()) {
        for (const auto& value : *array) add_files(value, folder, text);
    } else if (const auto* name = node.as_string()) {
        std::error_code error;
        const auto path = folder / name->get();
        if (!name->get().empty() && fs::is_regular_file(path, error))
            text += digest(mesh::read_file(path));
    }
}

// The last message of the program: "tyndall: what went wrong" without its first word.
std::string last_message(const fs::path& messages) {
    std::string text = mesh::read_file(messages);
    const std::string mark = "tyndall: ";
    if (const auto at = text.rfind(mark); at != text.npos) text.erase(0, at + mark.size());
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    constexpr std::size_t longest = 600;
    return text.substr(0, longest);
}

std::string why_it_failed(const ChildOutcome& outcome, const fs::path& messages) {
    const auto said = last_message(messages);
    if (outcome.signal != 0)
        return fmt::format("it was ended by signal {} ({}){}{}.", outcome.signal,
                           strsignal(outcome.signal),
                           outcome.signal == SIGKILL ? ", perhaps for want of memory" : "",
                           said.empty() ? "" : ": " + said);
    return said.empty() ? fmt::format("it ended with exit code {}.", outcome.exit_code) : said;
}

RunFigures figures_of(const fs::path& folder, const ChildOutcome& outcome) {
    const auto report = nlohmann::json::parse(mesh::read_file(folder / "report.json"));
    RunFigures figures;
    figures.patches = report.at("patches").get<std::size_t>();
    figures.zones = report.at("zones").get<std::size_t>();
    for (const auto& pass : report.at("passes")) figures.rays += pass.at("rays").get<std::size_t>();
    const auto estimate = [&](const char* key) {
        const auto& value = report.at(key);
        return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    };
    figures.estimated_error = estimate("estimated_error");
    figures.estimated_picture_error = estimate("estimated_picture_error");
    figures.estimated_solution_error = estimate("estimated_solution_error");
    figures.cpu_seconds = outcome.cpu_seconds;
    figures.wall_seconds = outcome.wall_seconds;
    figures.memory_bytes = outcome.peak_memory_bytes;
    return figures;
}

std::string drawing_text(const StudyJob& job) {
    if (!job.slice) return "slice through the middle";
    const auto &p = job.slice->point, &n = job.slice->normal;
    return fmt::format("slice through [{}, {}, {}] across [{}, {}, {}]", p.x, p.y, p.z, n.x, n.y,
                       n.z);
}

// A slice of the mesh of every pass that the run has kept as a solution file.
void draw_passes(const StudyJob& job, const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "passes", error)) {
        if (entry.path().extension() != ".vtkhdf") continue;
        try {
            const auto solved = radiosity::read_solution(entry.path()).solution;
            const render::Plane plane =
                job.slice.value_or(render::default_plane(*solved.enclosure));
            render::write_image(fs::path(entry.path()).replace_extension(".png"),
                                render::field_slice(solved, plane).image);
        } catch (const mesh::InputError&) {
            continue;  // a mesh without its light has nothing to be coloured by
        }
    }
}

// Element quality and pictures of the mesh.
void look_at_mesh(const StudyJob& job, const SceneFile& file, const fs::path& folder,
                  RunRecord& record) {
    const auto solved = radiosity::read_solution(folder / "solution.vtkhdf");
    const auto quality = element_quality(solved.solution);
    record.figures.tet_quality_min = quality.tet_min;
    record.figures.tet_quality_mean = quality.tet_mean;
    record.figures.triangle_quality_min = quality.triangle_min;
    record.figures.triangle_quality_mean = quality.triangle_mean;
    const render::Plane plane =
        job.slice.value_or(render::default_plane(*solved.solution.enclosure));
    render::write_image(folder / "slice.png", render::field_slice(solved.solution, plane).image);
    if (fs::exists(folder / "image.exr")) {
        const auto picture =
            render::tone_map(render::read_image(folder / "image.exr"), file.tone_map);
        const auto& camera = find_camera(file.cameras, file.view_camera);
        render::write_image(folder / "overlay.png",
                            render::mesh_overlay(solved.solution, camera, picture));
    }
    draw_passes(job, folder);
    record.drawn = drawing_text(job);
}

std::vector<std::string> arguments_of(const StudyJob& job, const fs::path& folder) {
    std::vector<std::string> arguments{"run", fs::absolute(job.scene).string(), "-o",
                                       folder.string(), "--quiet"};
    if (job.threads > 0)
        arguments.insert(arguments.end(), {"--threads", std::to_string(job.threads)});
    for (const auto& text : job.overrides) arguments.push_back("--set=" + text);
    return arguments;
}

// Runs in `part` and fills the record; false if stopped.
bool run_anew(const StudyJob& job, const SceneFile& file, const fs::path& part,
              ProgressLine& progress, RunRecord& record) {
    const auto messages = part / "messages.txt";
    const auto callback = progress.callback();
    const auto outcome = run_child(job.program, arguments_of(job, part), messages, [&] {
        callback({job.label, 0.0, 0, 0.0});
        return !progress.stopped();
    });
    if (outcome.stop_was_asked) return false;
    const bool pictured = file.cameras.empty() || fs::exists(part / "image.exr");
    if (outcome.exit_code != 0)
        record.failure = why_it_failed(outcome, messages);
    else if (!pictured)
        record.failure = "it was stopped from outside before it had made its picture.";
    else
        record.figures = figures_of(part, outcome);
    if (record.failed()) return true;
    if (last_message(messages).empty()) fs::remove(messages);
    look_at_mesh(job, file, part, record);
    return true;
}

void redraw(const StudyJob& job, const SceneFile& file, RunRecord& record) {
    if (record.drawn == drawing_text(job)) return;
    look_at_mesh(job, file, job.folder, record);
    write_record(job.folder, record);
}

}  // namespace

std::string run_key(const fs::path& scene, const SceneFile& file) {
    std::string text = std::string(TYNDALL_VERSION) + "\n" + file.effective_toml;
    add_files(toml::parse(file.effective_toml), scene.parent_path(), text);
    return digest(text);
}

bool is_done(const fs::path& folder, const std::string& key) {
    const auto record = read_record(folder);
    return record && record->key == key && !record->failed();
}

std::optional<RunRecord> perform(const StudyJob& job, const SceneFile& file,
                                 ProgressLine& progress) {
    const auto key = run_key(job.scene, file);
    if (is_done(job.folder, key)) {
        auto record = *read_record(job.folder);
        redraw(job, file, record);
        return record;
    }
    const fs::path part = job.folder.string() + ".part";
    fs::remove_all(part);
    prepare_folder(part);
    RunRecord record;
    record.key = key;
    record.overrides = job.overrides;
    try {
        if (!run_anew(job, file, part, progress, record)) return std::nullopt;
    } catch (const nlohmann::json::exception& error) {
        record.failure = fmt::format("its report cannot be read ({}).", error.what());
    } catch (const mesh::InputError& error) {
        record.failure = error.what();
    }
    write_record(part, record);
    fs::remove_all(job.folder);
    fs::rename(part, job.folder);
    return record;
}

}  // namespace tyndall::cli
