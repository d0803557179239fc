// The parts that a solution file is made of.
#pragma once

#include <string>

#include "radiosity/hdf5_file.h"
#include "radiosity/solution.h"

namespace tyndall::radiosity {

// /VTKHDF: for viewers; nothing of it is read again.
void write_grid(Hdf5Writer& file, const Solution& solution);

// /tyndall/enclosure: mesh, optics, lights.
inline const std::string enclosure_path = "/tyndall/enclosure";
void write_enclosure(Hdf5Writer& file, const Enclosure& enclosure);
Enclosure read_enclosure(const Hdf5Reader& file);

// Of it, all but the mesh.
void write_optics(Hdf5Writer& file, const Enclosure& enclosure);
void read_optics(const Hdf5Reader& file, Enclosure& enclosure);

// /tyndall/forest: bisections, in order.
void write_forest(Hdf5Writer& file, const Forest& forest);
Forest read_forest(const Hdf5Reader& file, const mesh::BaseMesh& base);

}  // namespace tyndall::radiosity
