// /tyndall/enclosure: the mesh as arrays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mesh/body.h"
#include "mesh/input_error.h"
#include "radiosity/solution_parts.h"

namespace tyndall::radiosity {
namespace {

template <class Tag, std::size_t N>
std::vector<std::uint32_t> flattened(const std::vector<std::array<mesh::Id<Tag>, N>>& rows) {
    std::vector<std::uint32_t> values;
    values.reserve(N * rows.size());
    for (const auto& row : rows)
        for (const auto id : row) values.push_back(id.value);
    return values;
}

template <class Tag, std::size_t N>
std::vector<std::array<mesh::Id<Tag>, N>> rows_of(const std::vector<std::uint32_t>& values) {
    std::vector<std::array<mesh::Id<Tag>, N>> rows(values.size() / N);
    for (std::size_t k = 0; k < N * rows.size(); ++k) rows[k / N][k % N] = mesh::Id<Tag>(values[k]);
    return rows;
}

// An array of indices below `limit`, or none where that may be.
std::vector<std::uint32_t> indices(const Hdf5Reader& file, const std::string& name,
                                   std::size_t columns, std::size_t limit, bool may_be_none) {
    auto values = file.array<std::uint32_t>(enclosure_path + "/" + name, columns);
    for (const auto value : values)
        if (value >= limit && !(may_be_none && value == none))
            file.fail(fmt::format("'{}/{}' points beyond its table ({} of {})", enclosure_path,
                                  name, value, limit));
    return values;
}

void expect_rows(const Hdf5Reader& file, const std::string& name, std::size_t rows,
                 std::size_t expected) {
    if (rows != expected)
        file.fail(
            fmt::format("'{}/{}' has {} rows instead of {}", enclosure_path, name, rows, expected));
}

void write_facets(Hdf5Writer& file, const Enclosure& e) {
    std::vector<std::array<VertexId, 3>> corners;
    std::vector<std::array<TetId, 2>> tets;
    std::vector<std::uint32_t> sources, sides;
    std::vector<std::uint8_t> opaque;
    for (std::size_t f = 0; f < e.mesh.facets.size(); ++f) {
        const auto& facet = e.mesh.facets[f];
        corners.push_back(facet.corners);
        tets.push_back(facet.tets);
        sources.push_back(facet.source.value);
        opaque.push_back(facet.opacity == mesh::Opacity::opaque);
        for (const auto side : e.facet_sides[f]) sides.push_back(side);
    }
    file.array(enclosure_path + "/facet_corners", flattened(corners), 3);
    file.array(enclosure_path + "/facet_tets", flattened(tets), 2);
    file.array(enclosure_path + "/facet_source", sources);
    file.array(enclosure_path + "/facet_opaque", opaque);
    file.array(enclosure_path + "/facet_sides", sides, 2);
    std::vector<std::uint32_t> bodies;
    for (const mesh::Body& body : e.mesh.bodies)
        bodies.insert(bodies.end(), {body.first.value, body.end.value});
    if (!bodies.empty()) file.array(enclosure_path + "/bodies", bodies, 2);
}

// Facets that stand in tets, the last ones; a scene without any has no such array.
void read_bodies(const Hdf5Reader& file, Enclosure& e) {
    if (!file.has(enclosure_path + "/bodies")) return;
    const auto ends = indices(file, "bodies", 2, e.mesh.facets.size() + 1, false);
    for (std::size_t k = 0; k < ends.size(); k += 2) {
        const std::uint32_t before = k == 0 ? ends[0] : ends[k - 1];
        if (ends[k] != before || ends[k] >= ends[k + 1])
            file.fail(fmt::format("'{}/bodies' does not ascend", enclosure_path));
        e.mesh.bodies.push_back(mesh::body_of(e.mesh, FacetId(ends[k]), FacetId(ends[k + 1])));
    }
    if (ends.empty() || ends.back() != e.mesh.facets.size())
        file.fail(fmt::format("'{}/bodies' are not the last facets", enclosure_path));
}

void read_facets(const Hdf5Reader& file, Enclosure& e) {
    const auto corners =
        rows_of<mesh::VertexTag, 3>(indices(file, "facet_corners", 3, e.mesh.points.size(), false));
    const auto tets =
        rows_of<mesh::TetTag, 2>(indices(file, "facet_tets", 2, e.mesh.tets.size(), true));
    const auto sources = file.array<std::uint32_t>(enclosure_path + "/facet_source");
    const auto opaque = file.array<std::uint8_t>(enclosure_path + "/facet_opaque");
    const auto sides = indices(file, "facet_sides", 2, e.sides.size(), true);
    expect_rows(file, "facet_tets", tets.size(), corners.size());
    expect_rows(file, "facet_source", sources.size(), corners.size());
    expect_rows(file, "facet_opaque", opaque.size(), corners.size());
    expect_rows(file, "facet_sides", sides.size() / 2, corners.size());
    for (std::size_t f = 0; f < corners.size(); ++f) {
        e.mesh.facets.push_back({corners[f], FacetId(sources[f]),
                                 opaque[f] != 0 ? mesh::Opacity::opaque : mesh::Opacity::interface,
                                 tets[f]});
        e.facet_sides.push_back({sides[2 * f], sides[2 * f + 1]});
    }
}

void read_tets(const Hdf5Reader& file, Enclosure& e) {
    const auto points = file.array<double>(enclosure_path + "/points", 3);
    if (!std::all_of(points.begin(), points.end(), [](double v) { return std::isfinite(v); }))
        file.fail("a point of the mesh is not finite");
    for (std::size_t k = 0; k < points.size(); k += 3)
        e.mesh.points.push_back({points[k], points[k + 1], points[k + 2]});
    e.mesh.tets = rows_of<mesh::VertexTag, 4>(indices(file, "tets", 4, points.size() / 3, false));
    const std::size_t count = e.mesh.tets.size();
    e.mesh.neighbours = rows_of<mesh::TetTag, 4>(indices(file, "neighbours", 4, count, true));
    expect_rows(file, "neighbours", e.mesh.neighbours.size(), count);
}

void read_regions(const Hdf5Reader& file, Enclosure& e) {
    const std::size_t count = e.mesh.tets.size();
    e.mesh.tet_facets =
        rows_of<mesh::FacetTag, 4>(indices(file, "tet_facets", 4, e.mesh.facets.size(), true));
    expect_rows(file, "tet_facets", e.mesh.tet_facets.size(), count);
    for (const auto region : indices(file, "regions", 1, e.mesh.region_count, false))
        e.mesh.regions.push_back(RegionId(region));
    expect_rows(file, "regions", e.mesh.regions.size(), count);
    e.region_medium = indices(file, "region_medium", 1, e.media.size(), true);
    expect_rows(file, "region_medium", e.region_medium.size(), e.mesh.region_count);
    const auto solid = file.array<std::uint8_t>(enclosure_path + "/region_solid");
    expect_rows(file, "region_solid", solid.size(), e.mesh.region_count);
    e.region_solid.assign(solid.begin(), solid.end());
}

}  // namespace

void write_enclosure(Hdf5Writer& file, const Enclosure& e) {
    file.group(enclosure_path);
    write_optics(file, e);
    std::vector<double> points;
    for (const Point& p : e.mesh.points) points.insert(points.end(), {p.x, p.y, p.z});
    file.array(enclosure_path + "/points", points, 3);
    file.array(enclosure_path + "/tets", flattened(e.mesh.tets), 4);
    file.array(enclosure_path + "/neighbours", flattened(e.mesh.neighbours), 4);
    file.array(enclosure_path + "/tet_facets", flattened(e.mesh.tet_facets), 4);
    std::vector<std::uint32_t> regions;
    for (const RegionId region : e.mesh.regions) regions.push_back(region.value);
    file.array(enclosure_path + "/regions", regions);
    write_facets(file, e);
    file.array(enclosure_path + "/region_medium", e.region_medium);
    file.array(enclosure_path + "/region_solid",
               std::vector<std::uint8_t>(e.region_solid.begin(), e.region_solid.end()));
}

Enclosure read_enclosure(const Hdf5Reader& file) {
    Enclosure enclosure;
    read_optics(file, enclosure);
    read_tets(file, enclosure);
    read_facets(file, enclosure);
    read_regions(file, enclosure);
    read_bodies(file, enclosure);
    return enclosure;
}

}  // namespace tyndall::radiosity
