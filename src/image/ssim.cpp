/// Structural similarity: means, variances and covariance of two images under a Gaussian window that slides
/// over them, put together so that equal structure gives 1 (Wang, Bovik, Sheikh and Simoncelli 2004, equation
/// 13).
#include <array>

#include "image/display.h"
#include "image/metrics.h"

namespace alhazen {

namespace {

constexpr int radius = 5;

std::array<float, 2 * radius + 1> gaussian_window() {
    constexpr double sigma = 1.5;
    std::array<double, 2 * radius + 1> weights{};
    double sum = 0;
    for (int i = -radius; i <= radius; ++i)
        sum += weights[static_cast<std::size_t>(i + radius)] = std::exp(-i * i / (2 * sigma * sigma));
    std::array<float, 2 * radius + 1> window{};
    for (std::size_t i = 0; i < window.size(); ++i) window[i] = static_cast<float>(weights[i] / sum);
    return window;
}

Plane luma(const Image& image) {
    Plane out(image.width(), image.height());
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            Vec3 c = image.rgb(x, y);
            out.at(x, y) =
                0.2126f * display_value(c.x) + 0.7152f * display_value(c.y) + 0.0722f * display_value(c.z);
        }
    return out;
}

Plane product(const Plane& a, const Plane& b) {
    Plane out(a.width, a.height);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = a.values[i] * b.values[i];
    return out;
}

} // namespace

MetricResult ssim(const Image& image_a, const Image& image_b) {
    check_same_size(image_a, image_b);
    auto window = gaussian_window();
    auto mean = [&](const Plane& p) { return filter_separable(p, window, window, Border::mirror); };
    Plane a = luma(image_a), b = luma(image_b);
    Plane mean_a = mean(a), mean_b = mean(b);
    Plane mean_aa = mean(product(a, a)), mean_bb = mean(product(b, b)), mean_ab = mean(product(a, b));
    int w = a.width, h = a.height;
    bool fits = w > 2 * radius && h > 2 * radius;
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    MetricResult result{0, Image::grey_image(w, h)};
    double sum = 0;
    long long count = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            auto value = [&](const Plane& p) { return static_cast<double>(p.at(x, y)); };
            double ma = value(mean_a), mb = value(mean_b);
            double variance_a = value(mean_aa) - ma * ma, variance_b = value(mean_bb) - mb * mb;
            double covariance = value(mean_ab) - ma * mb;
            double similarity = (2 * ma * mb + c1) * (2 * covariance + c2) /
                                ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
            result.error.at(x, y) = static_cast<float>(1 - similarity);
            if (fits && (x < radius || y < radius || x >= w - radius || y >= h - radius)) continue;
            sum += similarity;
            ++count;
        }
    result.value = sum / static_cast<double>(count);
    return result;
}

} // namespace alhazen
