#include <alhazen/alhazen.h>

namespace alhazen {

std::string_view library_version() {
    return ALHAZEN_VERSION;
}

InputError::InputError(std::vector<Notice> notices, const std::string& what)
    : std::runtime_error(what), notices_(std::move(notices)) {}

// Here, so that the type's identity is in the library and nowhere else.
InputError::~InputError() = default;

} // namespace alhazen
