// The lines of a text file of tetrahedra, for its readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/tet_file.h"

namespace tyndall::mesh {

// Lines with their numbers, from 1; blank ones are passed over. The text must outlive it.
class TetFileLines {
  public:
    // `comment` begins what is passed over up to the line's end.
    TetFileLines(std::string_view text, const std::string& name, std::string_view comment)
        : text_(text), name_(name), comment_(comment) {}

    bool next();  // false at the end of the file
    // As next(); where the file ends, fails: "the file ends before <what>. Is it truncated?"
    void expect(const std::string& what);

    const std::vector<std::string_view>& words() const { return words_; }
    std::size_t line() const { return line_; }
    std::size_t bytes() const { return text_.size(); }
    // Throws InputError "name:line: message".
    [[noreturn]] void fail(const std::string& message) const;

    // The word as a whole number of 0 or more, or a number that is finite and within 1e9 m.
    std::uint64_t whole(std::size_t word, const char* what) const;
    double coordinate(std::size_t word) const;
    // A count of things that each take `bytes` of the file at least.
    std::size_t count(std::size_t word, const char* what, std::size_t bytes) const;

  private:
    std::string_view text_;
    const std::string& name_;
    std::string_view comment_;
    std::size_t begin_ = 0, line_ = 0;
    std::vector<std::string_view> words_;
};

// Nodes by the file's own numbers.
class FileNodes {
  public:
    void add(std::uint64_t number, Point x, const TetFileLines& lines);  // fails on a doubled one
    void sort(const TetFileLines& lines);
    // The index of a node. Fails where there is none: `tet` asks.
    std::uint32_t index(std::uint64_t number, std::uint64_t tet, const TetFileLines& lines) const;
    std::vector<Point> take_points() { return std::move(points_); }
    std::size_t size() const { return points_.size(); }

  private:
    struct Entry {
        std::uint64_t number;
        std::uint32_t index;
    };
    std::vector<Entry> entries_;
    std::vector<Point> points_;
};

// Reads Gmsh's MSH text; nothing mended. Errors and cost: those of read_tet_file.
TetFile read_gmsh(std::string_view text, const std::string& name);

// Reads TetGen's .node and .ele text; nothing mended.
TetFile read_tetgen(std::string_view nodes, const std::string& nodes_name, std::string_view tets,
                    const std::string& tets_name);

}  // namespace tyndall::mesh
