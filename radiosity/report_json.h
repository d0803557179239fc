// Reports as JSON, for report.json and solution files.
#pragma once

#include <string>

#include "radiosity/solution.h"

namespace tyndall::radiosity {

// What a computation cost differs from run to run; the rest of a report does not.
enum class Costs { kept, left_out };

// Purpose: a report as a JSON object with the keys of docs/guide/04-outputs.md. A net power is a
//   number with one band, otherwise an array. Without costs: no seconds, no bytes.
std::string report_to_json(const Report& report, Costs costs);

// Purpose: its key `smoothing` alone.
std::string smoothing_to_json(const SmoothingReport& smoothing);

// Purpose: the report again; costs that were left out are 0.
// Errors: mesh::InputError where it is no such object.
Report report_from_json(const std::string& text);

}  // namespace tyndall::radiosity
