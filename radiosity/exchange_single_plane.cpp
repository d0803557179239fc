#include "radiosity/exchange_single_plane.h"

#include "radiosity/cube_rows.h"

namespace tyndall::radiosity {

void exchange_single_plane(const Discretization& discretization, std::span<const ElementId> rows,
                           const ExchangeOptions& options, const RowSink& sink) {
    require_patches(discretization, rows, "single_plane",
                    "a single plane leaves out grazing directions, which a surface's cosine makes "
                    "small and a medium's point does not. Choose \"full_cube\" or \"walked\".");
    rows_by_cubes(discretization, rows, options, sink,
                  {single_plane_faces(options.settings.resolution), {}});
}

}  // namespace tyndall::radiosity
