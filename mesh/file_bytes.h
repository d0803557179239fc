// Whole files, read and written at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tyndall::mesh {

// Purpose: all bytes of a file.
// Errors: InputError: no such file, a folder, no permission, a read that fails.
std::string read_file(const std::filesystem::path& path);

// Purpose: a file with these bytes. They are written beside it under another name which then takes
//   its place, so that no reader ever sees half a file, and a failure leaves an old file as it was.
//   What is not a regular file (a pipe, /dev/stdout) is written straight.
// Errors: InputError: no such folder, no permission, a full disk.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace tyndall::mesh
