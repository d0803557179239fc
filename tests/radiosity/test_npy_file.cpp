// What NumPy writes is read; what is broken is refused (tests/broken has more of it).
#include "radiosity/npy_file.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "mesh/file_bytes.h"
#include "mesh/input_error.h"
#include "support/catch.h"

using namespace tyndall;
using namespace tyndall::radiosity;

namespace {

// The bytes that numpy.save writes of an array 2 × 3 × 4.
template <class T>
std::string npy(const std::vector<T>& values, const char* type, const char* order, int version) {
    std::string header = std::string("{'descr': '") + type + "', 'fortran_order': " + order +
                         ", 'shape': (2, 3, 4), }";
    header.resize(117, ' ');
    header += '\n';
    std::string bytes = "\x93NUMPY";
    bytes += char(version);
    bytes += '\0';
    bytes += char(header.size());
    bytes.append(version == 1 ? 1 : 3, '\0');
    bytes += header;
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
    return bytes;
}

RegularGrid read(const std::string& bytes) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("tyndall_npy_" + std::to_string(::getpid()) + ".npy");
    mesh::write_file(path, bytes);
    struct Remove {
        std::filesystem::path path;
        ~Remove() { std::filesystem::remove(path); }
    } remove{path};
    return read_npy_grid(path, {0, 0, 0}, {1, 2, 3});
}

template <class T>
std::vector<T> counted() {
    std::vector<T> values;
    for (int k = 0; k < 24; ++k) values.push_back(static_cast<T>(k) / 8);
    return values;
}

}  // namespace

TEST_CASE("npy: float32 and float64, C and Fortran order, versions 1 to 3") {
    // Value at point (i, j, k): the points' places are whole numbers.
    const auto at = [](const RegularGrid& grid, int i, int j, int k) {
        return 8.0 * grid.at({double(i), double(j), double(k)});
    };
    for (const int version : {1, 2, 3}) {
        for (const RegularGrid& c : {read(npy(counted<float>(), "<f4", "False", version)),
                                     read(npy(counted<double>(), "<f8", "False", version))}) {
            CHECK(c.counts() == std::array<std::size_t, 3>{2, 3, 4});
            CHECK(at(c, 1, 0, 0) == 12.0);
            CHECK(at(c, 0, 1, 0) == 4.0);
            CHECK(at(c, 0, 0, 1) == 1.0);
            CHECK(at(c, 1, 2, 3) == 23.0);
        }
        const auto f = read(npy(counted<double>(), "<f8", "True", version));
        CHECK(at(f, 1, 0, 0) == 1.0);
        CHECK(at(f, 0, 1, 0) == 2.0);
        CHECK(at(f, 0, 0, 1) == 6.0);
    }
}

TEST_CASE("npy: no prefix of a file does other than be refused") {
    const std::string whole = npy(counted<float>(), "<f4", "False", 1);
    for (std::size_t size = 0; size < whole.size(); ++size)
        CHECK_THROWS_AS(read(whole.substr(0, size)), mesh::InputError);
    CHECK_NOTHROW(read(whole));
    CHECK_THROWS_AS(read_npy_grid("no_such_file.npy", {0, 0, 0}, {1, 1, 1}), mesh::InputError);
}
