#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "cli/commands.h"
#include "cli/job.h"
#include "cli/study_matrix.h"
#include "cli/study_reference.h"
#include "cli/study_run.h"
#include "cli/study_summary.h"
#include "cli/study_table.h"
#include "cli/toml_reader.h"
#include "cli/wrong_file.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using mesh::InputError;

struct StudyOptions {
    std::string study, out;
    bool again = false;
};

// A study on its way through its runs.
Study study_of(const std::string& path) {
    require_study(path);
    return read_study_file(path);
}

class Session {
  public:
    Session(const StudyOptions& options, const CommonFlags& flags)
        : options_(options),
          flags_(flags),
          study_(study_of(options.study)),
          runs_(expand(study_, flags)),
          folder_(options.out),
          progress_(flags) {}

    int run() {
        check();
        prepare_folder(folder_);
        if (options_.again) forget_runs();
        if (!load_references() || !do_runs()) return say_stopped();
        write_results();
        return say_done();
    }

  private:
    // All scenes and what they give to measure, before any run.
    void check() const {
        for (const auto& run : runs_) {
            const auto file = scene_with(study_, run.overrides);
            for (const auto& measure : study_.measures)
                if (measure.of_picture() && file.cameras.empty())
                    fail_at(study_.scene_place,
                            fmt::format("the scene has no camera, and {} is to be measured. Add a "
                                        "[[camera]], or measure \"probe\".",
                                        measure.name()));
        }
        for (const auto& run : runs_)
            for (const auto& measure : study_.measures)
                if (measure.reference.file.empty()) reference_scene(measure, run);
    }

    void forget_runs() const {
        fs::remove_all(folder_ / "runs");
        fs::remove_all(folder_ / "references");
    }

    // A finer run of the same scene: of [set], of the axes that change the scene, its own.
    std::vector<PlacedSetting> reference_settings(const StudyMeasure& measure,
                                                  const StudyRun& run) const {
        auto settings = common_settings(study_, flags_);
        for (const auto* more : {&run.scene_overrides, &measure.reference.overrides})
            settings.insert(settings.end(), more->begin(), more->end());
        return settings;
    }
    SceneFile reference_scene(const StudyMeasure& measure, const StudyRun& run) const {
        return scene_with(study_, reference_settings(measure, run));
    }

    StudyJob job(const fs::path& folder, const std::vector<PlacedSetting>& settings,
                 std::string label) const {
        std::vector<std::string> texts;
        for (const auto& setting : settings) texts.push_back(setting.text());
        StudyJob job{"/proc/self/exe",
                     study_.scene,
                     std::move(texts),
                     folder,
                     std::move(label),
                     flags_.threads,
                     {}};
        if (study_.slice) job.slice = render::Plane{study_.slice->point, study_.slice->normal};
        return job;
    }

    // The finer run that a measure refers to; the same run is made once for all measures.
    fs::path reference_run(const StudyMeasure& measure, const StudyRun& run) {
        const auto file = reference_scene(measure, run);
        const auto key = run_key(study_.scene, file);
        if (const auto found = reference_folders_.find(key); found != reference_folders_.end())
            return found->second;
        std::string name = run.scene_slug.empty() ? "reference" : run.scene_slug;
        for (const auto& [other, taken] : reference_folders_)
            if (taken.filename() == name) name += fmt::format("_{}", measure.name());
        const fs::path folder = folder_ / "references" / name;
        const auto record = perform(job(folder, reference_settings(measure, run),
                                        fmt::format("reference {}", run.scene_slug)),
                                    file, progress_);
        if (!record) return {};
        if (record->failed())
            fail_at(measure.reference.place,
                    fmt::format("the run of the reference failed: {}", record->failure));
        reference_folders_[key] = folder;
        return folder;
    }

    // What a run is measured by, loaded or made. False if stopped.
    bool load_references(const StudyRun& run) {
        auto& references = references_[run.scene_slug];
        if (!references.empty()) return true;
        for (const auto& measure : study_.measures) {
            auto reference = load_reference(
                study_, measure, [&](const auto& m) { return reference_run(m, run); },
                progress_.callback());
            if (!reference) return false;
            references.push_back(std::move(*reference));
        }
        return true;
    }

    bool load_references() {
        for (const auto& run : runs_) {
            if (!load_references(run)) return false;
            for (const auto& reference : references_[run.scene_slug]) check_size(reference, run);
        }
        return true;
    }

