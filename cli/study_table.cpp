#include "cli/study_table.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;

// In quotes where CSV asks for it (RFC 4180).
std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == text.npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c == '\n' || c == '\r' ? ' ' : c;
    }
    return quoted + "\"";
}

std::string number_cell(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

// The columns behind the axes: their names and, for a row that did not fail, their values.
struct Column {
    std::string name;
    Json value;
};

std::vector<Column> columns_of(const Study& study, const RunRecord& record) {
    const auto& f = record.figures;
    std::vector<Column> columns{{"patches", f.patches},
                                {"zones", f.zones},
                                {"rays", f.rays},
                                {"cpu_seconds", f.cpu_seconds},
                                {"wall_seconds", f.wall_seconds},
                                {"memory_bytes", f.memory_bytes}};
    for (const auto& measure : study.measures) {
        const std::string name(measure.name());
        const auto found = record.errors.find(name);
        const auto add = [&](const char* figure, double MeasureErrors::*value) {
            columns.push_back({name + figure,
                               found == record.errors.end() ? Json() : Json(found->second.*value)});
        };
        add("_rmse", &MeasureErrors::rmse);
        add("_bias", &MeasureErrors::bias);
        add("_block4", &MeasureErrors::block4);
        add("_block16", &MeasureErrors::block16);
    }
    columns.insert(columns.end(), {{"tet_quality_min", f.tet_quality_min},
                                   {"tet_quality_mean", f.tet_quality_mean},
                                   {"triangle_quality_min", f.triangle_quality_min},
                                   {"triangle_quality_mean", f.triangle_quality_mean},
                                   {"estimated_error", f.estimated_error},
                                   {"estimated_picture_error", f.estimated_picture_error},
                                   {"estimated_solution_error", f.estimated_solution_error}});
    if (record.failed())
        for (auto& column : columns) column.value = nullptr;
    return columns;
}

std::string cell(const Json& value) {
    if (value.is_null()) return "";
    if (value.is_number_float()) return number_cell(value.get<double>());
    return value.dump();
}

std::string need_text(const Need& need) {
    const char* mark = need.kind == Need::Kind::at        ? ""
                       : need.kind == Need::Kind::at_most ? "<="
                                                          : ">";
    return mark + number_cell(need.cost);
}

std::string slope_text(const Need& need) {
    return need.by_slope ? number_cell(*need.by_slope) : "";
}

Json row_json(const Study& study, const StudyRow& row) {
    Json json;
    const auto keys = axis_keys(study);
    for (std::size_t k = 0; k < keys.size(); ++k)
        json[keys[k]] = row.run.cells[k].empty() ? Json() : Json(row.run.cells[k]);
    for (auto& column : columns_of(study, row.record)) json[column.name] = std::move(column.value);
    json["failure"] = row.record.failed() ? Json(row.record.failure) : Json();
    json["folder"] = "runs/" + row.run.slug;
    return json;
}

}  // namespace

std::vector<Figure> figures_of(const StudyMeasure& measure) {
    if (!measure.of_picture()) return {Figure::rmse};
    return {Figure::rmse, Figure::block4, Figure::block16};
}

std::string study_csv(const Study& study, const std::vector<StudyRow>& rows) {
    std::string text;
    for (const auto& key : axis_keys(study)) text += csv_cell(key) + ",";
    for (const auto& column : columns_of(study, {})) text += column.name + ",";
    text += "failure\n";
    for (const auto& row : rows) {
        for (const auto& value : row.run.cells) text += csv_cell(value) + ",";
        for (const auto& column : columns_of(study, row.record)) text += cell(column.value) + ",";
        text += csv_cell(row.record.failure) + "\n";
    }
    return text;
}

std::vector<Target> targets_of(const Study& study, const std::vector<StudyRow>& rows) {
    std::vector<Target> targets;
    for (const auto& measure : study.measures)
        for (const Figure figure : figures_of(measure)) {
            const std::string name(measure.name());
            const auto elements = curves_of(rows, name, figure, Cost::elements);
            const auto seconds = curves_of(rows, name, figure, Cost::cpu_seconds);
            for (const double error : study.errors)
                for (std::size_t c = 0; c < elements.size(); ++c)
                    targets.push_back({elements[c].name, name, figure, error,
                                       needed_for(elements[c], error),
                                       needed_for(seconds[c], error)});
        }
    return targets;
}

std::string targets_csv(const std::vector<Target>& targets) {
    std::string text =
        "measure,figure,error,curve,elements,cpu_seconds,elements_by_slope,cpu_seconds_by_slope\n";
    for (const auto& t : targets)
        text += fmt::format("{},{},{:g},{},{},{},{},{}\n", t.measure,
                            figure_names[static_cast<std::size_t>(t.figure)], t.error,
                            csv_cell(t.curve), need_text(t.elements), need_text(t.cpu_seconds),
                            slope_text(t.elements), slope_text(t.cpu_seconds));
    return text;
}

std::string study_json(const Study& study, const std::vector<StudyRow>& rows) {
    Json json{{"rows", Json::array()}, {"targets", Json::array()}};
    for (const auto& row : rows) json["rows"].push_back(row_json(study, row));
    for (const auto& t : targets_of(study, rows))
        json["targets"].push_back({{"measure", t.measure},
                                   {"figure", figure_names[static_cast<std::size_t>(t.figure)]},
                                   {"error", t.error},
                                   {"curve", t.curve},
                                   {"elements", need_text(t.elements)},
                                   {"cpu_seconds", need_text(t.cpu_seconds)},
                                   {"elements_by_slope", slope_text(t.elements)},
                                   {"cpu_seconds_by_slope", slope_text(t.cpu_seconds)}});
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tyndall::cli
