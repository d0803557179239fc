#include "cli/study_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "cli/job.h"
#include "cli/study_histories.h"
#include "cli/study_plot.h"
#include "cli/study_table.h"
#include "mesh/file_bytes.h"
#include "view/plot_axis.h"

namespace tyndall::cli {
namespace {

std::string_view name_of(Figure figure) {
    return figure_names[static_cast<std::size_t>(figure)];
}

std::string words_of(const std::string& measure) {
    if (measure == "single_scattering") return "direct light and single scattering";
    if (measure == "surfaces") return "light from surfaces";
    if (measure == "media") return "light from media";
    return measure == "probe" ? "probes" : "picture";
}

std::string words_of(Figure figure) {
    if (figure == Figure::rmse) return "RMSE";
    return figure == Figure::block4 ? "RMSE of 4×4 blocks" : "RMSE of 16×16 blocks";
}

std::string plot_name(const std::string& measure, Figure figure, Cost cost) {
    return fmt::format("{}_{}_{}.svg", measure, name_of(figure),
                       cost == Cost::elements ? "elements" : "cpu");
}

// Markdown's tables have bars of their own.
std::string table_cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != text.npos; at += 2)
        text.replace(at, 1, "\\|");
    for (char& c : text)
        if (c == '\n') c = ' ';
    return text;
}

std::string percent(double error) {
    return std::isfinite(error) ? fmt::format("{:.3g} %", 100.0 * error) : "";
}

// "850", "30135".
std::string cost_words(double cost) {
    return cost < 1000.0 ? fmt::format("{:.3g}", cost) : fmt::format("{:.0f}", cost);
}

// Two digits, which is more than a guess is good for: "0.85", "3200", "2.1·10⁷".
std::string guess_words(double value) {
    const double unit = 0.1 * std::pow(10.0, std::floor(std::log10(value)));
    const double rounded = unit * std::round(value / unit);
    if (rounded < 100.0) return fmt::format("{:.2g}", rounded);
    if (rounded < 999'999.5) return fmt::format("{:.0f}", rounded);
    const double decade = std::pow(10.0, std::floor(std::log10(rounded) + 1e-9));
    return fmt::format("{:.1f}·{}", rounded / decade, view::tick_text(decade));
}

std::string need_words(const Need& need) {
    const char* mark = need.kind == Need::Kind::at        ? ""
                       : need.kind == Need::Kind::at_most ? "≤ "
                                                          : "> ";
    return mark + cost_words(need.cost);
}

// How many times fewer than `first`; bounds that say something stay bounds, guesses guesses.
std::string times_fewer(const Need& first, const Need& need) {
    using Kind = Need::Kind;
    const double times = first.cost / need.cost;
    if (first.kind == Kind::at && need.kind == Kind::at) return fmt::format("{:.3g}×", times);
    std::string words;
    if (first.kind != Kind::at_most && need.kind != Kind::more_than && times > 1.0)
        words = fmt::format("> {:.3g}×", times);
    if (first.kind != Kind::more_than && need.kind == Kind::more_than && times < 1.0)
        words = fmt::format("< {:.3g}×", times);
    const bool guessed =
        (first.by_slope || first.kind == Kind::at) && (need.by_slope || need.kind == Kind::at);
    if (!guessed) return words;
    const auto guess = "≈ " + guess_words(first.guess() / need.guess()) + "×";
    return words.empty() ? guess : words + ", " + guess;
}

// One measure's figure: a row a curve, a column an error.
std::string target_table(const Study& study, const std::vector<Target>& targets,
                         const std::string& measure, Figure figure) {
    std::string head = "| curve |", rule = "|---|";
    for (const double error : study.errors) {
        head += fmt::format(" {} |", percent(error));
        rule += "---|";
    }
    std::map<double, Need> first;  // of the first curve, by error
    std::vector<std::pair<std::string, std::string>> lines;
    for (const auto& t : targets) {
        if (t.measure != measure || t.figure != figure) continue;
        auto line = std::find_if(lines.begin(), lines.end(),
                                 [&](const auto& l) { return l.first == t.curve; });
        if (line == lines.end()) line = lines.insert(lines.end(), {t.curve, ""});
        const bool is_first = first.emplace(t.error, t.elements).second;
        const auto times = is_first ? "" : times_fewer(first.at(t.error), t.elements);
        line->second +=
            fmt::format(" {}{}; {} s{} |", need_words(t.elements),
                        t.elements.by_slope ? " (≈ " + guess_words(*t.elements.by_slope) + ")" : "",
                        need_words(t.cpu_seconds), times.empty() ? "" : "; **" + times + "**");
    }
    if (lines.empty()) return "";
    auto text = fmt::format("### {}: {}\n\n{}\n{}\n", measure, words_of(figure), head, rule);
    for (const auto& [curve, cells] : lines)
        text += fmt::format("| {} |{}\n", table_cell(curve), cells);
    return text + "\n";
}

std::string target_tables(const Study& study, const std::vector<StudyRow>& rows) {
    const auto targets = targets_of(study, rows);
    if (targets.empty()) return "";
    std::string text =
        "## Elements for an error\n\nElements and CPU seconds, interpolated on the logarithms; "
        "bold: how many times fewer elements than the first curve. ≤: the curve's first run is "
        "good enough; >: its last is not; ≈: a guess, as if it went on with its fitted "
        "slope.\n\n";
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure))
            text += target_table(study, targets, std::string(measure.name()), figure);
    return text;
}

