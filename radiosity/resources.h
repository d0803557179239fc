// What the process has used so far.
#pragma once

#include <cstddef>

namespace tyndall::radiosity {

double cpu_seconds();             // of all threads, user and system [s]
double wall_seconds();            // since some fixed moment [s]
std::size_t peak_memory_bytes();  // largest resident set [byte]

}  // namespace tyndall::radiosity
