/// Small worlds for the laboratory's tests.
#pragma once

#include <string>

#include "formats/format.h"
#include "render/world.h"

namespace alhazen::lab_test {

inline std::unique_ptr<World> world_of(const std::string& text) {
    Messages messages;
    RenderSettings settings;
    settings.color = ColorMode::rgb;
    return build_world(read_pbrt_string(text, ALHAZEN_SOURCE_DIR "/scenes", messages), settings, messages);
}

/// A camera 4 above the ground, looking down.
inline const std::string view = R"(Film "rgb" "integer xresolution" 64 "integer yresolution" 48
LookAt 0 4 0  0 0 0  0 0 1
Camera "perspective" "float fov" 60
WorldBegin
)";
/// y = 0, larger than the view.
inline const std::string ground =
    "Shape \"trianglemesh\" \"point3 P\" [ -20 0 -21  22 0 -20  20 0 23  -21 0 20 ] "
    "\"integer indices\" [ 0 1 2 0 2 3 ]\n";
inline const std::string lamp = "LightSource \"point\" \"point3 from\" [ 1 3 2 ]\n";

/// Triangles standing on the ground in rows, where no ray of the tests runs along an edge.
inline std::string fence(int count) {
    std::string points, indices;
    for (int i = 0; i < count; ++i) {
        double x = (i % 16) * 0.2573 - 2.0131, z = (i / 16) * 0.2491 - 1.9577;
        points += std::to_string(x) + " 0 " + std::to_string(z) + "  " + std::to_string(x + 0.2) + " 0 " +
                  std::to_string(z) + "  " + std::to_string(x + 0.1) + " 0.5 " + std::to_string(z + 0.1) +
                  " ";
        for (int k = 0; k < 3; ++k) indices += std::to_string(3 * i + k) + " ";
    }
    return "Shape \"trianglemesh\" \"point3 P\" [ " + points + "] \"integer indices\" [ " + indices + "]\n";
}

inline std::unique_ptr<World> mesh_world() {
    return world_of(view + lamp + ground + fence(256));
}

} // namespace alhazen::lab_test