std::string slope_table(const Study& study, const std::vector<StudyRow>& rows) {
    std::string text =
        "## Slopes\n\nExponents p of error ~ elements^p and error ~ CPU seconds^p, fitted to all "
        "runs of a curve.\n\n| measure | figure | curve | against elements | against CPU s "
        "|\n|---|---|---|---|---|\n";
    const std::size_t head = text.size();
    const auto slope_text = [](const Curve& curve) {
        const auto slope = fitted_slope(curve);
        return slope ? fmt::format("{:.2f}", *slope) : std::string();
    };
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure)) {
            const std::string name(measure.name());
            const auto elements = curves_of(rows, name, figure, Cost::elements);
            const auto seconds = curves_of(rows, name, figure, Cost::cpu_seconds);
            for (std::size_t c = 0; c < elements.size(); ++c)
                text += fmt::format("| {} | {} | {} | {} | {} |\n", name, name_of(figure),
                                    table_cell(elements[c].name), slope_text(elements[c]),
                                    slope_text(seconds[c]));
        }
    return text.size() == head ? "" : text + "\n";
}

std::string run_table(const Study& study, const std::vector<StudyRow>& rows) {
    std::string head = "| run |", rule = "|---|", text;
    for (const char* name : {"patches", "zones", "CPU s", "MB"}) {
        head += fmt::format(" {} |", name);
        rule += "---|";
    }
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure)) {
            head += fmt::format(" {} {} |", measure.name(), name_of(figure));
            rule += "---|";
        }
    head += " picture estimated |";
    rule += "---|";
    const bool picture = std::any_of(study.measures.begin(), study.measures.end(),
                                     [](const auto& m) { return m.name() == "picture"; });
    if (picture) {
        head += " estimated / RMSE |";
        rule += "---|";
    }
    for (const auto& row : rows) {
        if (row.record.failed()) continue;
        const auto& f = row.record.figures;
        text += fmt::format("| [{0}](runs/{0}/) | {1} | {2} | {3:.1f} | {4:.0f} |", row.run.slug,
                            f.patches, f.zones, f.cpu_seconds,
                            static_cast<double>(f.memory_bytes) / 1e6);
        for (const auto& measure : study.measures) {
            const auto found = row.record.errors.find(std::string(measure.name()));
            for (const Figure figure : figures_of(measure)) {
                const bool there = found != row.record.errors.end();
                const double error = !there                     ? NAN
                                     : figure == Figure::rmse   ? found->second.rmse
                                     : figure == Figure::block4 ? found->second.block4
                                                                : found->second.block16;
                text += fmt::format(" {} |", percent(error));
            }
        }
        text += fmt::format(" {} |", percent(f.estimated_picture_error));
        if (picture) {
            const auto found = row.record.errors.find("picture");
            text += found == row.record.errors.end()
                        ? " |"
                        : fmt::format(" {:.2f} |", f.estimated_picture_error / found->second.rmse);
        }
        text += "\n";
    }
    return "## Runs\n\n" + head + "\n" + rule + "\n" + text + "\n";
}

std::string failures(const std::vector<StudyRow>& rows) {
    std::string text;
    for (const auto& row : rows)
        if (row.record.failed())
            text += fmt::format("- {}: {}\n", row.run.slug, table_cell(row.record.failure));
    return text.empty() ? "" : "## What failed\n\n" + text + "\n";
}

std::string plot_links(const Study& study) {
    std::string text = "## Plots\n\n";
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure))
            for (const Cost cost : {Cost::elements, Cost::cpu_seconds}) {
                const std::string name(measure.name());
                text +=
                    fmt::format("![{} of the {} against {}](plots/{})\n", words_of(figure),
                                words_of(name), cost == Cost::elements ? "elements" : "CPU seconds",
                                plot_name(name, figure, cost));
            }
    return text + "\n";
}

}  // namespace

void write_plots(const std::filesystem::path& folder, const Study& study,
                 const std::vector<StudyRow>& rows) {
    prepare_folder(folder / "plots");
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure))
            for (const Cost cost : {Cost::elements, Cost::cpu_seconds}) {
                const std::string name(measure.name());
                const Plot plot{
                    fmt::format("{}: {}", study.title, words_of(name)),
                    cost == Cost::elements ? "elements (patches and zones)" : "CPU time [s]",
                    words_of(figure) + " [% of the reference's mean]",
                    curves_of(rows, name, figure, cost), study.errors};
                mesh::write_file(folder / "plots" / plot_name(name, figure, cost), svg_of(plot));
            }
    write_history_plots(folder, study, rows);
}

std::string summary_of(const std::filesystem::path& folder, const Study& study,
                       const std::vector<StudyRow>& rows) {
    std::size_t failed = 0;
    for (const auto& row : rows) failed += row.record.failed();
    auto text = fmt::format("# {}\n\n{} runs of `{}`", study.title, rows.size(),
                            study.scene.filename().string());
    if (failed > 0) text += fmt::format(", {} of which failed", failed);
    text += ". Errors are relative to the reference's mean. All figures: `study.csv`.\n\n";
    return text + target_tables(study, rows) + slope_table(study, rows) + run_table(study, rows) +
           failures(rows) + (compares_solvers(study) ? solvers_section(folder, rows) : "") +
           plot_links(study);
}

}  // namespace tyndall::cli
