// Whole files, as mesh/file_bytes.h reads and writes them.
#pragma once

#include "mesh/file_bytes.h"

namespace tyndall::render {

using mesh::read_file;
using mesh::write_file;

}  // namespace tyndall::render
