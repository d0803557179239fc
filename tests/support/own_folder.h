// A folder for the files of a test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace tyndall::test {

// Of this process alone, since tests run side by side; gone when it ends.
inline const std::filesystem::path& own_folder() {
    struct Folder {
        std::filesystem::path path = std::filesystem::path(TYNDALL_BINARY_DIR) /
                                     ("files_of_test_" + std::to_string(::getpid()));
        Folder() { std::filesystem::create_directories(path); }
        Folder(const Folder&) = delete;
        Folder& operator=(const Folder&) = delete;
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    };
    static const Folder folder;
    return folder.path;
}

}  // namespace tyndall::test
