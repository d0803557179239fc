#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "mesh/face_soup.h"
#include "mesh/input_error.h"

namespace tyndall::mesh {
namespace {

// The lines of a text, without what stands behind '#', with their numbers; blank ones are left out.
class Lines {
  public:
    Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    bool next() {
        while (begin_ < text_.size()) {
            const auto end = std::min(text_.find('\n', begin_), text_.size());
            line_ = text_.substr(begin_, end - begin_);
            line_ = line_.substr(0, line_.find('#'));
            begin_ = end + 1;
            ++number_;
            words_.clear();
            split();
            if (!words_.empty()) return true;
        }
        return false;
    }
    const std::vector<std::string_view>& words() const { return words_; }
    // Where the next line begins, in bytes.
    std::size_t position() const { return std::min(begin_, text_.size()); }
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(fmt::format("{}:{}: {}", name_, number_, message));
    }
    std::size_t count(std::size_t word, const char* what) const {
        std::size_t value = 0;
        if (word < words_.size()) {
            const std::string_view w = words_[word];
            const auto result = std::from_chars(w.data(), w.data() + w.size(), value);
            if (result.ec == std::errc() && result.ptr == w.data() + w.size()) return value;
        }
        fail(fmt::format("{} is expected here, a whole number. Correct the file.", what));
    }

    // The words from `first` to `last` must be finite numbers.
    void check_numbers(std::size_t first, std::size_t last) const {
        for (std::size_t i = first; i < last; ++i) {
            double value = 0.0;
            const char* end = words_[i].data() + words_[i].size();
            const bool plus = words_[i].starts_with('+');
            const auto result = std::from_chars(words_[i].data() + plus, end, value);
            if (result.ec != std::errc() || result.ptr != end) {
                fail(fmt::format("\"{}\" is not a number. Correct it.", words_[i].substr(0, 40)));
            }
            if (!std::isfinite(value))
                fail(fmt::format("{} is not finite. Correct it.", words_[i]));
        }
    }

  private:
    void split() {
        std::size_t begin = 0;
        while ((begin = line_.find_first_not_of(" \t\r", begin)) != line_.npos) {
            const auto end = std::min(line_.find_first_of(" \t\r", begin), line_.size());
            words_.push_back(line_.substr(begin, end - begin));
            begin = end;
        }
    }

    std::string_view text_, line_;
    const std::string& name_;
    std::size_t begin_ = 0, number_ = 0;
    std::vector<std::string_view> words_;
};

// "n i j k …" with n ≥ 3 indices below `vertices`.
void check_face(const Lines& lines, std::size_t vertices) {
    const std::size_t corners = lines.count(0, "the count of a face's corners");
    if (corners < 3) {
        lines.fail(fmt::format("a face has {} corners. Give at least three.", corners));
    }
    if (lines.words().size() < corners + 1) {
        lines.fail(fmt::format("a face of {} corners has {} indices. Is the file truncated?",
                               corners, lines.words().size() - 1));
    }
    for (std::size_t i = 1; i <= corners; ++i) {
        const std::size_t index = lines.count(i, "the index of a face's corner");
        if (index >= vertices) {
            lines.fail(fmt::format(
                "face corner {} is out of range: there are {} vertices, from 0. Correct "
                "the file.",
                index, vertices));
        }
    }
}

// `vertices` lines of at least three words, then `faces` lines of indices.
void check_body(Lines& lines, std::size_t vertices, std::size_t faces) {
    for (std::size_t i = 0; i < vertices; ++i) {
        if (!lines.next())
            lines.fail(fmt::format("the file ends behind {} of {} vertices. Is it truncated?", i,
                                   vertices));
        if (lines.words().size() < 3)
            lines.fail("a vertex has fewer than three coordinates. Give x, y and z.");
        lines.check_numbers(0, lines.words().size());
    }
    for (std::size_t i = 0; i < faces; ++i) {
        if (!lines.next())
            lines.fail(
                fmt::format("the file ends behind {} of {} faces. Is it truncated?", i, faces));
        check_face(lines, vertices);
    }
}

FileCounts check_off(const std::string& text, const std::string& name) {
    Lines lines(text, name);
    if (!lines.next() || !lines.words()[0].ends_with("OFF")) {
        lines.fail("an OFF file begins with OFF. Is the file one?");
    }
    const bool plain = lines.words()[0] == "OFF";
    const bool same_line = lines.words().size() > 1;
    if (same_line && lines.words()[1] == "BINARY")
        lines.fail("a binary OFF file is not read. Export it as text.");
    if (!same_line && !lines.next())
        lines.fail("the file ends before its counts. Is it truncated?");
    const std::size_t vertices = lines.count(same_line ? 1 : 0, "the count of vertices"),
                      faces = lines.count(same_line ? 2 : 1, "the count of faces");
    if (vertices > text.size() || faces > text.size()) {
        lines.fail(
            fmt::format("{} vertices and {} faces do not fit into the file. Is it truncated?",
                        vertices, faces));
    }
    if (plain) check_body(lines, vertices, faces);
    return {vertices, faces};
}

// Bytes of a PLY property's type; 0 if it is none.
std::size_t size_of_type(std::string_view type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "double" || type == "float64") return 8;
    const bool four = type == "int" || type == "uint" || type == "float" || type == "int32" ||
                      type == "uint32" || type == "float32";
    return four ? 4 : 0;
}

