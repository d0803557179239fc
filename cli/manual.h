// The manual page, made from the command line's description.
#pragma once

#include <string>

#include "cli/program_description.h"

namespace tyndall::cli {

// tyndall(1) in troff's man macros, ASCII; letters beyond are named ("\[u03C1]").
std::string manual_page(const ProgramDescription& program);

}  // namespace tyndall::cli
