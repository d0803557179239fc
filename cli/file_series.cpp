#include "cli/file_series.h"

#include <nlohmann/json.hpp>

namespace tyndall::cli {

std::string file_series(const std::vector<std::pair<std::string, double>>& files) {
    nlohmann::ordered_json json{{"file-series-version", "1.0"},
                                {"files", nlohmann::ordered_json::array()}};
    for (const auto& [name, time] : files)
        json["files"].push_back({{"name", name}, {"time", time}});
    return json.dump(2) + "\n";
}

}  // namespace tyndall::cli
