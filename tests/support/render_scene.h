/// Renders a scene given as text, for tests.
#pragma once

#include <string>

#include "formats/format.h"
#include "render/renderer.h"

namespace alhazen::testing {

/// Lights that are the same from everywhere.
inline const char* const white_sky = R"(LightSource "infinite" "rgb L" [ 1 1 1 ])";

struct Rendered {
    Image image;
    RenderStats stats;
};

/// Renders scene text in pbrt's language. Throws SceneError like the program would print it.
inline Rendered render_text(const std::string& text, const RenderSettings& settings = {}) {
    Messages messages;
    SceneDescription description = read_pbrt_string(text, ALHAZEN_SOURCE_DIR "/scenes", messages);
    auto world = build_world(std::move(description), settings, messages);
    RenderStats stats = render(*world, settings, {});
    return {world->film->image(), stats};
}

inline Rendered render_file(const std::filesystem::path& file, const RenderSettings& settings = {}) {
    Messages messages;
    SceneDescription description = read_scene(file, messages);
    auto world = build_world(std::move(description), settings, messages);
    RenderStats stats = render(*world, settings, {});
    return {world->film->image(), stats};
}

/// Mean of a colour channel over the image.
inline double mean_of(const Image& image, int channel) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += static_cast<double>(image.rgb(x, y)[channel]);
    return sum / (static_cast<double>(image.width()) * image.height());
}

} // namespace alhazen::testing
