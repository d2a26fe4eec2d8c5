#include "color/wavelengths.h"

#include <algorithm>
#include <array>

namespace alhazen {

namespace {

constexpr float node_density[] = {
#include "color/data/visible_density.inl"
};
constexpr std::size_t pieces = std::size(node_density) - 1;
constexpr float step = (lambda_max - lambda_min) / static_cast<float>(pieces);

/// A piecewise linear density of unit integral.
struct VisibleDensity {
    static constexpr std::size_t starts = 256;

    std::array<float, pieces + 1> density{}, below{}; ///< at the nodes, and what is below them
    std::array<std::uint8_t, starts> start{};         ///< the piece that the fraction i / starts is in

    constexpr VisibleDensity() {
        double sum = 0;
        for (std::size_t i = 0; i < pieces; ++i) sum += area(i, 1);
        double so_far = 0;
        for (std::size_t i = 0; i <= pieces; ++i) {
            density[i] = static_cast<float>(static_cast<double>(node_density[i]) / sum);
            below[i] = static_cast<float>(so_far);
            if (i < pieces) so_far += area(i, sum);
        }
        below[pieces] = 1;
        std::size_t piece = 0;
        for (std::size_t i = 0; i < starts; ++i) {
            while (below[piece + 1] <= static_cast<float>(i) / starts) ++piece;
            start[i] = static_cast<std::uint8_t>(piece);
        }
    }
    static constexpr double area(std::size_t piece, double sum) {
        return 0.5 *
               (static_cast<double>(node_density[piece]) + static_cast<double>(node_density[piece + 1])) *
               static_cast<double>(step) / sum;
    }
};
constexpr VisibleDensity visible;

} // namespace

float visible_wavelength_pdf(float lambda) {
    if (!(lambda >= lambda_min && lambda <= lambda_max)) return 0;
    const float x = (lambda - lambda_min) / step;
    const std::size_t i = std::min(static_cast<std::size_t>(x), pieces - 1);
    return visible.density[i] + (x - static_cast<float>(i)) * (visible.density[i + 1] - visible.density[i]);
}

VisibleWavelength sample_visible_wavelength(float u) {
    u = std::clamp(u, 0.0f, 1.0f);
    std::size_t i = visible.start[std::min(static_cast<std::size_t>(u * VisibleDensity::starts),
                                           VisibleDensity::starts - 1)];
    while (i + 1 < pieces && visible.below[i + 1] <= u) ++i;
    // The place t in the piece where a t + (b - a) t^2 / 2 is what is left of u, in nodes' steps.
    const float a = visible.density[i], b = visible.density[i + 1], left = (u - visible.below[i]) / step;
    const float root = std::sqrt(std::max(0.0f, sqr(a) + 2 * (b - a) * left));
    const float t = std::min(2 * left / (a + root), 1.0f);
    const float lambda = lambda_min + (static_cast<float>(i) + t) * step;
    return {std::min(lambda, lambda_max), a + t * (b - a)};
}

Wavelengths Wavelengths::sample_visible(float u) {
    Wavelengths w{ColorMode::spectral, 0, 0};
    for (int i = 0; i < 4; ++i) {
        float partner = u + 0.25f * static_cast<float>(i);
        if (partner >= 1) partner -= 1;
        const VisibleWavelength sampled = sample_visible_wavelength(partner);
        w.lambda.set(i, sampled.lambda);
        w.pdf.set(i, sampled.pdf);
    }
    return w;
}

} // namespace alhazen
