#include "image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "image/display.h"

namespace alhazen {

namespace {

/// Fills the error image with term(color of a, color of b), averaged over channels, and returns the mean of
/// all.
template <class F>
MetricResult mean_of_terms(const Image& a, const Image& b, F term) {
    check_same_size(a, b);
    MetricResult result{0, Image::grey_image(a.width(), a.height())};
    double sum = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            Vec3d ca(a.rgb(x, y)), cb(b.rgb(x, y));
            double pixel = (term(ca.x, cb.x) + term(ca.y, cb.y) + term(ca.z, cb.z)) / 3;
            result.error.at(x, y) = static_cast<float>(pixel);
            sum += pixel;
        }
    result.value = sum / (static_cast<double>(a.width()) * a.height());
    return result;
}

double squared_difference(double a, double b) {
    return (a - b) * (a - b);
}

double relative_squared_difference(double a, double b) {
    return squared_difference(a, b) / (b * b + 0.01);
}

bool has_nan(const Image& image) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const Vec3 c = image.rgb(x, y);
            if (std::isnan(c.x) || std::isnan(c.y) || std::isnan(c.z)) return true;
        }
    return false;
}

// What is shown of a picture is always a number; a picture that holds what is none must not pass for another.
MetricResult nan_for_nan(MetricResult result, const Image& a, const Image& b) {
    if (has_nan(a) || has_nan(b)) result.value = std::nan("");
    return result;
}

} // namespace

void check_same_size(const Image& a, const Image& b) {
    if (a.empty() || b.empty()) throw std::runtime_error("cannot compare images without pixels");
    if (a.size() == b.size()) return;
    throw std::runtime_error(fmt::format("images of different size: {} x {} and {} x {} pixels", a.width(),
                                         a.height(), b.width(), b.height()));
}

MetricResult mse(const Image& a, const Image& b) {
    return mean_of_terms(a, b, squared_difference);
}

RelMseResult relmse(const Image& a, const Image& b) {
    MetricResult all = mean_of_terms(a, b, relative_squared_difference);
    RelMseResult result{all.value, all.value, std::move(all.error)};
    if (!std::isfinite(all.value)) return result;
    std::vector<double> terms;
    terms.reserve(static_cast<std::size_t>(a.width()) * static_cast<std::size_t>(a.height()) * 3);
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            for (int c = 0; c < 3; ++c)
                terms.push_back(relative_squared_difference(static_cast<double>(a.rgb(x, y)[c]),
                                                            static_cast<double>(b.rgb(x, y)[c])));
    std::size_t left_out = terms.size() / 1000;
    auto end = terms.end() - static_cast<std::ptrdiff_t>(left_out);
    if (left_out > 0) std::nth_element(terms.begin(), end, terms.end());
    double sum = 0;
    for (auto t = terms.begin(); t != end; ++t) sum += *t;
    result.value = sum / static_cast<double>(terms.size() - left_out);
    return result;
}

MetricResult psnr(const Image& a, const Image& b) {
    // Clamping would make NaN and infinity look harmless.
    auto term = [](double x, double y) {
        double nan = std::nan("");
        if (!std::isfinite(x) || !std::isfinite(y)) return nan;
        return squared_difference(static_cast<double>(display_value(static_cast<float>(x))),
                                  static_cast<double>(display_value(static_cast<float>(y))));
    };
    MetricResult result = mean_of_terms(a, b, term);
    result.value = -10 * std::log10(result.value);
    return result;
}

std::span<const std::string> metric_names() {
    static const std::array<std::string, 5> names{"mse", "relmse", "psnr", "ssim", "flip"};
    return names;
}

std::optional<Metric> parse_metric(std::string_view name) {
    auto names = metric_names();
    auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Metric>(found - names.begin());
}

MetricResult compute_metric(Metric metric, const Image& a, const Image& b) {
    switch (metric) {
    case Metric::mse:
        return mse(a, b);
    case Metric::relmse:
        break;
    case Metric::psnr:
        return psnr(a, b);
    case Metric::ssim:
        return nan_for_nan(ssim(a, b), a, b);
    case Metric::flip:
        return nan_for_nan(flip(a, b), a, b);
    }
    RelMseResult r = relmse(a, b);
    return {r.value, std::move(r.error)};
}

bool larger_is_better(Metric metric) {
    return metric == Metric::psnr || metric == Metric::ssim;
}

} // namespace alhazen