    void check_size(const Reference& reference, const StudyRun& run) const {
        if (!reference.measure.of_picture()) return;
        const auto file = scene_with(study_, run.overrides);
        const auto& camera = find_camera(file.cameras, file.view_camera);
        const auto fail = [&](const std::string& what) {
            fail_at(reference.measure.reference.place,
                    fmt::format("the reference of {} has {}", reference.measure.name(), what));
        };
        if (camera.width != reference.width || camera.height != reference.height)
            fail(fmt::format(
                "{} × {} pixels, and the picture of run {} will have {} × {}. Set the "
                "camera's width and height in [set].",
                reference.width, reference.height, run.slug, camera.width, camera.height));
        if (file.scene.bands != reference.layer.channels)
            fail(fmt::format("{} channels, and the scene has {} bands. Give one with as many.",
                             reference.layer.channels, file.scene.bands));
    }

    bool do_runs() {
        for (std::size_t k = 0; k < runs_.size(); ++k) {
            const auto& run = runs_[k];
            const auto file = scene_with(study_, run.overrides);
            const auto folder = folder_ / "runs" / run.slug;
            auto record =
                perform(job(folder, run.overrides,
                            fmt::format("run {} of {}: {}", k + 1, runs_.size(), run.slug)),
                        file, progress_);
            if (!record) return false;
            measure(folder, references_[run.scene_slug], *record);
            if (progress_.stopped()) return false;
            rows_.push_back({run, std::move(*record)});
            mesh::write_file(folder_ / "study.csv", study_csv(study_, rows_));
        }
        return true;
    }

    void measure(const fs::path& folder, const std::vector<Reference>& references,
                 RunRecord& record) {
        for (const auto& reference : references) {
            if (record.failed()) return;
            try {
                measure_run(study_, reference, folder, record, progress_.callback());
            } catch (const InputError& error) {
                if (!progress_.stopped()) record.failure = error.what();
            }
        }
    }

    void write_results() const {
        mesh::write_file(folder_ / "study.csv", study_csv(study_, rows_));
        write_plots(folder_, study_, rows_);
        mesh::write_file(folder_ / "targets.csv", targets_csv(targets_of(study_, rows_)));
        mesh::write_file(folder_ / "study.md", summary_of(folder_, study_, rows_));
    }

    int say_stopped() {
        if (!rows_.empty()) write_results();
        progress_.clear();
        throw InputError(
            fmt::format("stopped on request: {} of {} runs are done. The same command goes on "
                        "from there.",
                        rows_.size(), runs_.size()));
    }

    int say_done() {
        progress_.clear();
        std::size_t failed = 0;
        std::string first;
        for (const auto& row : rows_) {
            if (!row.record.failed()) continue;
            if (failed++ == 0) first = fmt::format("run {}: {}", row.run.slug, row.record.failure);
        }
        if (flags_.json)
            write_output(study_json(study_, rows_));
        else if (!flags_.quiet)
            write_output(summary_text());
        if (failed > 0)
            throw InputError(fmt::format("{} of {} runs failed; {}", failed, rows_.size(), first));
        return 0;
    }

    std::string summary_text() const {
        auto text = fmt::format("study    {} runs of {}\n", rows_.size(), study_.scene.string());
        for (const auto& row : rows_) {
            text += fmt::format("run      {}", row.run.slug);
            if (!row.record.failed())
                text += fmt::format(", {} elements, {:.1f} CPU s", row.record.figures.elements(),
                                    row.record.figures.cpu_seconds);
            for (const auto& [name, errors] : row.record.errors)
                if (!row.record.failed())
                    text += fmt::format(", {} {:.3g} %", name, 100.0 * errors.rmse);
            text += row.record.failed() ? ": failed\n" : "\n";
        }
        for (const char* name : {"study.md", "study.csv", "targets.csv", "plots/", "runs/"})
            text += fmt::format("wrote    {}\n", (folder_ / name).string());
        return text;
    }

    const StudyOptions& options_;
    const CommonFlags& flags_;
    Study study_;
    std::vector<StudyRun> runs_;
    fs::path folder_;
    ProgressLine progress_;
    std::map<std::string, fs::path> reference_folders_;         // by the key of the run
    std::map<std::string, std::vector<Reference>> references_;  // by the slug of the scene
    std::vector<StudyRow> rows_;
};

}  // namespace

void add_study_command(Shell& shell) {
    const auto options = std::make_shared<StudyOptions>();
    auto command = shell.add_command(
        "study", "Discretization studies: many runs of a scene against a reference",
        R"(  tyndall study examples/studies/shafts_soft.toml -o study/
  tyndall study study.toml -o study/ --json > rows.json       the same again only measures)",
        [options](const CommonFlags& flags) { return Session(*options, flags).run(); });
    add_seed_flag(command, shell.flags());
    add_set_flag(command, shell.flags());
    command.option("STUDY", options->study, "Study file").required().file({"toml"});
    command.option("-o,--output", options->out, "Folder for the results").required().folder();
    command.flag("--again", options->again, "Make all runs anew, done ones and references too");
}

}  // namespace tyndall::cli
