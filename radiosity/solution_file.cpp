#include "radiosity/solution_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "radiosity/leaves_in_order.h"
#include "radiosity/report_json.h"
#include "radiosity/solution_parts.h"

namespace tyndall::radiosity {
namespace {

const std::string root = "/tyndall";
constexpr std::uint32_t patch_bit = 0x80000000u;  // Forest::Bisection::node

// Of the leaves' numbers, in the order that the arrays rely on: a program that numbers them in
// another way must not take one leaf's values for another's.
std::int64_t leaf_order(const Elements& elements) {
    std::uint64_t hash = 0;
    const auto add = [&](std::uint64_t value) {
        hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    };
    for (const PatchId patch : elements.patches) add(patch.value);
    for (const ZoneId zone : elements.zones) add(std::uint64_t(zone.value) + (1ull << 32));
    return static_cast<std::int64_t>(hash);
}

// Gradient and constant of the elements' functions, an element after the other, bands within.
std::vector<double> field_values(const Fields& fields, const Elements& elements) {
    std::vector<double> values;
    values.reserve(4 * elements.size() * fields.bands);
    const auto add = [&](auto node) {
        for (std::size_t b = 0; b < fields.bands; ++b) {
            const Affine& f = fields.at(node, b);
            values.insert(values.end(), {f.gradient.x, f.gradient.y, f.gradient.z, f.constant});
        }
    };
    for (const PatchId patch : elements.patches) add(patch);
    for (const ZoneId zone : elements.zones) add(zone);
    return values;
}

void expect_size(const Hdf5Reader& file, const std::string& path, std::size_t size,
                 std::size_t expected) {
    if (size != expected)
        file.fail(fmt::format("'{}' has {} values instead of {}", path, size, expected));
}

Fields read_fields(const Hdf5Reader& file, const std::string& path, const Forest& forest,
                   const Elements& elements) {
    const auto values = file.array<double>(path, 4);
    expect_size(file, path, values.size(), 4 * elements.size() * elements.bands);
    Fields fields;
    fields.resize(forest, elements.bands);
    std::size_t k = 0;
    const auto take = [&](auto node) {
        for (std::size_t b = 0; b < fields.bands; ++b, k += 4)
            fields.at(node, b) = {{values[k], values[k + 1], values[k + 2]}, values[k + 3]};
    };
    for (const PatchId patch : elements.patches) take(patch);
    for (const ZoneId zone : elements.zones) take(zone);
    return fields;
}

// H of bends, where there are any, in the same order; the rest of them follows from the mesh.
template <class Node>
void write_bends(Hdf5Writer& file, const std::string& path, const std::vector<Bend>& bends,
                 const std::vector<Node>& nodes, std::size_t bands) {
    if (bends.empty()) return;
    std::vector<double> values;
    for (const Node node : nodes)
        for (std::size_t b = 0; b < bands; ++b) {
            const auto& second = bends[node.value * bands + b].second;
            values.insert(values.end(), second.begin(), second.end());
        }
    file.array(path, values, 6);
}

template <class Node>
std::vector<Bend> read_bends(const Hdf5Reader& file, const std::string& path, const Forest& forest,
                             std::size_t count, const std::vector<Node>& nodes, std::size_t bands) {
    if (!file.has(path)) return {};
    const auto values = file.array<double>(path, 6);
    expect_size(file, path, values.size(), 6 * nodes.size() * bands);
    std::vector<Bend> bends(count * bands);
    const double* next = values.data();
    for (const Node node : nodes) {
        const auto& ids = forest[node].corners;
        std::array<Point, std::tuple_size_v<std::remove_cvref_t<decltype(ids)>>> corners;
        for (std::size_t k = 0; k < corners.size(); ++k) corners[k] = forest.point(ids[k]);
        for (std::size_t b = 0; b < bands; ++b, next += 6) {
            std::array<double, 6> second;
            std::copy(next, next + 6, second.begin());
            bends[node.value * bands + b] = bend_with(second, corners);
        }
    }
    return bends;
}

void write_errors(Hdf5Writer& file, const Solution& s, const Elements& elements) {
    std::vector<float> errors;
    for (const PatchId patch : elements.patches) errors.push_back(s.patch_error[patch.value]);
    for (const ZoneId zone : elements.zones) errors.push_back(s.zone_error[zone.value]);
    file.array(root + "/error", errors);
    errors.clear();
    for (const PatchId patch : elements.patches)
        errors.push_back(s.patch_direct_error[patch.value]);
    file.array(root + "/patch_direct_error", errors);
}

void read_errors(const Hdf5Reader& file, const Elements& elements, Solution& s) {
    const auto errors = file.array<float>(root + "/error");
    expect_size(file, root + "/error", errors.size(), elements.size());
    s.patch_error.resize(s.forest.patch_count());
    s.zone_error.resize(s.forest.zone_count());
    std::size_t k = 0;
    for (const PatchId patch : elements.patches) s.patch_error[patch.value] = errors[k++];
    for (const ZoneId zone : elements.zones) s.zone_error[zone.value] = errors[k++];
    const std::string path = root + "/patch_direct_error";
    // Files of earlier versions do not have it: the whole error is no less.
    s.patch_direct_error = s.patch_error;
    if (!file.has(path)) return;
    const auto direct = file.array<float>(path);
    expect_size(file, path, direct.size(), elements.patches.size());
    for (k = 0; k < direct.size(); ++k) s.patch_direct_error[elements.patches[k].value] = direct[k];
}

// Emission that was found with the solution, of the leaves in their order.
void write_settled(Hdf5Writer& file, const Solution& s, const Elements& elements) {
    if (s.settled.zone.empty() && s.settled.patch.empty()) return;
    std::vector<double> values;
    for (const PatchId patch : elements.patches)
        for (std::size_t b = 0; b < elements.bands; ++b) values.push_back(emission_of(s, patch, b));
    for (const ZoneId zone : elements.zones)
        for (std::size_t b = 0; b < elements.bands; ++b) values.push_back(emission_of(s, zone, b));
    file.array(root + "/settled_emission", values);
}

void read_settled(const Hdf5Reader& file, const Elements& elements, Solution& s) {
    const std::string path = root + "/settled_emission";
    if (!file.has(path)) return;
    const auto values = file.array<double>(path);
    expect_size(file, path, values.size(), elements.size() * elements.bands);
    s.settled.patch.resize(s.forest.patch_count() * elements.bands);
    s.settled.zone.resize(s.forest.zone_count() * elements.bands);
    std::size_t k = 0;
    for (const PatchId patch : elements.patches)
        for (std::size_t b = 0; b < elements.bands; ++b)
            s.settled.patch[patch.value * elements.bands + b] = values[k++];
    for (const ZoneId zone : elements.zones)
        for (std::size_t b = 0; b < elements.bands; ++b)
            s.settled.zone[zone.value * elements.bands + b] = values[k++];
}

void write_coarse(Hdf5Writer& file, const ElementValues& coarse) {
    const std::string folder = root + "/coarse";
    file.group(folder);
    std::vector<std::uint32_t> patches, zones;
    for (const PatchId patch : coarse.elements.patches) patches.push_back(patch.value);
    for (const ZoneId zone : coarse.elements.zones) zones.push_back(zone.value);
    file.array(folder + "/patches", patches);
    file.array(folder + "/zones", zones);
    file.array(folder + "/of_patch", coarse.elements.of_patch);
    file.array(folder + "/of_zone", coarse.elements.of_zone);
    if (!coarse.elements.member_starts.empty()) {
        const auto& starts = coarse.elements.member_starts;
        file.array(folder + "/member_starts",
                   std::vector<std::uint32_t>(starts.begin(), starts.end()));
        file.array(folder + "/members", coarse.elements.members);
        file.array(folder + "/member_ends", coarse.elements.member_ends);
    }
    file.array(folder + "/capacity", coarse.elements.capacity);
    file.array(folder + "/scatter", coarse.elements.scatter);
    file.array(folder + "/emission", coarse.elements.emission);
    file.array(folder + "/radiance", coarse.radiance);
    file.array(folder + "/incident", coarse.incident);
    file.array(folder + "/incident_direct", coarse.incident_direct);
}

// Indices below their limit, or none.
std::vector<std::uint32_t> read_indices(const Hdf5Reader& file, const std::string& path,
                                        std::size_t limit, bool may_be_none) {
    auto values = file.array<std::uint32_t>(path);
    for (const auto value : values)
        if (value >= limit && !(may_be_none && value == none))
            file.fail(fmt::format("'{}' points beyond its table", path));
    return values;
}

// Of elements that are clusters.
void read_members(const Hdf5Reader& file, const std::string& folder, const Forest& forest,
                  Elements& e) {
    e.members = read_indices(file, folder + "/members",
                             std::max(forest.patch_count(), forest.zone_count()), false);
    const auto starts = read_indices(file, folder + "/member_starts", e.members.size() + 1, false);
    expect_size(file, folder + "/member_starts", starts.size(), e.size() + 1);
    e.member_starts.assign(starts.begin(), starts.end());
    if (starts.front() != 0 || starts.back() != e.members.size() ||
        std::adjacent_find(starts.begin(), starts.end(), std::greater_equal<>()) != starts.end())
        file.fail(fmt::format("'{}/member_starts' does not ascend", folder));
    for (std::size_t k = 0; k < e.members.size(); ++k)
        if (e.members[k] >=
            (k < starts[e.patches.size()] ? forest.patch_count() : forest.zone_count()))
            file.fail(fmt::format("'{}/members' points beyond its table", folder));
    e.member_ends = file.array<double>(folder + "/member_ends");
    expect_size(file, folder + "/member_ends", e.member_ends.size(), e.members.size());
}

ElementValues read_coarse(const Hdf5Reader& file, const Forest& forest, std::size_t bands) {
    const std::string folder = root + "/coarse";
    ElementValues coarse;
    Elements& e = coarse.elements;
    e.bands = bands;
    for (const auto patch : read_indices(file, folder + "/patches", forest.patch_count(), false))
        e.patches.push_back(PatchId(patch));
    for (const auto zone : read_indices(file, folder + "/zones", forest.zone_count(), false))
        e.zones.push_back(ZoneId(zone));
    e.of_patch = read_indices(file, folder + "/of_patch", e.size(), true);
    e.of_zone = read_indices(file, folder + "/of_zone", e.size(), true);
    if (file.has(folder + "/members")) read_members(file, folder, forest, e);
    const auto read = [&](const std::string& name, std::vector<double>& values) {
        values = file.array<double>(folder + "/" + name);
        expect_size(file, folder + "/" + name, values.size(), e.size() * bands);
    };
    read("capacity", e.capacity);
    read("scatter", e.scatter);
    read("emission", e.emission);
    read("radiance", coarse.radiance);
    read("incident", coarse.incident);
    read("incident_direct", coarse.incident_direct);
    return coarse;
}

// A bisection of the file, carried out if the forest allows it.
template <class NodeIndex>
bool bisect(Forest& forest, std::size_t count, int corners, NodeIndex node,
            const Forest::Bisection& step) {
    if (node.value >= count || !forest.is_leaf(node) || step.i >= corners || step.j >= corners ||
        step.i == step.j || !(step.t > 0.0 && step.t < 1.0))
        return false;
    forest.bisect(node, step.i, step.j, step.t);
    return true;
}

}  // namespace

void write_forest(Hdf5Writer& file, const Forest& forest) {
    const std::string folder = root + "/forest";
    file.group(folder);
    std::vector<std::uint32_t> ends, nodes;
    std::vector<double> places, split_at;
    for (const auto& edge : forest.vertex_edges()) {
        ends.insert(ends.end(), {edge.a.value, edge.b.value});
        places.push_back(edge.t);
    }
    std::vector<std::uint8_t> corners;
    for (const auto& step : forest.history()) {
        nodes.push_back(step.node);
        corners.insert(corners.end(), {step.i, step.j});
        split_at.push_back(step.t);
    }
    file.array(folder + "/vertex_edge", ends, 2);
    file.array(folder + "/vertex_place", places);
    file.array(folder + "/node", nodes);
    file.array(folder + "/corners", corners, 2);
    file.array(folder + "/split_at", split_at);
}

Forest read_forest(const Hdf5Reader& file, const mesh::BaseMesh& base) {
    const std::string folder = root + "/forest";
    const auto ends = file.array<std::uint32_t>(folder + "/vertex_edge", 2);
    const auto places = file.array<double>(folder + "/vertex_place");
    expect_size(file, folder + "/vertex_place", places.size(), ends.size() / 2);
    Forest forest(base);
    for (std::size_t v = 0; v < places.size(); ++v) {
        const VertexId a(ends[2 * v]), b(ends[2 * v + 1]);
        const std::size_t count = forest.vertex_count();
        if (!(a < b) || b.value >= count || !(places[v] > 0.0 && places[v] < 1.0) ||
            forest.vertex_on_edge(a, b, places[v]).value != count)
            file.fail(fmt::format("vertex {} of '{}' cannot be", v, folder));
    }
    const std::size_t vertices = forest.vertex_count();
    const auto nodes = file.array<std::uint32_t>(folder + "/node");
    const auto corners = file.array<std::uint8_t>(folder + "/corners", 2);
    const auto split_at = file.array<double>(folder + "/split_at");
    expect_size(file, folder + "/corners", corners.size(), 2 * nodes.size());
    expect_size(file, folder + "/split_at", split_at.size(), nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const Forest::Bisection step{nodes[k], corners[2 * k], corners[2 * k + 1], split_at[k]};
        const bool done =
            (step.node & patch_bit) != 0
                ? bisect(forest, forest.patch_count(), 3, PatchId(step.node & ~patch_bit), step)
                : bisect(forest, forest.zone_count(), 4, ZoneId(step.node), step);
        if (!done || forest.vertex_count() != vertices)
            file.fail(fmt::format("bisection {} of '{}' cannot be", k, folder));
    }
    return forest;
}

void write_solution(const std::filesystem::path& path, const Solution& solution,
                    const std::string& attachments) {
    const Enclosure& enclosure = *solution.enclosure;
    const Elements elements = leaves_in_order(enclosure, solution.forest);
    Hdf5Writer file;
    write_grid(file, solution);
    file.group(root);
    file.attribute(
        root, "format",
        std::vector<std::int64_t>{is_quadratic(solution) ? solution_format : linear_format});
    file.attribute(root, "leaf_order", std::vector<std::int64_t>{leaf_order(elements)});
    write_enclosure(file, enclosure);
    write_forest(file, solution.forest);
    file.array(root + "/direct", field_values(solution.direct, elements), 4);
    file.array(root + "/indirect", field_values(solution.indirect, elements), 4);
    write_bends(file, root + "/direct_bend", solution.direct.zone_bend, elements.zones,
                elements.bands);
    write_bends(file, root + "/indirect_bend", solution.indirect.patch_bend, elements.patches,
                elements.bands);
    write_settled(file, solution, elements);
    write_errors(file, solution, elements);
    write_coarse(file, solution.coarse);
    file.array(root + "/direct_in_rows",
               std::vector<std::uint8_t>{solution.direct_light == DirectLightMode::rows});
    file.text(root + "/report", report_to_json(solution.report, Costs::left_out));
    file.text(root + "/attachments", attachments);
    mesh::write_file(path, file.finish());
}

SolutionFile read_solution(const std::filesystem::path& path) {
    const Hdf5Reader file(path);
    if (!file.has(root)) file.fail("it holds no Tyndall solution; another program wrote it");
    const auto format = file.attribute(root, "format");
    if (format != solution_format && format != linear_format)
        file.fail(fmt::format("its format is {}, and this program reads format {} or {}", format,
                              solution_format, linear_format));
    if (!file.sealed()) file.fail("it is cut short: its last bytes are missing");
    SolutionFile result;
    Solution& s = result.solution;
    s.enclosure = std::make_shared<const Enclosure>(read_enclosure(file));
    s.forest = read_forest(file, s.enclosure->mesh);
    const Elements elements = leaves_in_order(*s.enclosure, s.forest);
    if (file.attribute(root, "leaf_order") != leaf_order(elements))
        file.fail("another version of this program, which numbers leaves in another way, wrote it");
    static_cast<Fields&>(s.direct) = read_fields(file, root + "/direct", s.forest, elements);
    static_cast<Fields&>(s.indirect) = read_fields(file, root + "/indirect", s.forest, elements);
    s.direct.zone_bend = read_bends(file, root + "/direct_bend", s.forest, s.forest.zone_count(),
                                    elements.zones, elements.bands);
    s.indirect.patch_bend = read_bends(file, root + "/indirect_bend", s.forest,
                                       s.forest.patch_count(), elements.patches, elements.bands);
    read_settled(file, elements, s);
    read_errors(file, elements, s);
    s.coarse = read_coarse(file, s.forest, s.enclosure->bands);
    const auto rows = file.array<std::uint8_t>(root + "/direct_in_rows");
    expect_size(file, root + "/direct_in_rows", rows.size(), 1);
    s.direct_light = rows[0] != 0 ? DirectLightMode::rows : DirectLightMode::closed_form;
    try {
        s.report = report_from_json(file.text(root + "/report"));
    } catch (const mesh::InputError& error) {
        file.fail(fmt::format("'{}/report': {}", root, error.what()));
    }
    result.attachments = file.text(root + "/attachments");
    return result;
}

}  // namespace tyndall::radiosity
