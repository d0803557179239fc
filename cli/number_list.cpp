#include "cli/number_list.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "mesh/input_error.h"

namespace tyndall::cli {
namespace {

template <class Number>
std::vector<Number> list(const std::string& text, std::size_t count, const std::string& option,
                         const std::string& form) {
    std::vector<Number> numbers;
    std::string_view rest(text);
    for (;;) {
        Number number{};
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
        bool good = error == std::errc();
        if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(number);
        const auto length = static_cast<std::size_t>(end - rest.data());
        const bool last = length == rest.size();
        if (!good || (!last && rest[length] != ',')) break;
        numbers.push_back(number);
        if (last) {
            if (numbers.size() == count) return numbers;
            break;
        }
        rest.remove_prefix(length + 1);
    }
    throw mesh::InputError(fmt::format("{} is \"{}\". Give {}.", option, text, form));
}

}  // namespace

std::vector<double> number_list(const std::string& text, std::size_t count,
                                const std::string& option, const std::string& form) {
    return list<double>(text, count, option, form);
}

std::vector<std::size_t> count_list(const std::string& text, std::size_t count,
                                    const std::string& option, const std::string& form) {
    return list<std::size_t>(text, count, option, form);
}

}  // namespace tyndall::cli
