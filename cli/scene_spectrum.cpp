#include "cli/scene_spectrum.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cli/scene_keys.h"
#include "cli/toml_text.h"

namespace tyndall::cli {
namespace {

constexpr double micrometre = 1e-6;  // [m]
constexpr Range wavelengths{0.0, 1e9};
constexpr Range kelvin_of_spectrum{1.0, 1e6};

std::vector<double> read_band_edges(const TableReader& root) {
    std::vector<double> edges;
    const toml::array& values = root.array("band_edges");
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::string what = fmt::format("band_edges[{}]", k);
        const auto infinite = values[k].value_exact<double>();
        const bool last = k + 1 == values.size();
        edges.push_back(last && infinite && std::isinf(*infinite) && *infinite > 0.0
                            ? *infinite
                            : root.number_at(values[k], what, wavelengths) * micrometre);
        const std::string place = place_of(values[k].source());
        if (k > 0 && !(edges[k] > edges[k - 1]))
            fail_at(place, fmt::format("{} is not above the edge before it. Give wavelengths in "
                                       "ascending order [µm].",
                                       what));
        if (edges[k] > 0.0 && edges[k] < 0.01 * micrometre)
            fail_at(place, fmt::format("{} is {} µm, shorter than X-rays. Give micrometres, not "
                                       "metres.",
                                       what, edges[k] / micrometre));
    }
    if (edges.size() < 2)
        root.fail("band_edges",
                  fmt::format("band_edges has {} value{}. Give an edge more than there are bands: "
                              "[0, 2.5, inf] for two.",
                              edges.size(), edges.size() == 1 ? "" : "s"));
    return edges;
}

// Weights that make sense over the whole range of temperatures.
void check_weights(const TableReader& root, const radiosity::GreyGases& model) {
    constexpr int steps = 200;
    for (int k = 0; k <= steps; ++k) {
        const double t = model.lowest + (model.highest - model.lowest) * k / steps;
        for (std::size_t b = 0; b < model.bands(); ++b)
            if (const double weight = grey_gas_weight(model, b, t); !(weight >= 0.0))
                root.fail("gas", fmt::format("at {:.6g} K the weight of {} is {:.3g}. Correct the "
                                             "weights, or narrow temperatures.",
                                             t,
                                             b == 0 ? std::string("the clear gas, 1 less the sum "
                                                                  "of all others,")
                                                    : fmt::format("gas {}", b),
                                             weight));
    }
}

double pascals(const TableReader& root) {
    constexpr std::array<std::string_view, 3> names{"atm", "bar", "Pa"};
    constexpr std::array<double, 3> values{101325.0, 1e5, 1.0};
    return values[root.choice("pressure", names)];
}

std::vector<double> read_weights(const TableReader& reader) {
    std::vector<double> weights;
    for (const toml::node& value : reader.array("weights"))
        weights.push_back(reader.number_at(value, "a weight of " + reader.thing(), {}));
    if (weights.empty() || weights.size() > 16)
        reader.fail("weights", fmt::format("weights of {} has {} values. Give 1 to 16: b_0, b_1 "
                                           "[1/K], b_2 [1/K²], …",
                                           reader.thing(), weights.size()));
    return weights;
}

}  // namespace

radiosity::GreyGases read_grey_gases(const std::filesystem::path& path) {
    const toml::table table = parse_toml_file(path, "grey gases");
    const TableReader root(table, keys::grey_gases(), "the file of grey gases");
    if (root.number("format", {-1e9, 1e9}) != 1.0)
        root.fail("format", "this program reads format = 1 of files of grey gases.");
    radiosity::GreyGases model;
    model.name = path.filename().string();
    const glm::dvec2 temperatures = root.vector2("temperatures", kelvin_of_spectrum);
    if (!(temperatures.x < temperatures.y))
        root.fail("temperatures",
                  fmt::format("temperatures [{}, {}] do not ascend. Give the lowest "
                              "and the highest [K].",
                              temperatures.x, temperatures.y));
    model.lowest = temperatures.x;
    model.highest = temperatures.y;
    const double unit = pascals(root);
    for (const toml::table* gas : root.tables("gas")) {
        const TableReader reader(*gas, keys::grey_gas(),
                                 fmt::format("gas {}", model.gases.size() + 1));
        model.gases.push_back({reader.number("absorption", positive) / unit, read_weights(reader)});
    }
    if (model.gases.empty() || model.gases.size() > 63)
        fail_at(root.where(), fmt::format("the file of grey gases has {} gases. Give 1 to 63, a "
                                          "[[gas]] each; the clear gas is added to them.",
                                          model.gases.size()));
    check_weights(root, model);
    return model;
}

void read_spectrum(const TableReader& root, const std::filesystem::path& folder,
                   radiosity::Scene& scene) {
    constexpr std::array<std::string_view, 2> models{"band_edges", "grey_gases"};
    const auto model = root.at_most_one(models);
    std::size_t bands = 1;
    if (model == "band_edges") {
        scene.spectral.band_edges = read_band_edges(root);
        bands = scene.spectral.band_edges.size() - 1;
        if (bands > 64)
            root.fail("band_edges", fmt::format("band_edges makes {} bands. 64 are the most that "
                                                "can be.",
                                                bands));
    } else if (model == "grey_gases") {
        const auto path = folder / root.text("grey_gases");
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored))
            root.fail("grey_gases", fmt::format("grey_gases: there is no file '{}'. Correct the "
                                                "path; it is taken from the scene file's folder.",
                                                path.string()));
        scene.spectral.grey_gases = read_grey_gases(path);
        bands = scene.spectral.grey_gases.bands();
    }
    scene.bands = root.has("bands") ? root.count("bands", 1, 64) : bands;
    if (model && scene.bands != bands)
        root.fail("bands",
                  fmt::format("bands is {}, but {} makes {}{}. Leave bands out.", scene.bands,
                              *model, bands, model == "grey_gases" ? " with the clear gas" : ""));
}

}  // namespace tyndall::cli
