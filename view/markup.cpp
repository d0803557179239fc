#include "view/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tyndall::view {
namespace {

constexpr const char* not_known = "not known";

// Figures stand to the right.
bool is_figure(const std::string& cell) {
    return !cell.empty() && ((cell[0] >= '0' && cell[0] <= '9') || cell.starts_with("−") ||
                             cell.starts_with(not_known));
}

const char* number_class(const Table& table, std::size_t column) {
    const bool number = column > 0 && table.numbers &&
                        std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
                            return column < row.size() && is_figure(row[column]);
                        });
    return number ? " class=\"number\"" : "";
}

std::string row_markup(const std::vector<std::string>& cells,
                       const std::vector<std::string>& classes) {
    std::string row = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k)
        row += k == 0 ? "<th scope=\"row\">" + escaped(cells[k]) + "</th>"
                      : "<td" + classes[std::min(k, classes.size() - 1)] + ">" + escaped(cells[k]) +
                            "</td>";
    return row + "</tr>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (const char c : text) {
        if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '&')
            result += "&amp;";
        else if (c == '"')
            result += "&quot;";
        else if (c == '\'')
            result += "&#39;";
        else if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f)
            result += c;
        else if (c == '\n' || c == '\t')
            result += ' ';
    }
    return result;
}

std::string multiline(std::string_view text) {
    std::string result;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        result += escaped(text.substr(at, end - at));
        if (end < text.size()) result += '\n';
        at = end + 1;
    }
    return result;
}

std::string figure(double value) {
    if (!std::isfinite(value)) return not_known;
    if (value == 0.0) return "0";
    const double size = std::abs(value);
    const std::string digits = fmt::format("{:.4g}", size);
    // Whole numbers below a million are written as such.
    const bool whole = size < 1e6 && size == std::round(size);
    return (value < 0.0 ? "−" : "") + (whole ? fmt::format("{:.0f}", size) : digits);
}

std::string percent(double share) {
    return std::isfinite(share) ? figure(100.0 * share) + " %" : not_known;
}

std::string seconds(double time) {
    if (!std::isfinite(time) || time <= 0.0) return not_known;
    return time < 600.0 ? fmt::format("{:.3g} s", time) : fmt::format("{:.1f} min", time / 60.0);
}

std::string megabytes(double bytes) {
    if (!std::isfinite(bytes) || bytes <= 0.0) return not_known;
    return fmt::format("{:.3g} MB", bytes / 1e6);
}

std::string table_markup(const Table& table) {
    if (table.rows.empty()) return "";
    std::string text =
        "<div class=\"wide\"><table><caption>" + escaped(table.caption) + "</caption>\n";
    std::vector<std::string> classes;
    text += "<thead><tr>";
    for (std::size_t k = 0; k < table.heads.size(); ++k) {
        classes.push_back(number_class(table, k));
        text += "<th scope=\"col\"" + classes[k] + ">" + escaped(table.heads[k]) + "</th>";
    }
    text += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) text += row_markup(row, classes);
    return text + "</tbody></table></div>\n";
}

std::string folded_markup(const std::string& summary, const std::string& content) {
    return "<div><details class=\"fold\"><summary>" + summary +
           "</summary></details><div class=\"folded\">" + content + "</div></div>";
}

}  // namespace tyndall::view
