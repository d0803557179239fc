// Seals: sixteen bytes at the end of a file that tell whether all before is as it was written.
//
// HDF5 looks at no byte behind what its own headers count, and its library may crash on damaged
// headers: the seal is looked at first.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tyndall::radiosity {

// Purpose: what to append to these bytes: a mark, and a 64-bit checksum of them. Any single wrong
//   byte changes it for certain, anything else but for one in 2^64.
std::string seal_of(std::string_view bytes);

enum class Seal {
    none,    // there is no mark: an older file, of another program, or cut short
    whole,   // what is before the mark is what was sealed
    broken,  // it is not
};

// Purpose: the state of a file's seal. Cost: the file is read once, a megabyte at a time.
// Errors: mesh::InputError if the file cannot be read.
Seal check_seal(const std::filesystem::path& path);

}  // namespace tyndall::radiosity
