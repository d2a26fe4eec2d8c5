/// Error images in colours.
#include <algorithm>
#include <array>
#include <cmath>

#include "color/tone.h"
#include "image/metrics.h"

namespace alhazen {

Vec3 magma_srgb(float t) {
    // Every sixteenth colour of the published map; the map is at most 0.01 from the lines between them.
    static constexpr std::array<Vec3, 17> colors{
        Vec3{0.0015f, 0.0005f, 0.0139f}, Vec3{0.0396f, 0.0311f, 0.1335f}, Vec3{0.1131f, 0.0655f, 0.2768f},
        Vec3{0.2117f, 0.0620f, 0.4186f}, Vec3{0.3167f, 0.0717f, 0.4854f}, Vec3{0.4147f, 0.1104f, 0.5047f},
        Vec3{0.5128f, 0.1482f, 0.5076f}, Vec3{0.6136f, 0.1818f, 0.4985f}, Vec3{0.7164f, 0.2150f, 0.4753f},
        Vec3{0.8109f, 0.2529f, 0.4393f}, Vec3{0.8996f, 0.3146f, 0.3910f}, Vec3{0.9585f, 0.4113f, 0.3600f},
        Vec3{0.9857f, 0.5281f, 0.3794f}, Vec3{0.9958f, 0.6463f, 0.4414f}, Vec3{0.9970f, 0.7624f, 0.5288f},
        Vec3{0.9928f, 0.8772f, 0.6331f}, Vec3{0.9871f, 0.9914f, 0.7495f}};
    float x = (t > 0 ? std::min(t, 1.0f) : 0.0f) * static_cast<float>(colors.size() - 1);
    std::size_t i = std::min(static_cast<std::size_t>(x), colors.size() - 2);
    return lerp(x - static_cast<float>(i), colors[i], colors[i + 1]);
}

Image heat_map(const Image& error, float scale) {
    Image out = Image::rgb_image(error.width(), error.height());
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            float e = error.at(x, y) * scale;
            // NaN is the largest error there is.
            Vec3 c = magma_srgb(std::isnan(e) ? 1.0f : e);
            out.set_rgb(x, y, {srgb_decode(c.x), srgb_decode(c.y), srgb_decode(c.z)});
        }
    return out;
}

} // namespace alhazen
