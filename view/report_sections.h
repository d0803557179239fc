// The parts of a report about how a solution was found, as HTML: what view.html and report.html
// share. Figures are those of report.json; what is not known is said to be so.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "view/report_facts.h"

namespace tyndall::view {

// The size of the headings: 2 for <h2>.
struct SectionLevel {
    int heading = 2;
};

// Purpose: a heading and what stands below it, as a section named by its heading. "" without
//   content.
std::string section(SectionLevel level, const std::string& id, const std::string& title,
                    const std::string& content);

// Purpose: a figure with its caption, chart and, behind it, its numbers. Either may be "".
std::string chart_figure(const std::string& caption, const std::string& chart,
                         const std::string& table);
// The same with the numbers folded away.
std::string folded_figure(const std::string& caption, const std::string& chart,
                          const std::string& table);

// Purpose: warnings of the report, and `notes`, as a list; a sentence where there are none.
std::string warnings_list(const ReportFacts& facts, const std::vector<std::string>& notes);

// The error, its parts, the checks, the cost. `goal`: solve.error, 0 not known [-].
std::string solution_table(const ReportFacts& facts, double goal);
// Elements, error, time and memory of every pass.
std::string passes_figures(const ReportFacts& facts, double goal);
// The residual of the last linear system.
std::string solver_figures(const ReportFacts& facts);
// Net power by name, bars and table, with the sums. `sizes`: area of a side [m^2], or volume of a
// medium [m^3].
struct NamedSize {
    double size = 0.0;
    bool volume = false;
};
std::string power_figures(const ReportFacts& facts, const std::map<std::string, NamedSize>& sizes);
// Temperatures, where the scene has such.
std::string temperature_table(const ReportFacts& facts);

// Area of every side, volume of every medium of an enclosure.
std::map<std::string, NamedSize> named_sizes(const radiosity::Enclosure& enclosure);

}  // namespace tyndall::view
