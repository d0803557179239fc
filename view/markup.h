// Text, numbers and tables as HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::view {

// Purpose: text that shows as it is wherever HTML or SVG may hold text, attributes too. Control
//   characters are left out.
std::string escaped(std::string_view text);

// The same of a text whose lines stay lines.
std::string multiline(std::string_view text);

// Purpose: a number with four significant digits; "not known" where it is none.
std::string figure(double value);
// The same of a share, in per cent.
std::string percent(double share);
// Of a time [s], and of memory [byte]; "not known" where it is 0, which a file leaves it at.
std::string seconds(double time);
std::string megabytes(double bytes);

// Cells are plain text, and are escaped here. The first of a row is its head; a row has as many as
// there are heads.
struct Table {
    std::string caption;
    std::vector<std::string> heads;
    std::vector<std::vector<std::string>> rows;
    bool numbers = true;  // columns with figures in them stand to the right
};

// Purpose: a table with its caption, whose heads say what they are heads of. "" without rows.
std::string table_markup(const Table& table);

// Purpose: markup that is folded under a heading on the screen, and printed whole. It stands beside
//   <details>, not within, as browsers print nothing of what is closed there; a style sheet hides
//   it. Neither is text escaped here.
std::string folded_markup(const std::string& summary, const std::string& content);

// The template with every {{name}} replaced by what `text_of(name)` says.
template <class TextOf>
std::string filled(std::string_view page, TextOf&& text_of) {
    std::string result;
    for (std::size_t at = 0;;) {
        const std::size_t begin = page.find("{{", at), end = page.find("}}", begin);
        if (begin == std::string_view::npos || end == std::string_view::npos)
            return result += page.substr(at);
        result += page.substr(at, begin - at);
        result += text_of(page.substr(begin + 2, end - begin - 2));
        at = end + 2;
    }
}

}  // namespace tyndall::view
