#include "cli/program_description.h"

#include <algorithm>

namespace tyndall::cli {

const CommandDescription* ProgramDescription::find(const std::string& name) const {
    const auto found =
        std::find_if(commands.begin(), commands.end(),
                     [&](const CommandDescription& command) { return command.name == name; });
    return found == commands.end() ? nullptr : &*found;
}

Example example_of(const std::string& text) {
    const auto gap = text.find("  ");
    if (gap == text.npos) return {text, ""};
    const auto comment = text.find_first_not_of(' ', gap);
    return {text.substr(0, gap), comment == text.npos ? "" : text.substr(comment)};
}

}  // namespace tyndall::cli
