#include "radiosity/exchange_hemicube.h"

#include "radiosity/cube_rows.h"

namespace tyndall::radiosity {

void exchange_hemicube(const Discretization& discretization, std::span<const ElementId> rows,
                       const ExchangeOptions& options, const RowSink& sink) {
    require_patches(discretization, rows, "hemicube",
                    "a point of a medium sees light from all around. Choose \"full_cube\", which "
                    "uses hemi-cubes on surfaces and full cubes in media, or \"walked\".");
    rows_by_cubes(discretization, rows, options, sink,
                  {hemicube_faces(options.settings.resolution), {}});
}

}  // namespace tyndall::radiosity
