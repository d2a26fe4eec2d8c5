#include "image/resample.h"

#include <algorithm>
#include <cmath>

#include "base/threads.h"

namespace alhazen {

namespace {

/// The source pixels first, first + 1, ... that a result pixel is made of, with weights that sum to 1.
struct Taps {
    int first = 0;
    std::vector<double> weights;
};

std::vector<Taps> box_taps(int from, int to) {
    std::vector<Taps> taps(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        Taps& t = taps[static_cast<std::size_t>(i)];
        // Borders in units of 1 / to source pixels are integers, so the covered parts are exact.
        long long lo = static_cast<long long>(i) * from, hi = lo + from;
        t.first = static_cast<int>(lo / to);
        for (long long p = t.first; p * to < hi; ++p) {
            long long covered = std::min(hi, (p + 1) * to) - std::max(lo, p * to);
            t.weights.push_back(static_cast<double>(covered) / from);
        }
    }
    return taps;
}

std::vector<Taps> bilinear_taps_of_axis(int from, int to) {
    std::vector<Taps> taps(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        double x = (i + 0.5) * from / to - 0.5;
        x = std::clamp(x, 0.0, static_cast<double>(from - 1));
        int first = static_cast<int>(x);
        double t = x - first;
        taps[static_cast<std::size_t>(i)] = t > 0 ? Taps{first, {1 - t, t}} : Taps{first, {1}};
    }
    return taps;
}

void resample_row(const Image& image, const std::vector<Taps>& columns, const Taps& vertical,
                  std::vector<double>& row, std::span<float> out) {
    const auto channels = static_cast<std::size_t>(image.channels());
    std::fill(row.begin(), row.end(), 0.0);
    for (std::size_t k = 0; k < vertical.weights.size(); ++k) {
        const float* source = image.pixel(0, vertical.first + static_cast<int>(k)).data();
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] += vertical.weights[k] * static_cast<double>(source[i]);
    }
    for (std::size_t x = 0; x < columns.size(); ++x) {
        const Taps& horizontal = columns[x];
        const double* first = &row[static_cast<std::size_t>(horizontal.first) * channels];
        for (std::size_t c = 0; c < channels; ++c) {
            double sum = 0;
            for (std::size_t k = 0; k < horizontal.weights.size(); ++k)
                sum += horizontal.weights[k] * first[k * channels + c];
            out[x * channels + c] = static_cast<float>(sum);
        }
    }
}

Image resample(const Image& image, const std::vector<Taps>& columns, const std::vector<Taps>& rows) {
    Image out(static_cast<int>(columns.size()), static_cast<int>(rows.size()), image.channel_names());
    out.info.metadata = image.info.metadata;
    out.info.encoding = image.info.encoding;
    out.info.bits = image.info.bits;
    const std::size_t width = columns.size() * static_cast<std::size_t>(image.channels());
    parallel_ranges(rows.size(), 1 + 32768 / width, [&](std::size_t begin, std::size_t end) {
        std::vector<double> row(static_cast<std::size_t>(image.width()) *
                                static_cast<std::size_t>(image.channels()));
        for (std::size_t y = begin; y < end; ++y)
            resample_row(image, columns, rows[y], row, out.values().subspan(y * width, width));
    });
    return out;
}

} // namespace

Image resample_box(const Image& image, int width, int height) {
    check_image_size(width, height, image.channels());
    return resample(image, box_taps(image.width(), width), box_taps(image.height(), height));
}

Image resample_bilinear(const Image& image, int width, int height) {
    check_image_size(width, height, image.channels());
    return resample(image, bilinear_taps_of_axis(image.width(), width),
                    bilinear_taps_of_axis(image.height(), height));
}

} // namespace alhazen
