/// Text is drawn with stb_easy_font (Sean Barrett): rectangles of a font of seven pixels' height.
#include "image/caption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#pragma GCC diagnostic push
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Weverything"
#else
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace alhazen {

namespace {

constexpr int line_height = 12; // of the font's pixels

// stb_easy_font takes its text as char*, and knows ASCII only.
std::string printable(std::string_view text) {
    std::string s(text);
    for (char& c : s)
        if (c < ' ' || c > '~') c = '?';
    return s;
}

struct Corner {
    float x, y, z;
    std::array<unsigned char, 4> color;
};

std::vector<std::array<Corner, 4>> quads_of(std::string text) {
    // About 270 bytes a character, says its documentation; never more than twice that.
    std::vector<std::array<Corner, 4>> quads(8 + text.size() * 540 / sizeof(Corner[4]));
    int n = stb_easy_font_print(0, 0, text.data(), nullptr, quads.data(),
                                static_cast<int>(quads.size() * sizeof quads[0]));
    quads.resize(static_cast<std::size_t>(n));
    return quads;
}

void fill(Image& image, Rect2i r, Vec3 color) {
    for (int y = std::max(r.lo.y, 0); y < std::min(r.hi.y, image.height()); ++y)
        for (int x = std::max(r.lo.x, 0); x < std::min(r.hi.x, image.width()); ++x)
            image.set_rgb(x, y, color);
}

void paste(Image& onto, const Image& image, Vec2i corner) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) onto.set_rgb(corner.x + x, corner.y + y, image.rgb(x, y));
}

} // namespace

Vec2i text_size(std::string_view text, int scale) {
    std::string s = printable(text);
    return {stb_easy_font_width(s.data()) * scale, line_height * scale};
}

void draw_text(Image& image, Vec2i corner, std::string_view text, int scale, Vec3 color) {
    for (const auto& quad : quads_of(printable(text))) {
        auto pixel = [&](float v) { return static_cast<int>(std::lround(v)) * scale; };
        Vec2i lo{pixel(quad[0].x), pixel(quad[0].y)}, hi{pixel(quad[2].x), pixel(quad[2].y)};
        fill(image, {corner + lo, corner + hi}, color);
    }
}

Image captioned_sheet(const std::vector<Captioned>& pictures) {
    constexpr Vec3 paper{0.93f, 0.93f, 0.92f}, ink{0.02f, 0.02f, 0.03f};
    Vec2i cell;
    std::size_t lines = 0;
    for (const Captioned& p : pictures) {
        cell = {std::max(cell.x, p.image.width()), std::max(cell.y, p.image.height())};
        lines = std::max(lines, p.lines.size());
    }
    const int scale = cell.x >= 480 ? 2 : 1, gap = 6 * scale;
    auto columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(pictures.size()))));
    int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    const Vec2i pitch{cell.x + gap, cell.y + gap + line_height * scale * static_cast<int>(lines) + gap};
    Image sheet = Image::rgb_image(columns * pitch.x + gap, rows * pitch.y + gap);
    fill(sheet, {{0, 0}, sheet.size()}, paper);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const int k = static_cast<int>(i);
        Vec2i corner{gap + k % columns * pitch.x, gap + k / columns * pitch.y};
        paste(sheet, pictures[i].image, corner);
        corner.y += pictures[i].image.height() + gap;
        for (const std::string& line : pictures[i].lines) {
            draw_text(sheet, corner, line, scale, ink);
            corner.y += line_height * scale;
        }
    }
    return sheet;
}

} // namespace alhazen