struct PlyProperty {
    std::string_view name;
    std::size_t bytes = 0;        // of a value
    std::size_t count_bytes = 0;  // of a list's count; 0: no list
};

struct PlyElement {
    std::string_view name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHead {
    std::vector<PlyElement> elements;
    std::string_view format;

    std::size_t count_of(std::string_view name) const {
        for (const PlyElement& element : elements) {
            if (element.name == name) return element.count;
        }
        return 0;
    }
};

PlyProperty read_ply_property(const Lines& lines) {
    const auto& words = lines.words();
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3)
        lines.fail("a property has a type and a name. Correct the file.");
    const PlyProperty property{words.back(), size_of_type(words[list ? 3 : 1]),
                               list ? size_of_type(words[2]) : 0};
    if (property.bytes == 0 || (list && property.count_bytes == 0)) {
        lines.fail(fmt::format("\"{}\" is no type of a property. Correct the file.", words[1]));
    }
    return property;
}

// What OpenMesh's reader does not know it may read for ever: nothing but the known passes.
void check_ply_format(const Lines& lines) {
    const auto& words = lines.words();
    const bool known = words.size() == 3 && words[2] == "1.0" &&
                       (words[1] == "ascii" || words[1] == "binary_little_endian" ||
                        words[1] == "binary_big_endian");
    if (!known) {
        lines.fail(
            "the format is not ascii, binary_little_endian or binary_big_endian 1.0. Export it "
            "again.");
    }
}

PlyHead read_ply_head(Lines& lines) {
    if (!lines.next() || lines.words()[0] != "ply")
        lines.fail("a PLY file begins with ply. Is the file one?");
    PlyHead head;
    while (lines.next()) {
        const auto& words = lines.words();
        if (words[0] == "end_header") return head;
        if (words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "format") {
            check_ply_format(lines);
            head.format = words[1];
        } else if (words[0] == "element" && words.size() == 3) {
            head.elements.push_back({words[1], lines.count(2, "the count of an element"), {}});
        } else if (words[0] == "property" && !head.elements.empty()) {
            head.elements.back().properties.push_back(read_ply_property(lines));
        } else {
            lines.fail(fmt::format("\"{}\" begins no statement of a PLY head. Correct the file.",
                                   words[0].substr(0, 40)));
        }
    }
    lines.fail("the file ends before end_header. Is it truncated?");
}

// Vertices have x, y, z; faces their corners.
void check_ply_properties(const PlyHead& head, const Lines& lines) {
    const auto has = [&](std::string_view element, std::string_view property, bool list) {
        for (const PlyElement& e : head.elements) {
            for (const PlyProperty& p : e.properties) {
                if (e.name == element && p.name == property && (p.count_bytes > 0) == list)
                    return true;
            }
        }
        return false;
    };
    const bool whole = !head.format.empty() && has("vertex", "x", false) &&
                       has("vertex", "y", false) && has("vertex", "z", false) &&
                       (has("face", "vertex_indices", true) || has("face", "vertex_index", true));
    if (!whole) {
        lines.fail(
            "the head lacks the format, or x, y, z of the vertices, or vertex_indices of the "
            "faces. "
            "Export it again.");
    }
}

// Walks a binary body: every value there, every face of at least three corners in range.
class PlyBody {
  public:
    PlyBody(std::string_view bytes, bool big_endian, const Lines& lines)
        : bytes_(bytes), big_endian_(big_endian), lines_(lines) {}

