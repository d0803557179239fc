#include "cli/points_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

constexpr std::array<std::string_view, 6> column_names{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::string_view wanted = "Give x,y,z or x,y,z,nx,ny,nz";

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const auto comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

std::optional<double> number_in(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

class PointsParser {
  public:
    explicit PointsParser(const std::filesystem::path& name) : name_(name.string()) {}

    void add(std::string_view line, std::size_t line_number) {
        line_ = line_number;
        line = trimmed(line);
        if (line.empty() || line.front() == '#') return;
        const auto fields = fields_of(line);
        if (columns_ == 0) {
            take_columns(fields);
            if (is_header(fields)) return;
        }
        if (fields.size() != columns_)
            fail(fmt::format("{} values instead of {}. {}.", fields.size(), columns_, wanted));
        add_row(fields);
    }

    PointsFile finish() {
        if (file_.rows.empty())
            throw mesh::InputError(fmt::format("{}: there is no point. {}.", name_, wanted));
        return std::move(file_);
    }

  private:
    void take_columns(const std::vector<std::string_view>& fields) {
        if (fields.size() != 3 && fields.size() != 6)
            fail(fmt::format("{} column{}. {}.", fields.size(), fields.size() == 1 ? "" : "s",
                             wanted));
        columns_ = fields.size();
        file_.has_normals = columns_ == 6;
    }

    // Names instead of numbers: they must be those that are known.
    bool is_header(const std::vector<std::string_view>& fields) const {
        if (std::any_of(fields.begin(), fields.end(),
                        [](auto f) { return number_in(f).has_value(); }))
            return false;
        for (std::size_t k = 0; k < fields.size(); ++k) {
            std::string lower(fields[k]);
            for (char& c : lower)
                if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
            if (lower != column_names[k])
                fail(fmt::format("column {} is \"{}\" instead of {}. {}.", k + 1, fields[k],
                                 column_names[k], wanted));
        }
        return true;
    }

    void add_row(const std::vector<std::string_view>& fields) {
        std::array<double, 6> values{};
        for (std::size_t k = 0; k < fields.size(); ++k) {
            const auto value = number_in(fields[k]);
            if (!value || !std::isfinite(*value))
                fail(fmt::format("{} is \"{}\", which is no finite number. Correct it.",
                                 column_names[k], fields[k]));
            values[k] = *value;
        }
        PointsFile::Row row{
            {values[0], values[1], values[2]}, {values[3], values[4], values[5]}, line_};
        if (file_.has_normals && row.normal == mesh::Direction(0.0))
            fail("the normal is [0, 0, 0], which looks nowhere. Correct it.");
        file_.rows.push_back(row);
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw mesh::InputError(fmt::format("{}:{}: {}", name_, line_, what));
    }

    std::string name_;
    std::size_t line_ = 0, columns_ = 0;
    PointsFile file_;
};

}  // namespace

PointsFile parse_points(std::string_view text, const std::filesystem::path& name) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    PointsParser parser(name);
    for (std::size_t line = 1; !text.empty(); ++line) {
        const auto end = std::min(text.find('\n'), text.size());
        parser.add(text.substr(0, end), line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parser.finish();
}

}  // namespace tyndall::cli
