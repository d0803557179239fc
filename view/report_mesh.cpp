#include "view/report_mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "view/charts.h"
#include "view/markup.h"
#include "view/report_sections.h"

namespace tyndall::view {
namespace {

using Values = std::vector<double>;

void add_spread(Table& table, const std::string& name, const Values& values) {
    const Spread s = spread_of(values);
    if (s.count == 0) return;
    table.rows.push_back({name, std::to_string(s.count), figure(s.least), figure(s.median),
                          figure(s.mean), figure(s.most)});
}

std::string spreads_table(const MeshStatistics& m) {
    Table table{"Elements of the finest mesh",
                {"quantity", "elements", "least", "median", "mean", "most"},
                {}};
    add_spread(table, "area of patches [m²]", m.patch_area);
    add_spread(table, "volume of zones [m³]", m.zone_volume);
    add_spread(table, "radius ratio of patches", m.patch_radius_ratio);
    add_spread(table, "radius ratio of zones", m.zone_radius_ratio);
    add_spread(table, "mean ratio of patches", m.patch_mean_ratio);
    add_spread(table, "mean ratio of zones", m.zone_mean_ratio);
    add_spread(table, "level of patches", m.patch_level);
    add_spread(table, "level of zones", m.zone_level);
    add_spread(table, "optical thickness of zones", m.zone_thickness);
    add_spread(table, "estimated error of patches [W/(m² sr)]", m.patch_error);
    add_spread(table, "estimated error of zones [W/(m² sr)]", m.zone_error);
    return table_markup(table);
}

std::string bins_table(const std::string& caption, const Histogram& h) {
    Table table{caption, {"from", "to"}, {}};
    table.heads.insert(table.heads.end(), h.kinds.begin(), h.kinds.end());
    for (std::size_t b = 0; b + 1 < h.edges.size(); ++b) {
        std::vector<std::string> row{figure(h.edges[b]), figure(h.edges[b + 1])};
        for (const auto& counts : h.counts) row.push_back(std::to_string(counts[b]));
        table.rows.push_back(row);
    }
    std::size_t zeros = 0;
    for (const std::size_t count : h.zeros) zeros += count;
    if (zeros > 0) {
        std::vector<std::string> row{"0", "0"};
        for (const std::size_t count : h.zeros) row.push_back(std::to_string(count));
        table.rows.insert(table.rows.begin(), row);
    }
    return table_markup(table);
}

std::string figure_of(const std::string& title, const std::string& x_label, const Histogram& h) {
    std::size_t zeros = 0;
    for (const std::size_t count : h.zeros) zeros += count;
    const std::string left_out =
        zeros > 0 ? fmt::format(" {} elements, of which it is 0, are left out.", zeros) : "";
    return folded_figure(
        title,
        histogram_chart({title,
                         "How many elements lie in each range; the numbers stand in the "
                         "table below." +
                             left_out,
                         x_label, "elements"},
                        h),
        bins_table(title + ": elements in each range", h));
}

}  // namespace

std::string mesh_figures(const MeshStatistics& m) {
    if (m.patch_area.empty() && m.zone_volume.empty()) return "";
    const std::vector<std::string> both{"patches", "zones"};
    std::string charts;
    charts +=
        figure_of("Volume of zones", "volume [m³]", log_histogram({"zones"}, {m.zone_volume}));
    charts += figure_of("Area of patches", "area [m²]", log_histogram({"patches"}, {m.patch_area}));
    charts += figure_of("Radius ratio: 1 is regular, 0 is flat", "radius ratio",
                        share_histogram(both, {m.patch_radius_ratio, m.zone_radius_ratio}));
    charts += figure_of("Level: bisections since the base mesh", "level",
                        whole_histogram(both, {m.patch_level, m.zone_level}));
    charts += figure_of("Optical thickness of zones", "extinction × size",
                        log_histogram({"zones"}, {m.zone_thickness}));
    charts += figure_of("Estimated error of elements", "estimated error [W/(m² sr)]",
                        log_histogram(both, {m.patch_error, m.zone_error}));
    return spreads_table(m) +
           "<p>Size is the cube root of the volume. Radius ratio and mean ratio say how regular an "
           "element is (Liu &amp; Joe 1994): 1 for equal edges, 0 for a flat one.</p>\n"
           "<div class=\"charts\">" +
           charts + "</div>\n";
}

}  // namespace tyndall::view
