// Reference figures of tests/reference, computed for this project (docs/validation).
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace tyndall::test {

inline nlohmann::json reference(const std::string& name) {
    return nlohmann::json::parse(
        std::ifstream(std::string(TYNDALL_SOURCE_DIR) + "/tests/reference/" + name + ".json"));
}

// The case of that name.
inline nlohmann::json reference_case(const nlohmann::json& file, const std::string& name) {
    for (const auto& c : file["cases"])
        if (c["name"] == name) return c;
    throw std::runtime_error("no reference case " + name);
}

inline double reference_value(const nlohmann::json& file, const std::string& name) {
    return reference_case(file, name)["value"];
}

}  // namespace tyndall::test
