// What a caller can choose about a scene for a path tracer.
#pragma once

#include <optional>
#include <string>

namespace tyndall::exports {

struct PathTracerOptions {
    std::string title{};
    std::string stem = "scene";  // of the main file's name; parts lie in the folder STEM_parts
    std::size_t samples = 256;   // of a pixel
    std::optional<std::size_t> band{};  // this one alone; none: all of them
};

}  // namespace tyndall::exports
