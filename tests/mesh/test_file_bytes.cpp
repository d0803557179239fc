// Files are written whole; what killed writers leave is found and removed.
#include "mesh/file_bytes.h"

#include <unistd.h>

#include <filesystem>

#include "support/catch.h"

using namespace tyndall;
namespace fs = std::filesystem;

TEST_CASE("Unfinished files of dead processes are removed, all others stay") {
    const fs::path folder =
        fs::temp_directory_path() / ("tyndall_bytes_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const std::string own = ".b.exr." + std::to_string(::getpid()) + ".tmp";
    // No process has a number that large: Linux ends at 2^22.
    const std::string dead = ".a.vtkhdf.999999999.tmp";
    const std::string kept[] = {own,          "c.tmp", ".d.x.tmp", ".999999999", "a.999999999.tmp",
                                ".e.-12.tmp", ".tmp",  ".f..tmp",  "a.vtkhdf"};
    mesh::write_file(folder / dead, "half");
    for (const auto& name : kept) mesh::write_file(folder / name, "whole");
    mesh::remove_unfinished(folder);
    CHECK(!fs::exists(folder / dead));
    for (const auto& name : kept) {
        CAPTURE(name);
        CHECK(fs::exists(folder / name));
    }
    mesh::remove_unfinished(folder / "none");  // no folder, nothing to do
    fs::remove_all(folder);
}
