#include "exports/vtu_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <stdexcept>

#include "exports/little_endian.h"
#include "radiosity/element_grid.h"
#include "view/base64.h"

namespace tyndall::exports {
namespace {

constexpr std::size_t block = std::size_t{1} << 20;  // bytes

// As base64 VTK's blocks: their number, their size, that of the last one (0: it is whole), the
// compressed sizes; then the blocks.
std::string compressed(const std::string& bytes) {
    std::string head, blocks;
    const std::size_t count = (bytes.size() + block - 1) / block;
    append(head, static_cast<std::uint64_t>(count));
    append(head, static_cast<std::uint64_t>(block));
    append(head, static_cast<std::uint64_t>(bytes.size() % block));
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t size = std::min(block, bytes.size() - k * block);
        std::string packed(compressBound(static_cast<uLong>(size)), '\0');
        uLongf length = packed.size();
        if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length,
                      reinterpret_cast<const Bytef*>(bytes.data()) + k * block, size, 6) != Z_OK)
            throw std::runtime_error("zlib did not compress a block.");
        append(head, static_cast<std::uint64_t>(length));
        blocks.append(packed, 0, length);
    }
    return view::base64(head) + view::base64(blocks);
}

std::string_view type_name(double) {
    return "Float64";
}
std::string_view type_name(float) {
    return "Float32";
}
std::string_view type_name(std::int32_t) {
    return "Int32";
}
std::string_view type_name(std::int64_t) {
    return "Int64";
}
std::string_view type_name(std::uint8_t) {
    return "UInt8";
}

class VtuWriter {
  public:
    std::string write(const radiosity::ElementGrid& grid) {
        xml_ =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
            "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n";
        names(grid.names);
        xml_ += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                            grid.point_count(), grid.cell_count());
        xml_ += "<PointData Scalars=\"radiance\">\n";
        array("radiance", grid.radiance, grid.bands);
        xml_ += "</PointData>\n<CellData Scalars=\"radiosity\">\n";
        for (const auto& column : grid.cells)
            std::visit([&](const auto& values) { array(column.name, values, column.components); },
                       column.values);
        xml_ += "</CellData>\n<Points>\n";
        array("Points", grid.points, 3);
        xml_ += "</Points>\n<Cells>\n";
        array("connectivity", grid.connectivity, 1);
        // Where cells end: without the 0 that they begin with.
        array("offsets", std::vector(grid.offsets.begin() + 1, grid.offsets.end()), 1);
        array("types", grid.types, 1);
        xml_ += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        return std::move(xml_);
    }

  private:
    template <class Number>
    void array(const std::string& name, const std::vector<Number>& values, std::size_t components) {
        std::string bytes;
        bytes.reserve(values.size() * sizeof(Number));
        for (const Number value : values) append(bytes, value);
        xml_ += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n",
            type_name(Number{}), name, components);
        xml_ += compressed(bytes) + "\n</DataArray>\n";
    }

    // Texts one after the other, each with a 0 at its end.
    void names(const std::vector<std::string>& names) {
        std::string bytes;
        for (const auto& name : names) bytes.append(name).append(1, '\0');
        xml_ += fmt::format(
            "<FieldData>\n<Array type=\"String\" Name=\"names\" NumberOfTuples=\"{}\" "
            "format=\"binary\">\n{}\n</Array>\n</FieldData>\n",
            names.size(), compressed(bytes));
    }

    std::string xml_;
};

}  // namespace

ExportedFiles vtu_file(const radiosity::Solution& solution) {
    return {VtuWriter().write(radiosity::element_grid(solution)), {}, {}};
}

}  // namespace tyndall::exports
