// Expressions of the place, compiled once.
#pragma once

#include <functional>
#include <string>

#include "mesh/types.h"

namespace tyndall::cli {

// Purpose: a function from an expression of x, y, z [m] with numbers, pi and e; + − * / ^;
//   comparisons, && and ||, a ? b : c; abs, min, max, sqrt, exp, ln, log10, sin, cos, tan, asin,
//   acos, atan, atan2, sinh, cosh, tanh, rint, sign.
// Errors: mesh::InputError: what is wrong and at which character, without the place in a file.
// Copies share what they compute with: call them from one thread at a time.
// Source: muParser.
std::function<double(mesh::Point)> compile_expression(const std::string& text);

}  // namespace tyndall::cli
