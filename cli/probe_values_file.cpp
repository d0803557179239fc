#include "cli/probe_values_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
    std::vector<std::string> fields{""};
    for (const char c : line) {
        if (c == ',')
            fields.emplace_back();
        else if (c != ' ' && c != '\t' && c != '\r')
            fields.back() += c;
    }
    return fields;
}

class ProbeValuesParser {
  public:
    explicit ProbeValuesParser(const std::filesystem::path& name) : name_(name.string()) {}

    void add(std::string_view line, std::size_t number) {
        line_ = number;
        const auto fields = cells_of(line);
        if ((fields.size() == 1 && fields[0].empty()) || fields[0].starts_with('#')) return;
        if (names_.empty())
            take_names(fields);
        else
            add_row(fields);
    }

    ProbeValuesFile finish() {
        if (file_.points.empty())
            throw mesh::InputError(fmt::format(
                "{}: there is no row of values. Give what tyndall probe writes.", name_));
        return std::move(file_);
    }

  private:
    std::size_t column(const std::string& name) const {
        return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) -
                                        names_.begin());
    }
    bool has(const std::string& name) const { return column(name) < names_.size(); }

    void take_names(const std::vector<std::string>& fields) {
        names_ = fields;
        const bool normals = has("nx") && has("ny") && has("nz");
        for (const char* name : {"x", "y", "z"})
            if (!has(name)) fail(fmt::format("there is no column {}.", name));
        for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
            if (has(name) && (normals || name[0] != 'n')) places_.push_back(column(name));
        const std::string quantity = normals ? "E" : "J";
        if (has(quantity)) values_.push_back(column(quantity));
        for (std::size_t b = 0; has(fmt::format("{}_{}", quantity, b)); ++b)
            values_.push_back(column(fmt::format("{}_{}", quantity, b)));
        if (values_.empty()) fail(fmt::format("there is no column {}.", quantity));
    }

    double number(const std::vector<std::string>& fields, std::size_t column) const {
        const std::string& text = fields[column];
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
            fail(fmt::format("{} is \"{}\", which is no finite number. Correct it.", names_[column],
                             text));
        return value;
    }

    void add_row(const std::vector<std::string>& fields) {
        if (fields.size() != names_.size())
            fail(fmt::format("{} values under {} names.", fields.size(), names_.size()));
        SolutionPoint point;
        for (std::size_t k = 0; k < places_.size(); ++k)
            (k < 3 ? point.x : point.normal)[static_cast<int>(k % 3)] = number(fields, places_[k]);
        file_.points.push_back(point);
        radiosity::Spectrum values;
        for (const auto k : values_) values.push_back(number(fields, k));
        file_.values.push_back(std::move(values));
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw mesh::InputError(
            fmt::format("{}:{}: {} Give what tyndall probe writes.", name_, line_, what));
    }

    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::string> names_;
    std::vector<std::size_t> places_, values_;  // columns
    ProbeValuesFile file_;
};

}  // namespace

ProbeValuesFile parse_probe_values(std::string_view text, const std::filesystem::path& name) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    ProbeValuesParser parser(name);
    for (std::size_t line = 1; !text.empty(); ++line) {
        const auto end = std::min(text.find('\n'), text.size());
        parser.add(text.substr(0, end), line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parser.finish();
}

}  // namespace tyndall::cli
