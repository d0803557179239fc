#include "radiosity/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>

#include "mesh/input_error.h"
#include "radiosity/file_seal.h"

namespace tyndall::radiosity {
namespace {

constexpr std::size_t compressed_from = 1024;  // elements; smaller arrays stay as they are
constexpr hsize_t chunk_elements = 1u << 17;   // about 1 MB, what HDF5's cache holds
constexpr std::size_t memory_step = 4u << 20;  // by which the file in memory grows [byte]
constexpr double most_compression = 1100.0;    // deflate reaches 1032

// An HDF5 identifier that is closed by the function it is given.
class Id {
  public:
    Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Id() {
        if (id_ >= 0) close_(id_);
    }
    Id(const Id&) = delete;
    Id& operator=(const Id&) = delete;
    operator hid_t() const { return id_; }
    bool valid() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

// HDF5 prints its errors unless told not to.
void be_silent() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void expect(bool good, const std::string& path) {
    if (!good) throw std::runtime_error(fmt::format("HDF5 could not write '{}'.", path));
}

template <class T>
struct Types;
template <>
struct Types<double> {
    static hid_t memory() { return H5T_NATIVE_DOUBLE; }
    static hid_t file() { return H5T_IEEE_F64LE; }
};
template <>
struct Types<float> {
    static hid_t memory() { return H5T_NATIVE_FLOAT; }
    static hid_t file() { return H5T_IEEE_F32LE; }
};
template <>
struct Types<std::uint8_t> {
    static hid_t memory() { return H5T_NATIVE_UINT8; }
    static hid_t file() { return H5T_STD_U8LE; }
};
template <>
struct Types<std::int32_t> {
    static hid_t memory() { return H5T_NATIVE_INT32; }
    static hid_t file() { return H5T_STD_I32LE; }
};
template <>
struct Types<std::uint32_t> {
    static hid_t memory() { return H5T_NATIVE_UINT32; }
    static hid_t file() { return H5T_STD_U32LE; }
};
template <>
struct Types<std::int64_t> {
    static hid_t memory() { return H5T_NATIVE_INT64; }
    static hid_t file() { return H5T_STD_I64LE; }
};

herr_t close_space(hid_t id) {
    return H5Sclose(id);
}

hid_t fixed_text_type(std::size_t size) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, std::max<std::size_t>(size, 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
}

}  // namespace

Hdf5Writer::Hdf5Writer() {
    be_silent();
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_core(access, memory_step, false);
    const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    file_ = H5Fcreate("in memory", H5F_ACC_TRUNC, creation, access);
    expect(file_ >= 0, "a file in memory");
}

Hdf5Writer::~Hdf5Writer() {
    if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::group(const std::string& path) {
    const Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    const Id group(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
    expect(group.valid(), path);
}

template <class T>
void Hdf5Writer::array(const std::string& path, const std::vector<T>& values, std::size_t columns) {
    if (columns == 0 || values.size() % columns != 0)
        throw std::logic_error(fmt::format("'{}' is no table of {} columns.", path, columns));
    const hsize_t dims[2] = {values.size() / columns, columns};
    const int rank = columns == 1 ? 1 : 2;
    const Id space(H5Screate_simple(rank, dims, nullptr), close_space);
    const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    if (values.size() >= compressed_from) {
        const hsize_t rows = std::max<hsize_t>(1, chunk_elements / columns);
        const hsize_t chunk[2] = {std::min<hsize_t>(dims[0], rows), columns};
        H5Pset_chunk(creation, rank, chunk);
        H5Pset_shuffle(creation);
        H5Pset_deflate(creation, 1);
        H5Pset_fletcher32(creation);
    }
    const Id set(H5Dcreate2(file_, path.c_str(), Types<T>::file(), space, H5P_DEFAULT, creation,
                            H5P_DEFAULT),
                 H5Dclose);
    expect(set.valid() &&
               H5Dwrite(set, Types<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
           path);
}

template void Hdf5Writer::array(const std::string&, const std::vector<double>&, std::size_t);
template void Hdf5Writer::array(const std::string&, const std::vector<float>&, std::size_t);
template void Hdf5Writer::array(const std::string&, const std::vector<std::uint8_t>&, std::size_t);
template void Hdf5Writer::array(const std::string&, const std::vector<std::int32_t>&, std::size_t);
template void Hdf5Writer::array(const std::string&, const std::vector<std::uint32_t>&, std::size_t);
template void Hdf5Writer::array(const std::string&, const std::vector<std::int64_t>&, std::size_t);

void Hdf5Writer::text(const std::string& path, const std::string& text) {
    const Id type(fixed_text_type(text.size()), H5Tclose);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const Id space(H5Screate(H5S_SCALAR), close_space);
    const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    const Id set(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                 H5Dclose);
    expect(set.valid() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0,
           path);
}

void Hdf5Writer::texts(const std::string& path, const std::vector<std::string>& texts) {
    // Of variable length: the kind that VTK's reader knows.
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    std::vector<const char*> pointers;
    for (const auto& text : texts) pointers.push_back(text.c_str());
    const hsize_t count = texts.size();
    const Id space(H5Screate_simple(1, &count, nullptr), close_space);
    const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation, false);
    const Id set(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                 H5Dclose);
    expect(set.valid() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) >= 0,
           path);
}

void Hdf5Writer::attribute(const std::string& path, const std::string& name,
                           const std::vector<std::int64_t>& values) {
    const hsize_t count = values.size();
    const Id space(H5Screate_simple(1, &count, nullptr), close_space);
    const Id attribute(H5Acreate_by_name(file_, path.c_str(), name.c_str(), H5T_STD_I64LE, space,
                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
    expect(attribute.valid() && H5Awrite(attribute, H5T_NATIVE_INT64, values.data()) >= 0, name);
}

void Hdf5Writer::attribute(const std::string& path, const std::string& name,
                           const std::string& text) {
    const Id type(fixed_text_type(text.size()), H5Tclose);
    const Id space(H5Screate(H5S_SCALAR), close_space);
    const Id attribute(H5Acreate_by_name(file_, path.c_str(), name.c_str(), type, space,
                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
    expect(attribute.valid() && H5Awrite(attribute, type, text.c_str()) >= 0, name);
}

std::string Hdf5Writer::finish() {
    expect(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "the file");
    const auto size = H5Fget_file_image(file_, nullptr, 0);
    expect(size > 0, "the file");
    std::string bytes(static_cast<std::size_t>(size), '\0');
    expect(H5Fget_file_image(file_, bytes.data(), bytes.size()) == size, "the file");
    H5Fclose(file_);
    file_ = -1;
    bytes += seal_of(bytes);
    return bytes;
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path)
    : name_(path.string()), bytes_(0.0), sealed_(false), file_(-1) {
    be_silent();
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw mesh::InputError(
            fmt::format("there is no file '{}'. Make one: tyndall solve SCENE -o FOLDER.", name_));
    bytes_ = static_cast<double>(std::filesystem::file_size(path, error));
    const Seal seal = error ? Seal::none : check_seal(path);
    if (seal == Seal::broken) fail("it is damaged");
    sealed_ = seal == Seal::whole;
    if (error || H5Fis_hdf5(name_.c_str()) <= 0)
        throw mesh::InputError(
            fmt::format("'{}' is not a solution file (it is no HDF5 file). Give one that tyndall "
                        "run or tyndall solve wrote.",
                        name_));
    file_ = H5Fopen(name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file_ < 0) fail("it cannot be opened: it is cut short or damaged");
}

Hdf5Reader::~Hdf5Reader() {
    if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::fail(const std::string& what) const {
    throw mesh::InputError(
        fmt::format("cannot read the solution '{}': {}. Solve the scene again.", name_, what));
}

bool Hdf5Reader::has(const std::string& path) const {
    // Each group on the way must be there before the next can be asked for.
    for (std::size_t slash = path.find('/', 1);; slash = path.find('/', slash + 1)) {
        if (H5Lexists(file_, path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
        if (slash == std::string::npos) return true;
    }
}

template <class T>
std::vector<T> Hdf5Reader::array(const std::string& path, std::size_t columns) const {
    if (!has(path)) fail(fmt::format("'{}' is missing", path));
    const Id set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) fail(fmt::format("'{}' is damaged", path));
    const Id space(H5Dget_space(set), close_space), type(H5Dget_type(set), H5Tclose);
    hsize_t dims[2] = {0, 1};
    const int rank = columns == 1 ? 1 : 2;
    const H5T_class_t kind = std::is_floating_point_v<T> ? H5T_FLOAT : H5T_INTEGER;
    if (!space.valid() || H5Sget_simple_extent_ndims(space) != rank ||
        H5Sget_simple_extent_dims(space, dims, nullptr) != rank || dims[1] != columns ||
        H5Tget_class(type) != kind || H5Tget_size(type) != sizeof(T))
        fail(fmt::format("'{}' is of another shape than expected", path));
    const double bytes = static_cast<double>(dims[0]) * static_cast<double>(columns * sizeof(T));
    if (bytes > most_compression * bytes_)
        fail(fmt::format("'{}' is said to be larger than the file can hold", path));
    std::vector<T> values(dims[0] * columns);
    if (H5Dread(set, Types<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
        fail(fmt::format("'{}' is damaged", path));
    return values;
}

template std::vector<double> Hdf5Reader::array(const std::string&, std::size_t) const;
template std::vector<float> Hdf5Reader::array(const std::string&, std::size_t) const;
template std::vector<std::uint8_t> Hdf5Reader::array(const std::string&, std::size_t) const;
template std::vector<std::uint32_t> Hdf5Reader::array(const std::string&, std::size_t) const;

std::string Hdf5Reader::text(const std::string& path) const {
    if (!has(path)) fail(fmt::format("'{}' is missing", path));
    const Id set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) fail(fmt::format("'{}' is damaged", path));
    const Id type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), close_space);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
        H5Sget_simple_extent_npoints(space) != 1)
        fail(fmt::format("'{}' is of another shape than expected", path));
    const std::size_t size = H5Tget_size(type);
    if (static_cast<double>(size) > bytes_)
        fail(fmt::format("'{}' is said to be larger than the file", path));
    std::string text(size, '\0');
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
        fail(fmt::format("'{}' is damaged", path));
    text.resize(std::min(text.find('\0'), size));
    return text;
}

std::int64_t Hdf5Reader::attribute(const std::string& path, const std::string& name) const {
    if (!has(path) || H5Aexists_by_name(file_, path.c_str(), name.c_str(), H5P_DEFAULT) <= 0)
        fail(fmt::format("its '{}' has no '{}': another program wrote it", path, name));
    const Id attribute(H5Aopen_by_name(file_, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
    const Id space(H5Aget_space(attribute), close_space);
    std::int64_t value = 0;
    if (H5Sget_simple_extent_npoints(space) != 1 ||
        H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
        fail(fmt::format("'{}' of '{}' is of another shape than expected", name, path));
    return value;
}

}  // namespace tyndall::radiosity
