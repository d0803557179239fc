// Whole files, read and written at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tyndall::mesh {

// Purpose: all bytes of a file.
// Errors: InputError: no such file, a folder, no permission, a read that fails.
std::string read_file(const std::filesystem::path& path);

// Purpose: a file with these bytes. They are written beside it as ".NAME.PROCESS.tmp", and on the
//   disk before that takes the file's place, so that no reader ever sees half a file, not after a
//   power cut either, and a failure leaves an old file as it was. What is not a regular file (a
//   pipe, /dev/stdout) is written straight.
// Errors: InputError: no such folder, no permission, a full disk.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Purpose: removes from a folder what write_file of a process that was killed has left there. Files
//   of processes that live stay.
void remove_unfinished(const std::filesystem::path& folder);

}  // namespace tyndall::mesh
