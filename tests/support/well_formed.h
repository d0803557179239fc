// Whether markup is in order.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall::test {

// Elements of HTML that have no end.
inline constexpr std::array<std::string_view, 6> never_closed{"!doctype", "meta", "link",
                                                              "img",      "br",   "input"};

// Tags are closed in the order they were opened, quotes come in pairs, entities have known names.
inline bool well_formed(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t at = 0; at < xml.size();) {
        if (xml[at] == '&') {
            const auto end = xml.find(';', at);
            const auto name = xml.substr(at + 1, end - at - 1);
            if (name != "lt" && name != "gt" && name != "amp" && name != "quot" && name != "#39")
                return false;
        }
        if (xml[at] != '<') {
            if (xml[at] == '>') return false;
            ++at;
            continue;
        }
        const auto end = xml.find('>', at);
        if (end == xml.npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
        if (tag.find('<') != tag.npos) return false;
        const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
        if (std::ranges::find(never_closed, name) != never_closed.end()) {
            at = end + 1;
            continue;
        }
        if (tag[0] == '/') {
            if (open.empty() || "/" + open.back() != tag) return false;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(name);
        }
        at = end + 1;
    }
    return open.empty();
}

}  // namespace tyndall::test
