// HDF5 files: arrays and texts by their paths, whole in memory while they are written.
//
// The same content gives the same bytes: no time stamps, no random names. Big arrays are compressed
// (shuffle, gzip 1). A seal at the end (file_seal.h) shows damage before anything is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tyndall::radiosity {

class Hdf5Writer {
  public:
    Hdf5Writer();
    ~Hdf5Writer();
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    // Groups must exist before what is in them.
    void group(const std::string& path);

    // values.size() / columns rows; one dimension if `columns` is 1. T: double, float, uint8,
    // int32, uint32 or int64.
    template <class T>
    void array(const std::string& path, const std::vector<T>& values, std::size_t columns = 1);
    void text(const std::string& path, const std::string& text);
    void texts(const std::string& path, const std::vector<std::string>& texts);

    // Attributes of a group or an array.
    void attribute(const std::string& path, const std::string& name,
                   const std::vector<std::int64_t>& values);
    void attribute(const std::string& path, const std::string& name, const std::string& text);

    // The file's bytes; nothing can be written after.
    std::string finish();

  private:
    std::int64_t file_;
};

class Hdf5Reader {
  public:
    // Errors: mesh::InputError: no such file, not an HDF5 file, cut short, damaged.
    explicit Hdf5Reader(const std::filesystem::path& path);
    ~Hdf5Reader();
    Hdf5Reader(const Hdf5Reader&) = delete;
    Hdf5Reader& operator=(const Hdf5Reader&) = delete;

    // Whether the file ends with its seal: it is whole.
    bool sealed() const { return sealed_; }
    bool has(const std::string& path) const;

    // Errors of all: mesh::InputError if it is not there, of another shape, or damaged.
    template <class T>
    std::vector<T> array(const std::string& path, std::size_t columns = 1) const;
    std::string text(const std::string& path) const;
    std::int64_t attribute(const std::string& path, const std::string& name) const;

    // Throws: the file, what is wrong with it, and what to do.
    [[noreturn]] void fail(const std::string& what) const;

  private:
    std::string name_;
    double bytes_;
    bool sealed_;
    std::int64_t file_;
};

}  // namespace tyndall::radiosity
