/// Radiance HDR (Ward 1991, "Real pixels"): 8-bit mantissas of red, green and blue with one common exponent,
/// scanlines run-length coded. Exposure lines of the header are not applied, as most readers do not.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "image/formats.h"

namespace alhazen {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads bytes one after the other; throws at the end.
struct ByteReader {
    std::string_view bytes;
    std::size_t position = 0;

    std::size_t left() const { return bytes.size() - position; }
    std::uint8_t next() {
        if (left() == 0) throw std::runtime_error("truncated HDR file: the pixels end too early");
        return static_cast<std::uint8_t>(bytes[position++]);
    }
    std::string_view line() {
        std::size_t end = bytes.find('\n', position);
        if (end == std::string_view::npos)
            throw std::runtime_error("truncated HDR file: the header has no end");
        std::string_view text = bytes.substr(position, end - position);
        position = end + 1;
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }
};

struct Resolution {
    Vec2i size;
    bool bottom_up = false, right_to_left = false;
};

/// "-Y 600 +X 800". Of the format's eight orientations the four that keep rows rows.
Resolution parse_resolution(std::string_view line) {
    Resolution r;
    std::array<long long, 2> n{};
    std::size_t at = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        char axis = i == 0 ? 'Y' : 'X';
        if (line.size() < at + 4 || (line[at] != '-' && line[at] != '+') || line[at + 1] != axis ||
            line[at + 2] != ' ')
            throw std::runtime_error(
                fmt::format("unsupported HDR resolution line \"{}\"; \"-Y height +X width\" expected",
                            line.substr(0, 40)));
        (i == 0 ? r.bottom_up : r.right_to_left) = i == 0 ? line[at] == '+' : line[at] == '-';
        auto [end, error] = std::from_chars(line.data() + at + 3, line.data() + line.size(), n[i]);
        if (error != std::errc{}) throw std::runtime_error("corrupt HDR resolution line: a number expected");
        at = static_cast<std::size_t>(end - line.data()) + 1;
    }
    check_image_size(n[1], n[0], 3);
    r.size = {static_cast<int>(n[1]), static_cast<int>(n[0])};
    return r;
}

void read_new_runs(ByteReader& in, std::vector<Rgbe>& row) {
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t x = 0; x < row.size();) {
            std::size_t count = in.next();
            bool run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > row.size() - x) throw std::runtime_error("corrupt HDR run length");
            std::uint8_t value = run ? in.next() : std::uint8_t{0};
            for (std::size_t i = 0; i < count; ++i) row[x++][c] = run ? value : in.next();
        }
}

/// Pixels one by one, in which (1, 1, 1, n) repeats the one before; the first is already in row[0].
void read_old_runs(ByteReader& in, std::vector<Rgbe>& row) {
    int shift = 0;
    for (std::size_t x = 1; x < row.size();) {
        Rgbe p;
        for (auto& byte : p) byte = in.next();
        if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
            row[x++] = p;
            shift = 0;
            continue;
        }
        std::size_t count = shift > 16 ? row.size() : static_cast<std::size_t>(p[3]) << shift;
        if (count > row.size() - x) throw std::runtime_error("corrupt HDR run length");
        for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
        shift += 8;
    }
}

void read_scanline(ByteReader& in, std::vector<Rgbe>& row) {
    Rgbe first;
    for (auto& byte : first) byte = in.next();
    bool new_runs = row.size() >= 8 && row.size() < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!new_runs) {
        row[0] = first;
        read_old_runs(in, row);
    } else if (static_cast<std::size_t>(first[2]) * 256 + first[3] != row.size()) {
        throw std::runtime_error("corrupt HDR scanline: its length is not the image's width");
    } else {
        read_new_runs(in, row);
    }
}

