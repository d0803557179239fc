// The one exception for bad input: a scene, a file or an option that cannot be used as it is.
#pragma once

#include <stdexcept>
#include <string>

namespace tyndall::mesh {

// what(): one message that says what is wrong (with the values), where, and what to do.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace tyndall::mesh
