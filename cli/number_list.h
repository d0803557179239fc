// Numbers on the command line, separated by commas.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall::cli {

// Purpose: the `count` numbers of "1,2.5,3". Errors: mesh::InputError that names `option` and says
//   what `form` is wanted, as "left,top,width,height".
std::vector<double> number_list(const std::string& text, std::size_t count,
                                const std::string& option, const std::string& form);

// The same for whole numbers of at least 0.
std::vector<std::size_t> count_list(const std::string& text, std::size_t count,
                                    const std::string& option, const std::string& form);

}  // namespace tyndall::cli
