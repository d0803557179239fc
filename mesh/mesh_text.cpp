#include <fmt/format.h>

#include <charconv>
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
    std::size_t position() const { return begin_; }
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
    if (lines.words().size() > 1)
        return {};  // binary, or counts on this line: the reader's own affair
    const bool plain = lines.words()[0] == "OFF";
    if (!lines.next()) lines.fail("the file ends before its counts. Is it truncated?");
    const std::size_t vertices = lines.count(0, "the count of vertices"),
                      faces = lines.count(1, "the count of faces");
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

struct PlyHead {
    std::size_t vertices = 0, faces = 0;
    std::size_t vertex_bytes = 0, face_bytes = 0;   // at least, in a binary file
    std::string_view first_element, face_property;  // the first one's kind: "list" or a type
    bool binary = false;
};

PlyHead read_ply_head(Lines& lines) {
    if (!lines.next() || lines.words()[0] != "ply")
        lines.fail("a PLY file begins with ply. Is the file one?");
    PlyHead head;
    std::string_view element;
    while (lines.next() && lines.words()[0] != "end_header") {
        const auto& words = lines.words();
        if (words[0] == "format") head.binary = words.size() > 1 && words[1] != "ascii";
        if (words[0] == "element" && words.size() > 1) {
            element = words[1];
            if (head.first_element.empty()) head.first_element = element;
            if (element == "vertex") head.vertices = lines.count(2, "the count of vertices");
            if (element == "face") head.faces = lines.count(2, "the count of faces");
        }
        if (words[0] != "property" || words.size() < 3) continue;
        const std::size_t bytes =
            words[1] == "list" ? size_of_type(words[2]) : size_of_type(words[1]);
        if (bytes == 0)
            lines.fail(fmt::format("\"{}\" is no type of a property. Correct the file.", words[1]));
        if (element == "vertex") head.vertex_bytes += bytes;
        if (element == "face") head.face_bytes += bytes;
        if (element == "face" && head.face_property.empty()) head.face_property = words[1];
    }
    if (lines.words().empty() || lines.words()[0] != "end_header") {
        lines.fail("the file ends before end_header. Is it truncated?");
    }
    return head;
}

FileCounts check_ply(const std::string& text, const std::string& name) {
    Lines lines(text, name);
    const PlyHead head = read_ply_head(lines);
    if (head.vertices == 0 || head.faces == 0)
        lines.fail("the head promises no vertices or no faces. Export it again.");
    if (head.binary) {
        const double needed = double(head.vertices) * double(head.vertex_bytes) +
                              double(head.faces) * double(head.face_bytes);
        const double there = double(text.size()) - double(lines.position());
        if (there < needed) {
            lines.fail(fmt::format(
                "the head promises {} vertices and {} faces, {} bytes or more; {} bytes "
                "are there. Is the file truncated?",
                head.vertices, head.faces, needed, there));
        }
    } else if (head.first_element == "vertex" && head.face_property == "list") {
        check_body(lines, head.vertices, head.faces);
    }
    return {head.vertices, head.faces, head.binary};
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
