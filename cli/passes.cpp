#include "cli/passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cli/job.h"
#include "mesh/input_error.h"
#include "radiosity/solution_file.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

std::vector<fs::path> pass_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().extension() == ".vtkhdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::shared_ptr<const mesh::Forest> mesh_of(const fs::path& path, const SceneFile& file) {
    const auto pass = radiosity::read_solution(path);
    if (attached_scene(pass.attachments) != file.effective_toml)
        throw InputError(
            fmt::format("'{}' is a pass of another scene, or of other settings. Give the scene it "
                        "was made from, or leave out --resume.",
                        path.string()));
    return std::make_shared<const mesh::Forest>(pass.solution.forest);
}

}  // namespace

radiosity::Passes passes_of(const SceneFile& file, const fs::path& folder,
                            const PassChoice& choice) {
    const fs::path passes = folder / "passes";
    radiosity::Passes result;
    if (!choice.replay.empty()) {
        result.begin_with = std::make_shared<const mesh::Forest>(
            radiosity::read_solution(solution_path(choice.replay)).solution.forest);
        result.frozen = true;
    } else if (choice.resume) {
        if (const auto files = pass_files(passes); !files.empty())
            result.begin_with = mesh_of(files.back(), file);
    }
    if (!choice.resume)
        for (const auto& old : pass_files(passes)) fs::remove(old);
    prepare_folder(passes);
    result.save = [passes, attachments = attachments_json(file),
                   number = 0](const radiosity::Solution& solution) mutable {
        radiosity::write_solution(passes / fmt::format("{:02}.vtkhdf", ++number), solution,
                                  attachments);
    };
    return result;
}

}  // namespace tyndall::cli
