#include "cli/passes.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <set>
#include <sstream>

#include "cli/file_series.h"
#include "cli/job.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

// Passes by number.
std::map<int, fs::path> pass_files(const fs::path& folder) {
    std::map<int, fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        const std::string name = entry.path().stem().string();
        int number = 0;
        const auto read = std::from_chars(name.data(), name.data() + name.size(), number);
        if (entry.path().extension() == ".vtkhdf" && read.ec == std::errc() &&
            read.ptr == name.data() + name.size())
            files[number] = entry.path();
    }
    return files;
}

// All passes of the folder, for ParaView; the number of a pass is its time.
void write_series(const fs::path& folder) {
    std::vector<std::pair<std::string, double>> series;
    for (const auto& [number, path] : pass_files(folder / "passes"))
        series.emplace_back("passes/" + path.filename().string(), number);
    mesh::write_file(folder / "passes.vtkhdf.series", file_series(series));
}

std::shared_ptr<const radiosity::KeptMesh> mesh_of(radiosity::Solution&& solution) {
    return std::make_shared<const radiosity::KeptMesh>(
        radiosity::KeptMesh{solution.enclosure->mesh, std::move(solution.forest)});
}

// The first line of a text that another has not, or not as often.
std::string first_line_beyond(const std::string& other, const std::string& text) {
    std::multiset<std::string> known;
    std::istringstream before(other), after(text);
    std::string line;
    while (std::getline(before, line)) known.insert(line);
    while (std::getline(after, line)) {
        const auto same = known.find(line);
        if (same == known.end() && !line.empty()) return line;
        if (same != known.end()) known.erase(same);
    }
    return "nothing";
}

// What two texts differ in, for a message.
std::string difference(const std::string& there, const std::string& here) {
    constexpr std::size_t most = 80;
    return fmt::format("there: {}; here: {}", first_line_beyond(here, there).substr(0, most),
                       first_line_beyond(there, here).substr(0, most));
}

std::shared_ptr<const radiosity::KeptMesh> mesh_to_go_on_with(const fs::path& path,
                                                              const SceneFile& file) {
    radiosity::SolutionFile pass;
    try {
        pass = radiosity::read_solution(path);
    } catch (const InputError& error) {
        throw InputError(fmt::format(
            "{} Or remove that file: the run then goes on from the pass before.", error.what()));
    }
    const std::string scene = attached_scene(pass.attachments);
    if (scene != file.effective_toml)
        throw InputError(
            fmt::format("'{}' is a pass of another scene, or of other settings ({}). Give the "
                        "scene and the settings it was made with, or leave out --resume.",
                        path.string(), difference(scene, file.effective_toml)));
    return mesh_of(std::move(pass.solution));
}

}  // namespace

PassPlan plan_passes(const SceneFile& file, const fs::path& folder, const PassChoice& choice) {
    const fs::path folder_of_passes = folder / "passes";
    const auto files = pass_files(folder_of_passes);
    PassPlan plan;
    int last = 0;
    if (!choice.replay.empty()) {
        plan.passes.begin_with =
            mesh_of(radiosity::read_solution(solution_path(choice.replay)).solution);
        plan.passes.frozen = true;
    } else if (choice.resume && !files.empty()) {
        last = files.rbegin()->first;
        plan.resumed_from = files.rbegin()->second;
        plan.passes.begin_with = mesh_to_go_on_with(plan.resumed_from, file);
    }
    prepare_folder(folder_of_passes);
    if (!choice.resume) {
        fs::remove(folder / "passes.vtkhdf.series");  // first: it never names what is not there
        for (const auto& [number, old] : files) fs::remove(old);
    }
    plan.passes.save = [folder, folder_of_passes, attachments = attachments_json(file),
                        number = last](const radiosity::Solution& solution) mutable {
        radiosity::write_solution(folder_of_passes / fmt::format("{:02}.vtkhdf", ++number),
                                  solution, attachments);
        write_series(folder);
    };
    return plan;
}

}  // namespace tyndall::cli
