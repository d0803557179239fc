#include "cli/study_histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cli/job.h"
#include "cli/study_matrix.h"
#include "cli/study_plot.h"
#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/report_json.h"

namespace tyndall::cli {
namespace {

using radiosity::SolverStep;

constexpr std::array<std::string_view, 7> solver_keys{
    "solve.solver",           "solve.shots",   "solve.over_relaxation",
    "solve.overshooting",     "solve.ambient", "solve.solver_tolerance",
    "solve.solver_iterations"};

// What sets a run apart: its curve and, where there are several on it, the place on it.
std::string name_of(const StudyRun& run, const std::vector<StudyRow>& rows) {
    const auto on_curve = std::count_if(
        rows.begin(), rows.end(), [&](const StudyRow& row) { return row.run.curve == run.curve; });
    return on_curve > 1 && run.along ? fmt::format("{}, {:g}", run.curve, *run.along) : run.curve;
}

std::optional<radiosity::Report> report_of(const std::filesystem::path& folder,
                                           const StudyRow& row) {
    if (row.record.failed()) return std::nullopt;
    try {
        const auto path = folder / "runs" / row.run.slug / "report.json";
        return radiosity::report_from_json(mesh::read_file(path));
    } catch (const mesh::InputError&) {
        return std::nullopt;  // of an earlier version, or taken away
    }
}

std::vector<SolverStep> slowest_band(const std::vector<SolverStep>& history) {
    const auto slowest = std::max_element(
        history.begin(), history.end(),
        [](const SolverStep& a, const SolverStep& b) { return a.iterations < b.iterations; });
    std::vector<SolverStep> steps;
    for (const auto& step : history)
        if (step.band == slowest->band) steps.push_back(step);
    return steps;
}

}  // namespace

bool compares_solvers(const Study& study) {
    const auto keys = axis_keys(study);
    return std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
        return std::find(solver_keys.begin(), solver_keys.end(), key) != solver_keys.end();
    });
}

const std::vector<HistoryPlot>& history_plots() {
    static const std::string cpu = "CPU time of the solver [s]";
    static const std::vector<HistoryPlot> plots{
        {"solver_residual_iterations.svg", "residual of the linear system", "passes over the rows",
         "residual [-]", true, [](const SolverStep& s) { return s.residual; }},
        {"solver_residual_cpu.svg", "residual of the linear system", cpu, "residual [-]", false,
         [](const SolverStep& s) { return s.residual; }},
        {"solver_unshot_cpu.svg", "power that is unshot", cpu, "unshot power [W]", false,
         [](const SolverStep& s) { return s.unshot_power; }},
        {"solver_balance_cpu.svg", "energy balance", cpu, "imbalance / power brought in [-]", false,
         [](const SolverStep& s) { return std::abs(s.energy_balance); }},
    };
    return plots;
}

Curve history_curve(const std::string& name, const std::vector<SolverStep>& history,
                    std::size_t elements, const HistoryPlot& plot) {
    Curve curve{name, {}};
    for (const auto& step : history.empty() ? history : slowest_band(history)) {
        const double value = plot.value(step);
        const double passes = step.shots > 0 && elements > 0
                                  ? static_cast<double>(step.shots) / static_cast<double>(elements)
                                  : static_cast<double>(step.iterations);
        const double cost = plot.against_iterations ? passes : step.cpu_seconds;
        if ((plot.against_iterations || cost > 0.0) && value > 0.0)
            curve.points.push_back({cost, value});
    }
    return curve;
}

void write_history_plots(const std::filesystem::path& folder, const Study& study,
                         const std::vector<StudyRow>& rows) {
    if (!compares_solvers(study)) return;
    prepare_folder(folder / "plots");
    for (const auto& wanted : history_plots()) {
        Plot plot{study.title + ": " + wanted.title, wanted.x_label, wanted.y_label, {}, {}};
        plot.times = 1.0;
        plot.slopes = false;
        plot.marks = 12;
        plot.linear_x = wanted.against_iterations;
        for (const auto& row : rows)
            if (const auto report = report_of(folder, row)) {
                auto curve = history_curve(name_of(row.run, rows), report->solver.history,
                                           report->solved_elements, wanted);
                if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
            }
        mesh::write_file(folder / "plots" / wanted.file, svg_of(plot));
    }
}

std::string solvers_section(const std::filesystem::path& folder,
                            const std::vector<StudyRow>& rows) {
    std::string text =
        "## Solvers\n\nOf the last linear system of each run: passes over the rows (shots over "
        "elements), CPU time without what the history takes, what is left.\n\n"
        "| run | solver | passes | shots | CPU s | residual | unshot W | converged |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const auto& row : rows) {
        const auto report = report_of(folder, row);
        if (!report) continue;
        const auto* solver = &report->solver;
        double seconds = 0.0;  // bands follow each other, and each begins at 0
        for (std::size_t k = 0; k < solver->history.size(); ++k)
            if (k + 1 == solver->history.size() ||
                solver->history[k + 1].band != solver->history[k].band)
                seconds += solver->history[k].cpu_seconds;
        text += fmt::format("| {} | {} | {} | {} | {:.3g} | {:.1e} | {:.2g} | {} |\n",
                            name_of(row.run, rows), solver->method, solver->iterations,
                            solver->shots, seconds, solver->residual, solver->unshot_power,
                            solver->converged ? "yes" : "no");
    }
    text += "\n";
    for (const auto& plot : history_plots())
        text += fmt::format("![{} against {}](plots/{})\n", plot.title, plot.x_label, plot.file);
    return text + "\n";
}

}  // namespace tyndall::cli
