/// Bytes as text (RFC 4648, section 4): for pictures inside pages and terminals.
#pragma once

#include <string>
#include <string_view>

namespace alhazen {

/// Four characters for each three bytes, the last four filled up with '='.
std::string base64(std::string_view bytes);

} // namespace alhazen
