// The files of view/page, which the build puts into the program.
#pragma once

#include <string_view>

namespace tyndall::view {

// The text of page/`name`; empty: there is none.
std::string_view page_source(std::string_view name);

}  // namespace tyndall::view
