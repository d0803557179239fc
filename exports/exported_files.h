// What an export consists of: one file, those that it names, and what is to be known of them.
#pragma once

#include <string>
#include <vector>

namespace tyndall::exports {

// A file beside the main one.
struct NamedFile {
    std::string name;  // relative to the main file's folder: "room_parts/floor.ply"
    std::string bytes;
};

struct ExportedFiles {
    std::string main;                // bytes
    std::vector<NamedFile> beside;   // that `main` names
    std::vector<std::string> notes;  // sentences: what is not the same as in the scene
};

}  // namespace tyndall::exports
