// A file of another kind than a command wants: what it is, and which command takes it.
#pragma once

#include <filesystem>
#include <string>

namespace tyndall::cli {

enum class FileKind { missing, folder, scene, study, solution, picture, other };

// By its first bytes, not by its name. Never throws.
FileKind kind_of(const std::filesystem::path& path);

// Throws mesh::InputError if the file is plainly no scene, or no study, but something else that
// Tyndall knows, or is missing: says what it is and what to do with it; of a missing one the
// nearest name in its folder. Else the reader finds out.
void require_scene(const std::filesystem::path& path);
void require_study(const std::filesystem::path& path);
// The same for a solution; scenes, studies and pictures are told apart.
void require_solution(const std::filesystem::path& path);

}  // namespace tyndall::cli
