#include "lights/environment_map.h"

#include <memory>

#include "color/tone.h"
#include "image/image_colors.h"
#include "image/pyramid.h"
#include "math/equal_area.h"

namespace alhazen {

namespace {

Vec2 equirectangular(Vec3 w) {
    float phi = std::atan2(w.y, w.x) * (inv_pi / 2);
    float theta = std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z);
    return {phi < 0 ? phi + 1 : phi, theta * inv_pi};
}

} // namespace

std::function<Vec3(Vec3)> blended_sky(const Image& image) {
    if (image.width() == image.height()) {
        auto texels =
            std::make_shared<const Pyramid<Vec3>>(rgb_pyramid(image, WrapMode::octahedral_sphere, false));
        return [texels](Vec3 w) { return texels->bilinear(0, sphere_to_equal_area(w)); };
    }
    auto texels = std::make_shared<const Pyramid<Vec3>>(rgb_pyramid(image, WrapMode::repeat, false));
    // Columns go round; rows end at the poles.
    const float margin = 0.5f / static_cast<float>(image.height());
    return [texels, margin](Vec3 w) {
        Vec2 uv = equirectangular(w);
        return texels->bilinear(0, {uv.x, std::clamp(uv.y, margin, 1 - margin)});
    };
}

EnvironmentMap::EnvironmentMap(const Image& image, ColorMode mode) : texels_(image, mode) {
    integrate(image);
    all_ = make_distribution(image, Draw::all);
    bright_ = make_distribution(image, Draw::bright);
}

// Each texel's weight is the light that arrives from it, or what is too much of it: mean of its channels
// times its solid angle.
PiecewiseConstant2D EnvironmentMap::make_distribution(const Image& image, Draw draw) const {
    const float enough = draw == Draw::all ? 0 : (mean_rgb_.x + mean_rgb_.y + mean_rgb_.z) / 3;
    Vec2i size = texels_.size();
    std::vector<float> weights;
    weights.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    for (int y = 0; y < size.y; ++y) {
        float omega = solid_angle(y);
        for (int x = 0; x < size.x; ++x) {
            Vec3 rgb = emitted_rgb(image, x, y);
            weights.push_back(std::max(0.0f, (rgb.x + rgb.y + rgb.z) / 3 - enough) * omega);
        }
    }
    return PiecewiseConstant2D(weights, size.x, size.y);
}

void EnvironmentMap::integrate(const Image& image) {
    const RgbColorSpace& space = color_space_of(image);
    Vec2i size = texels_.size();
    Vec3d mean;
    double illuminance = 0;
    for (int y = 0; y < size.y; ++y) {
        auto omega = static_cast<double>(solid_angle(y));
        for (int x = 0; x < size.x; ++x) {
            Vec3 rgb = emitted_rgb(image, x, y);
            mean += Vec3d(rgb) * (omega / (4 * static_cast<double>(pi)));
            Vec2 middle{(static_cast<float>(x) + 0.5f) / static_cast<float>(size.x),
                        (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y)};
            auto cosine = static_cast<double>(std::max(0.0f, direction(middle).z));
            illuminance += static_cast<double>(space.to_xyz(rgb).y) * omega * cosine;
        }
    }
    mean_rgb_ = convert_rgb(space, srgb_space()) * Vec3(mean);
    illuminance_ = static_cast<float>(illuminance);
}

/// Of one texel of the row.
float EnvironmentMap::solid_angle(int row) const {
    auto width = static_cast<float>(texels_.size().x), height = static_cast<float>(texels_.size().y);
    if (is_octahedral()) return 4 * pi / (width * height);
    // cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2), without cancellation at the poles.
    float middle = pi * (static_cast<float>(row) + 0.5f) / height;
    return 2 * pi / width * 2 * std::sin(middle) * std::sin(pi / (2 * height));
}

// Within a texel, equal areas of the unit square are equal solid angles.
Vec3 EnvironmentMap::direction(Vec2 uv) const {
    if (is_octahedral()) return equal_area_to_sphere(uv);
    auto height = static_cast<float>(texels_.size().y);
    float row = std::min(std::floor(uv.y * height), height - 1);
    float upper = std::cos(pi * row / height), lower = std::cos(pi * (row + 1) / height);
    float z = std::clamp(lerp(uv.y * height - row, upper, lower), -1.0f, 1.0f);
    float r = safe_sqrt(1 - z * z), phi = 2 * pi * uv.x;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec2i EnvironmentMap::texel_of(Vec3 w) const {
    return texels_.nearest(is_octahedral() ? sphere_to_equal_area(w) : equirectangular(w));
}

EnvironmentMap::Sample EnvironmentMap::sample(Vec2 u, Draw draw) const {
    auto s = distribution(draw).sample(u);
    return {direction(s.p), pdf(s.cell, draw), s.cell};
}

float EnvironmentMap::pdf(Vec2i texel, Draw draw) const {
    auto width = static_cast<float>(texels_.size().x), height = static_cast<float>(texels_.size().y);
    float per_square = distribution(draw).pdf(
        {(static_cast<float>(texel.x) + 0.5f) / width, (static_cast<float>(texel.y) + 0.5f) / height});
    return per_square / (width * height * solid_angle(texel.y));
}

} // namespace alhazen
