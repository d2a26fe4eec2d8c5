/// How far an image is from its reference: MSE, relMSE, PSNR, SSIM, FLIP. All compare colours (Image::rgb);
/// alpha and other channels are left out. In all of them `a` is the image under test and `b` the reference.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "image/image.h"

namespace alhazen {

/// A metric's value and its grey image of errors, pixel by pixel. A value that is not finite in an input
/// makes mse, relmse and psnr NaN (so `value <= max` fails); ssim and flip see it as 0, as 8-bit files do.
struct MetricResult {
    double value = 0;
    Image error;
};

/// Mean over pixels and channels of (a - b)^2. Error image: mean over channels.
MetricResult mse(const Image& a, const Image& b);

struct RelMseResult {
    /// The mean over pixels and channels of (a - b)^2 / (b^2 + 0.01), the largest 0.1 % of the terms left out
    /// (floor of 0.001 times their number), so that single fireflies do not decide.
    double value = 0;
    /// The same mean with all terms.
    double untrimmed = 0;
    /// Mean over channels.
    Image error;
};
RelMseResult relmse(const Image& a, const Image& b);

/// Peak signal-to-noise ratio in dB of the sRGB-encoded values clamped to 0 ... 1, peak 1; infinity for equal
/// images. Error image: squared difference of the encoded values, mean over channels.
MetricResult psnr(const Image& a, const Image& b);

/// Structural similarity (Wang et al. 2004) of the luma (Rec. 709 weights) of the sRGB-encoded values clamped
/// to 0 ... 1: Gaussian window of 11 x 11 with sigma 1.5, K1 = 0.01, K2 = 0.03, population variances. Value:
/// the mean over windows that lie inside (over all, with mirrored borders, when the image is smaller than a
/// window); 1 for equal images. Error image: 1 - SSIM.
MetricResult ssim(const Image& a, const Image& b);

struct FlipOptions {
    /// The published default: 0.7 m from a 0.7 m wide display with 3840 pixels.
    float pixels_per_degree = 67.02064f;
};
/// LDR-FLIP (Andersson et al. 2020) of the sRGB-encoded values clamped to 0 ... 1. Value: the mean of the
/// error image, which is 0 (equal) ... 1.
MetricResult flip(const Image& a, const Image& b, const FlipOptions& options = {});

/// Every metric by its name on the command line.
enum class Metric { mse, relmse, psnr, ssim, flip };
std::span<const std::string> metric_names();
std::optional<Metric> parse_metric(std::string_view name);
/// The metric with its defaults; relmse trimmed. Throws std::runtime_error when the sizes differ.
MetricResult compute_metric(Metric metric, const Image& a, const Image& b);
/// Whether a larger value means more alike (psnr, ssim).
bool larger_is_better(Metric metric);

/// The colour map magma (van der Walt and Smith 2015) at t, clamped to 0 ... 1; sRGB-encoded values.
Vec3 magma_srgb(float t);
/// A grey error image, clamped to 0 ... 1 after scaling, in magma colours; linear values, to be written with
/// the sRGB transfer.
Image heat_map(const Image& error, float scale = 1);

} // namespace alhazen
