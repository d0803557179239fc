// The elements as VTKHDF, version 1.0:
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include "radiosity/element_grid.h"
#include "radiosity/solution_parts.h"

namespace tyndall::radiosity {

void write_grid(Hdf5Writer& file, const Solution& solution) {
    const ElementGrid grid = element_grid(solution);
    file.group("/VTKHDF");
    file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
    const auto count = [&](const std::string& name, std::size_t number) {
        file.array("/VTKHDF/" + name, std::vector{static_cast<std::int64_t>(number)});
    };
    count("NumberOfPoints", grid.point_count());
    count("NumberOfCells", grid.cell_count());
    count("NumberOfConnectivityIds", grid.connectivity.size());
    file.array("/VTKHDF/Points", grid.points, 3);
    file.array("/VTKHDF/Connectivity", grid.connectivity);
    file.array("/VTKHDF/Offsets", grid.offsets);
    file.array("/VTKHDF/Types", grid.types);
    file.group("/VTKHDF/PointData");
    file.array("/VTKHDF/PointData/radiance", grid.radiance, grid.bands);
    const std::string folder = "/VTKHDF/CellData";
    file.group(folder);
    for (const CellColumn& column : grid.cells)
        std::visit(
            [&](const auto& values) {
                file.array(folder + "/" + column.name, values, column.components);
            },
            column.values);
    file.group("/VTKHDF/FieldData");
    if (!grid.names.empty()) file.texts("/VTKHDF/FieldData/names", grid.names);
}

}  // namespace tyndall::radiosity