    void check(const PlyElement& element, std::size_t vertices) {
        for (std::size_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (property.count_bytes == 0) {
                    skip(property.bytes, element, i);
                } else {
                    check_list(property, element, i, vertices);
                }
            }
        }
    }

  private:
    void skip(std::size_t count, const PlyElement& element, std::size_t i) {
        if (bytes_.size() - at_ < count) {
            lines_.fail(
                fmt::format("the file ends behind {} of {} elements \"{}\". Is it truncated?", i,
                            element.count, element.name));
        }
        at_ += count;
    }

    std::uint64_t integer(std::size_t size, const PlyElement& element, std::size_t i) {
        skip(size, element, i);
        std::uint64_t value = 0;
        for (std::size_t k = 0; k < size; ++k) {
            const std::size_t byte = big_endian_ ? at_ - size + k : at_ - 1 - k;
            value = value << 8 | static_cast<unsigned char>(bytes_[byte]);
        }
        return value;
    }

    void check_list(const PlyProperty& property, const PlyElement& element, std::size_t i,
                    std::size_t vertices) {
        const std::uint64_t count = integer(property.count_bytes, element, i);
        if (element.name != "face" || !property.name.starts_with("vertex_ind")) {
            if (count > bytes_.size()) skip(bytes_.size(), element, i);
            return skip(count * property.bytes, element, i);
        }
        if (count < 3 || count > vertices) {
            lines_.fail(fmt::format("face {} has {} corners. Correct the file.", i, count));
        }
        for (std::uint64_t k = 0; k < count; ++k) {
            const std::uint64_t index = integer(property.bytes, element, i);
            if (index >= vertices) {
                lines_.fail(
                    fmt::format("corner {} of face {} is out of range: there are {} vertices, from "
                                "0. Correct the file.",
                                index, i, vertices));
            }
        }
    }

    std::string_view bytes_;
    bool big_endian_;
    const Lines& lines_;
    std::size_t at_ = 0;
};

FileCounts check_ply(const std::string& text, const std::string& name) {
    Lines lines(text, name);
    const PlyHead head = read_ply_head(lines);
    check_ply_properties(head, lines);
    const std::size_t vertices = head.count_of("vertex"), faces = head.count_of("face");
    if (vertices == 0 || faces == 0)
        lines.fail("the head promises no vertices or no faces. Export it again.");
    if (head.format == "ascii") {
        const auto& elements = head.elements;
        const bool usual = elements.size() >= 2 && elements[0].name == "vertex" &&
                           elements[1].name == "face" && elements[1].properties.size() >= 1 &&
                           elements[1].properties[0].count_bytes > 0;
        if (!usual)
            lines.fail(
                "vertices, then faces that begin with their corners, are expected. Export it "
                "again.");
        check_body(lines, vertices, faces);
    } else {
        PlyBody body(std::string_view(text).substr(lines.position()),
                     head.format == "binary_big_endian", lines);
        for (const PlyElement& element : head.elements) body.check(element, vertices);
    }
    return {vertices, faces, head.format != "ascii"};
}

FileCounts check_stl(const std::string& text, const std::string& name) {
    const bool solid = text.compare(0, 5, "solid") == 0;
    std::uint32_t triangles = 0;
    if (text.size() >= 84) std::memcpy(&triangles, text.data() + 80, 4);
    const std::size_t expected = 84 + 50 * std::size_t(triangles);
    if (text.size() == expected)
        return {{}, {}, true};  // some binary files begin with "solid", too
    if (!solid) {
        throw InputError(
            fmt::format("{}: a binary STL file of {} triangles has {} bytes; {} are there. Is the "
                        "file truncated, or no STL?",
                        name, triangles, expected, text.size()));
    }
    Lines lines(text, name);
    std::size_t corners = 0;
    bool ended = false, in_facet = false;
    while (lines.next()) {
        const auto& words = lines.words();
        ended = words[0] == "endsolid";
        if (words[0] == "outer") in_facet = true;
        if (words[0] == "endloop") in_facet = false;
        if (words[0] != "vertex") continue;
        ++corners;
        if (!in_facet || words.size() < 4)
            lines.fail(
                "a vertex has fewer than three coordinates or stands in no loop. Correct the "
                "file.");
    }
    if (!ended || corners % 3 != 0)
        lines.fail("the file does not end with endsolid. Is it truncated?");
    return {};
}

}  // namespace

FileCounts check_mesh_text(const std::string& text, const std::string& name,
                           const std::string& extension) {
    if (extension == "ply") return check_ply(text, name);
    if (extension == "stl") return check_stl(text, name);
    return check_off(text, name);
}

}  // namespace tyndall::mesh
