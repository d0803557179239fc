#include "cli/scene_extinction.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/expression.h"
#include "cli/scene_keys.h"
#include "mesh/input_error.h"
#include "radiosity/npy_file.h"

namespace tyndall::cli {
namespace {

radiosity::ExtinctionShape expression_at(const TableReader& medium, const toml::node& node) {
    const std::string place = place_of(node.source());
    try {
        return {compile_expression(**node.as_string()), place};
    } catch (const mesh::InputError& error) {
        fail_at(place, fmt::format("extinction of {}: {}", medium.thing(), error.what()));
    }
}

// An array with a text in it: an expression or a number a band.
void read_array(const TableReader& medium, const toml::array& values, std::size_t bands,
                radiosity::Medium& result) {
    if (values.size() != bands)
        medium.fail(
            "extinction",
            fmt::format("extinction of {} has {} value{} for {} band{}. Give one expression "
                        "for all bands, or one a band.",
                        medium.thing(), values.size(), values.size() == 1 ? "" : "s", bands,
                        bands == 1 ? "" : "s"));
    const std::string what = fmt::format("extinction of {}", medium.thing());
    for (const toml::node& value : values) {
        if (value.is_string()) {
            result.shape.push_back(expression_at(medium, value));
        } else {
            const double number = medium.number_at(value, what, quantity);
            result.shape.push_back(
                {[number](radiosity::Point) { return number; }, place_of(value.source())});
        }
    }
}

void read_grid(const TableReader& medium, const std::filesystem::path& folder, std::size_t bands,
               radiosity::Medium& result) {
    const TableReader grid = medium.table("extinction", keys::extinction());
    const std::string name = grid.text("file");
    const auto low = grid.vector("min", coordinate), high = grid.vector("max", coordinate);
    for (int axis = 0; axis < 3; ++axis)
        if (!(low[axis] < high[axis]))
            grid.fail("max",
                      fmt::format("max {} of {} along {} is not above min {}. Give the grid's "
                                  "lowest and highest corner.",
                                  high[axis], grid.thing(), "xyz"[axis], low[axis]));
    if (grid.has("scale")) result.extinction = grid.spectrum("scale", bands, quantity);
    try {
        result.shape.push_back({std::make_shared<const radiosity::RegularGrid>(
                                    radiosity::read_npy_grid(folder / name, low, high)),
                                grid.where("file")});
    } catch (const mesh::InputError& error) {
        grid.fail("file", fmt::format("file of {}: {}", grid.thing(), error.what()));
    }
}

}  // namespace

void read_extinction(const TableReader& medium, const std::filesystem::path& folder,
                     std::size_t bands, radiosity::Medium& result) {
    const toml::node& node = medium.node("extinction");
    result.extinction.assign(bands, 1.0);
    if (node.is_string()) {
        result.shape.push_back(expression_at(medium, node));
    } else if (node.is_table()) {
        read_grid(medium, folder, bands, result);
    } else if (const toml::array* values = node.as_array();
               values && std::any_of(values->begin(), values->end(),
                                     [](const toml::node& value) { return value.is_string(); })) {
        read_array(medium, *values, bands, result);
    } else {
        result.extinction = medium.spectrum("extinction", bands, quantity);
    }
}

}  // namespace tyndall::cli
