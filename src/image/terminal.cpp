#include "image/terminal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/base64.h"
#include "image/codec.h"
#include "image/display.h"
#include "image/resample.h"

namespace alhazen {

namespace {

/// The image `width` pixels wide in its own proportions, as pixels are `aspect` times as high as wide.
Image fitted(const Image& image, int width, double aspect) {
    width = std::clamp(width, 1, Image::max_side);
    double height = static_cast<double>(width) * image.height() / image.width() / aspect;
    Image rgb = image.to_rgb();
    // What is not finite would spread over the mean.
    for (float& v : rgb.values()) v = std::isfinite(v) ? std::clamp(v, 0.0f, 1.0f) : 0.0f;
    return resample_box(rgb, width, static_cast<int>(std::clamp(std::round(height), 1.0, 65536.0)));
}

int to_level(float linear, int levels, float threshold = 0.5f) {
    float v = display_value(linear) * static_cast<float>(levels - 1) + threshold;
    return std::clamp(static_cast<int>(v), 0, levels - 1);
}

Vec3i to_bytes(Vec3 c) {
    return {to_level(c.x, 256), to_level(c.y, 256), to_level(c.z, 256)};
}

constexpr Vec3i sixel_levels{6, 7, 6};
constexpr int sixel_colors = 6 * 7 * 6;

/// The cube's colour of every pixel; dithered with a 4 x 4 threshold matrix (Bayer 1973).
std::vector<int> sixel_indices(const Image& image) {
    constexpr std::array<int, 16> order{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    std::vector<int> out;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            float threshold =
                (static_cast<float>(order[static_cast<std::size_t>(y % 4 * 4 + x % 4)]) + 0.5f) / 16;
            Vec3 c = image.rgb(x, y);
            int index = 0;
            for (int i = 0; i < 3; ++i)
                index = index * sixel_levels[i] + to_level(c[i], sixel_levels[i], threshold);
            out.push_back(index);
        }
    return out;
}

/// One colour's part of a band six pixels high: a character a column, its low six bits the pixels from the
/// top.
void append_sixel_row(std::string& out, const std::vector<char>& columns) {
    for (std::size_t x = 0; x < columns.size();) {
        std::size_t end = x;
        while (end < columns.size() && columns[end] == columns[x]) ++end;
        char c = static_cast<char>('?' + columns[x]);
        if (end - x > 3)
            out += fmt::format("!{}{}", end - x, c);
        else
            out.append(end - x, c);
        x = end;
    }
}

void append_sixel_band(std::string& out, std::span<const int> indices, std::size_t width) {
    std::vector<bool> used(sixel_colors, false);
    for (int i : indices) used[static_cast<std::size_t>(i)] = true;
    std::vector<char> columns(width);
    for (int color = 0; color < sixel_colors; ++color) {
        if (!used[static_cast<std::size_t>(color)]) continue;
        std::fill(columns.begin(), columns.end(), char{0});
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (indices[i] == color)
                columns[i % width] = static_cast<char>(columns[i % width] | 1 << i / width);
        out += fmt::format("#{}", color);
        append_sixel_row(out, columns);
        out += '$'; // back to the band's left end
    }
    out += '-'; // next band
}

} // namespace

std::string draw_kitty(const Image& image, const TerminalSize& size) {
    int pixels = std::min(image.width(), std::max(1, size.columns) * std::max(1, size.cell.x));
    std::string data = base64(encode_image(".png", fitted(image, pixels, 1)));
    constexpr std::size_t chunk = 4096;
    std::string out;
    for (std::size_t at = 0; at < data.size(); at += chunk) {
        int more = at + chunk < data.size();
        if (at == 0)
            out += fmt::format("\x1b_Ga=T,f=100,c={},m={};", std::max(1, size.columns), more);
        else
            out += fmt::format("\x1b_Gm={};", more);
        out += std::string_view(data).substr(at, chunk);
        out += "\x1b\\";
    }
    return out + '\n';
}

std::string draw_sixel(const Image& image, const TerminalSize& size) {
    int pixels = std::min(image.width(), std::max(1, size.columns) * std::max(1, size.cell.x));
    Image picture = fitted(image, pixels, 1);
    std::vector<int> indices = sixel_indices(picture);
    std::string out = fmt::format("\x1bPq\"1;1;{};{}", picture.width(), picture.height());
    for (int i = 0; i < sixel_colors; ++i) {
        // Components in percent.
        auto percent = [](int level, int levels) { return level * 100 / (levels - 1); };
        out +=
            fmt::format("#{};2;{};{};{}", i, percent(i / (sixel_levels.y * sixel_levels.z), sixel_levels.x),
                        percent(i / sixel_levels.z % sixel_levels.y, sixel_levels.y),
                        percent(i % sixel_levels.z, sixel_levels.z));
    }
    auto width = static_cast<std::size_t>(picture.width());
    for (std::size_t first = 0; first < indices.size(); first += 6 * width)
        append_sixel_band(out, std::span(indices).subspan(first, std::min(6 * width, indices.size() - first)),
                          width);
    return out + "\x1b\\\n";
}

std::string draw_half_blocks(const Image& image, const TerminalSize& size) {
    // A pixel is as wide as a cell and half as high.
    double aspect = 0.5 * std::max(1, size.cell.y) / std::max(1, size.cell.x);
    Image picture = fitted(image, size.columns, aspect);
    std::string out;
    for (int y = 0; y < picture.height(); y += 2) {
        for (int x = 0; x < picture.width(); ++x) {
            Vec3i top = to_bytes(picture.rgb(x, y));
            out += fmt::format("\x1b[38;2;{};{};{}m", top.x, top.y, top.z);
            if (y + 1 < picture.height()) {
                Vec3i bottom = to_bytes(picture.rgb(x, y + 1));
                out += fmt::format("\x1b[48;2;{};{};{}m", bottom.x, bottom.y, bottom.z);
            }
            out += "\u2580";
        }
        out += "\x1b[0m\n";
    }
    return out;
}

} // namespace alhazen
