// Bytes as text.
#pragma once

#include <string>
#include <string_view>

namespace tyndall::view {

// Purpose: bytes in base64, padded, without line breaks. Source: RFC 4648, section 4.
std::string base64(std::string_view bytes);

}  // namespace tyndall::view
