#include "mesh/tet_file_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mesh/input_error.h"

namespace tyndall::mesh {

bool TetFileLines::next() {
    while (begin_ < text_.size()) {
        const auto end = std::min(text_.find('\n', begin_), text_.size());
        std::string_view line = text_.substr(begin_, end - begin_);
        line = line.substr(0, line.find(comment_));
        begin_ = end + 1;
        ++line_;
        words_.clear();
        for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != line.npos;) {
            const auto stop = std::min(line.find_first_of(" \t\r", at), line.size());
            words_.push_back(line.substr(at, stop - at));
            at = stop;
        }
        if (!words_.empty()) return true;
    }
    return false;
}

void TetFileLines::expect(const std::string& what) {
    if (!next()) fail(fmt::format("the file ends before {}. Is it truncated?", what));
}

void TetFileLines::fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", name_, std::max<std::size_t>(line_, 1), message));
}

std::uint64_t TetFileLines::whole(std::size_t word, const char* what) const {
    if (word >= words_.size())
        fail(fmt::format("the line ends before {}. Correct the file.", what));
    const std::string_view w = words_[word];
    std::uint64_t value = 0;
    const auto result = std::from_chars(w.data(), w.data() + w.size(), value);
    if (result.ec != std::errc() || result.ptr != w.data() + w.size())
        fail(fmt::format("\"{}\" stands where {} is expected, a whole number. Correct the file.",
                         w.substr(0, 40), what));
    return value;
}

double TetFileLines::coordinate(std::size_t word) const {
    if (word >= words_.size())
        fail("a node has fewer than three coordinates. Give x, y and z; is the file truncated?");
    std::string_view w = words_[word];
    if (w.starts_with('+')) w.remove_prefix(1);
    double value = 0.0;
    const auto result = std::from_chars(w.data(), w.data() + w.size(), value);
    if (result.ec != std::errc() || result.ptr != w.data() + w.size())
        fail(fmt::format("coordinate \"{}\" is not a number. Correct it.", w.substr(0, 40)));
    if (!(std::abs(value) <= 1e9))
        fail(fmt::format("coordinate {} is not finite or beyond 1e9 m. Correct it.", value));
    return value;
}

std::size_t TetFileLines::count(std::size_t word, const char* what, std::size_t bytes) const {
    const std::uint64_t value = whole(word, what);
    if (value > text_.size() / bytes)
        fail(fmt::format("{} is {}, more than fits into the file's {} bytes. Is it truncated?",
                         what, value, text_.size()));
    return value;
}

void FileNodes::add(std::uint64_t number, Point x, const TetFileLines& lines) {
    if (points_.size() >= 0xfffffffeu)
        lines.fail("there are more than 4e9 nodes. Make it coarser.");
    entries_.push_back({number, static_cast<std::uint32_t>(points_.size())});
    points_.push_back(x);
}

void FileNodes::sort(const TetFileLines& lines) {
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.number != b.number ? a.number < b.number : a.index < b.index;
    });
    const auto twice =
        std::adjacent_find(entries_.begin(), entries_.end(),
                           [](const Entry& a, const Entry& b) { return a.number == b.number; });
    if (twice != entries_.end())
        lines.fail(fmt::format("node {} is there twice. Export the file again.", twice->number));
}

std::uint32_t FileNodes::index(std::uint64_t number, std::uint64_t tet,
                               const TetFileLines& lines) const {
    const auto found =
        std::lower_bound(entries_.begin(), entries_.end(), number,
                         [](const Entry& e, std::uint64_t wanted) { return e.number < wanted; });
    if (found == entries_.end() || found->number != number)
        lines.fail(
            fmt::format("tetrahedron {} has the corner {}, but there is no node of that "
                        "number among {}. Correct the file; is it truncated?",
                        tet, number, entries_.size()));
    return found->index;
}

}  // namespace tyndall::mesh
