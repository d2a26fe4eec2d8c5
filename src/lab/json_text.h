/// JSON as text. Names come from scene files and may hold any bytes; what is no UTF-8 is shown as the
/// replacement character.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace alhazen {

template <class Json>
std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace alhazen
