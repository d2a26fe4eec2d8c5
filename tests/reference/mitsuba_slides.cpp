#include "tests/reference/mitsuba_slides.h"

#include <algorithm>
#include <cmath>

#include "color/spectrum_value.h"

namespace alhazen::testing {

namespace {

constexpr int factor = 8;

/// u to the right and v down, 0 ... 1.
Vec3 blend(const Image& image, double u, double v) {
    const int w = image.width(), h = image.height();
    const double x = u * w - 0.5, y = v * h - 0.5;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    auto row = [&](int j) {
        j = (j + h) % h;
        const auto t = static_cast<float>(x - left);
        return image.rgb((left + w) % w, j) * (1 - t) + image.rgb((left + 1) % w, j) * t;
    };
    const auto t = static_cast<float>(y - top);
    return row(top) * (1 - t) + row(top + 1) * t;
}

/// color(u, v) at the middle of each pixel.
template <class Color>
Image draw(int width, int height, const Color& color) {
    Image image = Image::rgb_image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.set_rgb(x, y, color((x + 0.5) / width, (y + 0.5) / height));
    return image;
}

Vec3 in_even_light(Vec3 rgb) {
    const SpectrumValue albedo = SpectrumValue::albedo_rgb(srgb_space(), rgb);
    std::vector<float> values;
    for (float lambda = lambda_min; lambda <= lambda_max; lambda += 5)
        values.push_back(albedo.eval({ColorMode::spectral, Spectrum(lambda)})[0]);
    auto light = std::make_shared<const SpectralCurve>(SpectralCurve::uniform(lambda_min, 5, values));
    return SpectrumValue::curve(std::move(light), SpectrumRole::illuminant).linear_srgb();
}

} // namespace

Image in_even_light(Image picture) {
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) picture.set_rgb(x, y, in_even_light(picture.rgb(x, y)));
    return picture;
}

Image panel_picture(const Image& picture) {
    return draw(factor * picture.width(), factor * picture.height(),
                [&](double u, double v) { return blend(picture, u, v); });
}

Image spot_slide(const Image& picture) {
    constexpr double degrees = M_PI / 180, edge = 30 * degrees, beam = 15 * degrees;
    const double half = std::tan(edge);
    return draw(1024, 1024, [&](double u, double v) {
        const double angle = std::atan(half * std::hypot(2 * u - 1, 2 * v - 1));
        const double fading = std::clamp((edge - angle) / (edge - beam), 0.0, 1.0);
        return (picture.empty() ? Vec3(1) : blend(picture, u, v)) * static_cast<float>(fading);
    });
}

Image projector_slide(const Image& picture) {
    // The film's diagonal, of 36 by 24 mm, is that of the picture.
    const double diagonal = std::hypot(36.0, 24.0) / 50, w = picture.width(), h = picture.height();
    const double half = diagonal / 2 / std::hypot(w, h);
    return draw(factor * picture.width(), factor * picture.height(), [&](double u, double v) {
        const double x = (2 * u - 1) * half * w, y = (2 * v - 1) * half * h;
        return blend(picture, u, v) * static_cast<float>(std::pow(1 + x * x + y * y, 1.5));
    });
}

} // namespace alhazen::testing
