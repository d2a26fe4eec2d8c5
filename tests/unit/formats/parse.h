/// Short ways to a scene, or to what is wrong with one.
#pragma once

#include <string>

#include "formats/format.h"

namespace alhazen {

/// A scene's text with what must be around it.
inline std::string in_world(const std::string& text) {
    return "WorldBegin\n" + text;
}

inline SceneDescription parse_scene(const std::string& text, const std::filesystem::path& folder = {}) {
    Messages messages;
    return read_pbrt_string(text, folder, messages);
}

inline std::string joined(const std::vector<Message>& messages) {
    std::string all;
    for (const Message& m : messages) all += (all.empty() ? "" : "\n") + m.full_text();
    return all;
}

/// The errors, one a line; "" when there are none.
inline std::string errors_of(const std::string& text, const std::filesystem::path& folder = {}) {
    Messages messages;
    try {
        read_pbrt_string(text, folder, messages);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

/// The messages of a scene that is read without an error.
inline std::string warnings_of(const std::string& text, bool lenient = false) {
    Messages messages;
    messages.lenient = lenient;
    read_pbrt_string(text, {}, messages);
    return joined(messages.list());
}

} // namespace alhazen