Rgbe to_rgbe(Vec3 c) {
    // NaN becomes 0 and infinity the largest number: the format knows neither.
    for (int i = 0; i < 3; ++i) c[i] = c[i] > 0 ? std::min(c[i], 0x1.fep126f) : 0.0f;
    float largest = max_component(c);
    int exponent = 0;
    // A mantissa that would round up to 256 needs the next exponent.
    if (std::frexp(largest, &exponent) >= 255.5f / 256) ++exponent;
    // What the smallest exponent cannot hold is black; so no pixel looks like the mark (1, 1, 1, n) of a run.
    if (exponent < -127 || largest == 0) return {0, 0, 0, 0};
    auto mantissa = [&](float v) {
        return static_cast<std::uint8_t>(std::lround(std::ldexp(v, 8 - exponent)));
    };
    return {mantissa(c.x), mantissa(c.y), mantissa(c.z), static_cast<std::uint8_t>(exponent + 128)};
}

void append_runs(std::string& out, const std::vector<Rgbe>& row, std::size_t c) {
    auto run_at = [&](std::size_t x) {
        std::size_t n = 1;
        while (n < 127 && x + n < row.size() && row[x + n][c] == row[x][c]) ++n;
        return n;
    };
    for (std::size_t x = 0; x < row.size();) {
        std::size_t run = run_at(x);
        if (run >= 3) {
            out.push_back(static_cast<char>(128 + run));
            out.push_back(static_cast<char>(row[x][c]));
            x += run;
            continue;
        }
        std::size_t end = x;
        while (end < row.size() && end - x < 128 && run_at(end) < 3) ++end;
        out.push_back(static_cast<char>(end - x));
        for (; x < end; ++x) out.push_back(static_cast<char>(row[x][c]));
    }
}

} // namespace

Image decode_hdr(std::string_view bytes) {
    ByteReader in{bytes};
    bool rgbe = false;
    for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
        if (!line.starts_with("FORMAT=")) continue;
        rgbe = line == "FORMAT=32-bit_rle_rgbe";
        if (!rgbe)
            throw std::runtime_error(fmt::format("unsupported HDR {}; 32-bit_rle_rgbe expected", line));
    }
    if (!rgbe) throw std::runtime_error("corrupt HDR header: FORMAT=32-bit_rle_rgbe expected");
    Resolution r = parse_resolution(in.line());
    if (in.left() < static_cast<std::size_t>(r.size.y) * 4)
        throw std::runtime_error("truncated HDR file: the pixels end too early");
    Image image = Image::rgb_image(r.size.x, r.size.y);
    std::vector<Rgbe> row(static_cast<std::size_t>(r.size.x));
    for (int line = 0; line < r.size.y; ++line) {
        read_scanline(in, row);
        int y = r.bottom_up ? r.size.y - 1 - line : line;
        for (int i = 0; i < r.size.x; ++i) {
            const Rgbe& p = row[static_cast<std::size_t>(i)];
            float scale = p[3] == 0 ? 0.0f : std::ldexp(1.0f, p[3] - 136);
            image.set_rgb(r.right_to_left ? r.size.x - 1 - i : i, y,
                          {static_cast<float>(p[0]) * scale, static_cast<float>(p[1]) * scale,
                           static_cast<float>(p[2]) * scale});
        }
    }
    return image;
}

std::string encode_hdr(const Image& image) {
    std::string out =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height(), image.width());
    std::vector<Rgbe> row(static_cast<std::size_t>(image.width()));
    bool runs = row.size() >= 8 && row.size() < 32768;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) row[static_cast<std::size_t>(x)] = to_rgbe(image.rgb(x, y));
        if (runs) {
            for (std::size_t byte : {std::size_t{2}, std::size_t{2}, row.size() / 256, row.size() % 256})
                out.push_back(static_cast<char>(byte));
            for (std::size_t c = 0; c < 4; ++c) append_runs(out, row, c);
        } else {
            for (const Rgbe& p : row)
                for (std::uint8_t byte : p) out.push_back(static_cast<char>(byte));
        }
    }
    return out;
}

} // namespace alhazen
