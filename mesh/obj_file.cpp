#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "mesh/face_soup.h"
#include "mesh/input_error.h"

namespace tyndall::mesh {
namespace {

// Statements that have no part in the faces.
constexpr std::array<std::string_view, 35> passed_over{
    "vt",     "vn",         "vp",        "s",        "mtllib",   "usemtl", "l",
    "p",      "cstype",     "deg",       "bmat",     "step",     "curv",   "curv2",
    "surf",   "parm",       "trim",      "hole",     "scrv",     "sp",     "end",
    "con",    "mg",         "bevel",     "c_interp", "d_interp", "lod",    "maplib",
    "usemap", "shadow_obj", "trace_obj", "ctech",    "stech",    "call",   "csh"};

// The words of a line, one after another.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view next() {
        const auto begin = rest_.find_first_not_of(" \t\r");
        if (begin == rest_.npos) return {};
        const auto end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }

  private:
    std::string_view rest_;
};

class ObjReader {
  public:
    explicit ObjReader(const std::string& name) : name_(name) {}

    FaceSoup read(std::string_view text) {
        std::string joined;  // of lines that end in a backslash
        while (!text.empty()) {
            const auto end = std::min(text.find('\n'), text.size());
            std::string_view line = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            ++line_;
            line = line.substr(0, line.find('#'));
            while (line.ends_with('\r')) line.remove_suffix(1);
            if (line.ends_with('\\')) {
                joined.append(line.substr(0, line.size() - 1)).append(" ");
                continue;
            }
            joined += line;
            statement(Words(joined));
            joined.clear();
        }
        if (!joined.empty()) fail("the file ends within a statement. Is it truncated?");
        return std::move(soup_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw InputError(fmt::format("{}:{}: {}", name_, line_, message));
    }

    void statement(Words words) {
        const std::string_view keyword = words.next();
        if (keyword.empty()) return;
        if (keyword == "v") return vertex(words);
        if (keyword == "f" || keyword == "fo") return face(words);
        if (keyword == "g" || keyword == "o") return group(keyword == "g", words);
        if (std::find(passed_over.begin(), passed_over.end(), keyword) == passed_over.end()) {
            fail(fmt::format("\"{}\" begins no statement of an OBJ file. Is the file one?",
                             keyword.substr(0, 40)));
        }
    }

    double coordinate(std::string_view word) const {
        const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
        double value = 0.0;
        const char* end = digits.data() + digits.size();
        const auto result = std::from_chars(digits.data(), end, value);
        if (word.empty()) fail("a vertex has fewer than three coordinates. Give x, y and z.");
        if (result.ec != std::errc() || result.ptr != end) {
            fail(fmt::format("coordinate \"{}\" is not a number. Correct it.", word.substr(0, 40)));
        }
        if (!(std::abs(value) <= 1e9)) {
            fail(fmt::format("coordinate {} is not finite or beyond 1e9 m. Correct it.", value));
        }
        return value;
    }

    void vertex(Words& words) {
        Point p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = coordinate(words.next());
        soup_.points.push_back(p);
    }

    // The vertex of "7", "7/1", "7/1/3", "7//3"; negative ones count back from the last.
    std::uint32_t corner(std::string_view word) const {
        const std::string_view digits = word.substr(0, word.find('/'));
        long long index = 0;
        const char* end = digits.data() + digits.size();
        const auto result = std::from_chars(digits.data(), end, index);
        if (result.ec != std::errc() || result.ptr != end) {
            fail(
                fmt::format("face corner \"{}\" is not an index. Correct it.", word.substr(0, 40)));
        }
        const auto count = static_cast<long long>(soup_.points.size());
        const long long position = index < 0 ? count + index : index - 1;
        if (position < 0 || position >= count) {
            fail(fmt::format(
                "face corner {} is out of range: there are {} vertices up to here. Is the "
                "file truncated?",
                index, count));
        }
        return static_cast<std::uint32_t>(position);
    }

    void face(Words& words) {
        SoupFace face;
        for (auto word = words.next(); !word.empty(); word = words.next()) {
            face.corners.push_back(corner(word));
        }
        if (face.corners.size() < 3) {
            fail(fmt::format("a face has {} corners. Give at least three; is the file truncated?",
                             face.corners.size()));
        }
        face.group = group_;
        soup_.faces.push_back(std::move(face));
    }

    // The first named `g` puts those of `o` out of use.
    void group(bool is_group, Words& words) {
        std::string name(words.next());
        for (auto word = words.next(); !word.empty(); word = words.next()) {
            name.append("_").append(word);
        }
        if (is_group && !name.empty() && !by_group_) {
            by_group_ = true;
            soup_.groups = {""};
            for (SoupFace& face : soup_.faces) face.group = 0;
        }
        if (is_group != by_group_) return;
        const auto found = std::find(soup_.groups.begin(), soup_.groups.end(), name);
        group_ = static_cast<std::uint32_t>(found - soup_.groups.begin());
        if (found == soup_.groups.end()) soup_.groups.push_back(std::move(name));
    }

    const std::string& name_;
    FaceSoup soup_;
    std::size_t line_ = 0;
    std::uint32_t group_ = 0;
    bool by_group_ = false;
};

}  // namespace

FaceSoup read_obj(const std::string& text, const std::string& name) {
    return ObjReader(name).read(text);
}

}  // namespace tyndall::mesh
