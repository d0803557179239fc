#include "mesh/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <vector>

#include "mesh/input_error.h"

namespace tyndall::mesh {

namespace fs = std::filesystem;

namespace {

class File {
  public:
    File(const fs::path& path, int flags)
        : descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { close(); }

    bool open() const { return descriptor_ >= 0; }
    int descriptor() const { return descriptor_; }
    // A full disk or quota may only show here.
    bool close() {
        const int result = open() ? ::close(descriptor_) : 0;
        descriptor_ = -1;
        return result == 0;
    }

  private:
    int descriptor_;
};

[[noreturn]] void cannot(const char* what, const fs::path& path, const std::string& why) {
    throw InputError(fmt::format("cannot {} '{}': {}.", what, path.string(), why));
}

std::string system_reason(int error) {
    return std::strerror(error);
}

bool write_all(const File& file, std::string_view bytes) {
    while (!bytes.empty()) {
        const auto chunk = std::min<std::size_t>(bytes.size(), 1u << 30);
        const auto count = ::write(file.descriptor(), bytes.data(), chunk);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

// Some file systems cannot; those that can must not fail.
bool bring_to_disk(const File& file) {
    return ::fsync(file.descriptor()) == 0 || errno == EINVAL || errno == ENOSYS;
}

// The process that an unfinished file ".NAME.PROCESS.tmp" is of; 0 for other files.
pid_t writer_of(const std::string& name) {
    constexpr std::string_view end = ".tmp";
    if (name.size() < 2 || name.front() != '.' || !name.ends_with(end)) return 0;
    const std::string_view stem = std::string_view(name).substr(0, name.size() - end.size());
    const std::string_view digits = stem.substr(stem.rfind('.') + 1);
    pid_t process = 0;
    const auto last = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), last, process);
    return read.ec == std::errc() && read.ptr == last && process > 0 ? process : 0;
}

void check_target(const fs::path& path) {
    std::error_code ignored;
    if (path.filename().empty() || fs::is_directory(path, ignored))
        cannot("write", path, "it is a folder; give a file's name");
    const auto folder = path.parent_path();
    if (!folder.empty() && !fs::exists(folder, ignored))
        cannot("write", path,
               fmt::format("the folder '{}' does not exist; create it first", folder.string()));
}

void write_straight(const fs::path& path, std::string_view bytes) {
    File file(path, O_WRONLY);
    if (!file.open() || !write_all(file, bytes) || !file.close())
        cannot("write", path, system_reason(errno));
}

void write_and_replace(const fs::path& path, std::string_view bytes) {
    auto beside = path;
    beside.replace_filename(fmt::format(".{}.{}.tmp", path.filename().string(), ::getpid()));
    File file(beside, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file.open()) cannot("write", path, system_reason(errno));
    const bool written = write_all(file, bytes) && bring_to_disk(file) && file.close();
    if (written && ::rename(beside.c_str(), path.c_str()) == 0) return;
    const int error = errno;
    ::unlink(beside.c_str());
    cannot("write", path, system_reason(error));
}

}  // namespace

std::string read_file(const fs::path& path) {
    File file(path, O_RDONLY);
    struct stat status {};
    if (!file.open() || ::fstat(file.descriptor(), &status) != 0)
        cannot("read", path, system_reason(errno));
    if (S_ISDIR(status.st_mode)) cannot("read", path, "it is a folder; give a file's name");
    std::string bytes(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)), '\0');
    std::size_t filled = 0;
    // Read until the end rather than st_size bytes: a pipe has no size, and a file may grow.
    for (;;) {
        if (filled == bytes.size()) bytes.resize(bytes.size() + (1u << 16));
        const auto count = ::read(file.descriptor(), bytes.data() + filled, bytes.size() - filled);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) cannot("read", path, system_reason(errno));
        if (count == 0) break;
        filled += static_cast<std::size_t>(count);
    }
    bytes.resize(filled);
    return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
    check_target(path);
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_straight(path, bytes);
    // A link stays a link: what it points to is replaced.
    const auto real = fs::exists(status) ? fs::canonical(path, error) : path;
    write_and_replace(error ? path : real, bytes);
}

void remove_unfinished(const fs::path& folder) {
    std::vector<fs::path> dead;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const pid_t writer = writer_of(entry.path().filename().string());
        if (writer > 0 && ::kill(writer, 0) != 0 && errno == ESRCH) dead.push_back(entry.path());
    }
    for (const auto& path : dead) fs::remove(path, ignored);
}

}  // namespace tyndall::mesh
