#include "radiosity/exchange_full_cube.h"

#include "radiosity/cube_rows.h"

namespace tyndall::radiosity {

void exchange_full_cube(const Discretization& discretization, std::span<const ElementId> rows,
                        const ExchangeOptions& options, const RowSink& sink) {
    rows_by_cubes(discretization, rows, options, sink,
                  {hemicube_faces(options.settings.resolution),
                   full_cube_faces(options.settings.resolution)});
}

}  // namespace tyndall::radiosity
