#include "image/pyramid.h"

#include "image/make_pyramid.h"
#include "image/resample.h"

namespace alhazen {

namespace {

int positive_modulo(int a, int n) {
    int r = a % n;
    return r < 0 ? r + n : r;
}

/// Crossing a side of the octahedral square comes back in through the same side, mirrored about its middle:
/// the half sides are where the octahedron's lower faces were cut open.
Vec2i wrap_octahedral(Vec2i p, Vec2i size) {
    for (int axis = 0; axis < 2; ++axis) {
        int other = 1 - axis;
        int n = size[axis];
        p[axis] = std::clamp(p[axis], -n, 2 * n - 1);
        if (p[axis] >= 0 && p[axis] < n) continue;
        p[axis] = p[axis] < 0 ? -1 - p[axis] : 2 * n - 1 - p[axis];
        p[other] = size[other] - 1 - p[other];
    }
    return p;
}

/// uv in texels, in a range in which it may be rounded to int: what is farther out is the same as its range's
/// end.
Vec2 texel_coordinates(WrapMode mode, Vec2 uv, Vec2i size) {
    Vec2 out;
    for (int i = 0; i < 2; ++i) {
        float n = static_cast<float>(size[i]);
        float u = std::isfinite(uv[i]) ? uv[i] : 0;
        if (mode == WrapMode::repeat) u -= std::floor(u);
        out[i] = std::clamp(u * n, -n - 1, 2 * n + 1);
    }
    return out;
}

} // namespace

std::optional<WrapMode> parse_wrap_mode(std::string_view name) {
    if (name == "repeat") return WrapMode::repeat;
    if (name == "clamp") return WrapMode::clamp;
    if (name == "black") return WrapMode::black;
    if (name == "octahedralsphere") return WrapMode::octahedral_sphere;
    return std::nullopt;
}

std::optional<Vec2i> wrap_coordinate(WrapMode mode, Vec2i p, Vec2i size) {
    if (p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y) return p;
    switch (mode) {
    case WrapMode::repeat:
        return Vec2i{positive_modulo(p.x, size.x), positive_modulo(p.y, size.y)};
    case WrapMode::clamp:
        return Vec2i{std::clamp(p.x, 0, size.x - 1), std::clamp(p.y, 0, size.y - 1)};
    case WrapMode::octahedral_sphere:
        return wrap_octahedral(p, size);
    case WrapMode::black:
        break;
    }
    return std::nullopt;
}

std::array<BilinearTap, 4> bilinear_taps(WrapMode mode, Vec2 uv, Vec2i size) {
    Vec2 p = texel_coordinates(mode, uv, size) - Vec2{0.5f, 0.5f};
    Vec2 corner{std::floor(p.x), std::floor(p.y)};
    Vec2 t = p - corner;
    Vec2i first{static_cast<int>(corner.x), static_cast<int>(corner.y)};
    std::array<BilinearTap, 4> taps;
    for (int i = 0; i < 4; ++i) {
        Vec2i step{i & 1, i >> 1};
        auto texel = wrap_coordinate(mode, first + step, size);
        if (!texel) continue;
        taps[static_cast<std::size_t>(i)] = {*texel, (step.x ? t.x : 1 - t.x) * (step.y ? t.y : 1 - t.y)};
    }
    return taps;
}

std::optional<Vec2i> nearest_texel(WrapMode mode, Vec2 uv, Vec2i size) {
    Vec2 p = texel_coordinates(mode, uv, size);
    return wrap_coordinate(mode, {static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y))},
                           size);
}

void for_each_level(Image image, bool reduced_levels, const std::function<void(const Image&)>& use) {
    for (;;) {
        use(image);
        if (!reduced_levels || (image.width() == 1 && image.height() == 1)) return;
        image = resample_box(image, std::max(1, image.width() / 2), std::max(1, image.height() / 2));
    }
}

Pyramid<float> channel_pyramid(const Image& image, int channel, WrapMode mode, bool reduced_levels) {
    const std::string name = image.channel_names()[static_cast<std::size_t>(channel)];
    return make_pyramid<float>(
        image.select({&name, 1}), mode, reduced_levels,
        fill_each<float>([](const Image& level, int x, int y) { return level.at(x, y); }));
}

Pyramid<Vec3> rgb_pyramid(const Image& image, WrapMode mode, bool reduced_levels) {
    return make_pyramid<Vec3>(
        image.to_rgb(), mode, reduced_levels,
        fill_each<Vec3>([](const Image& level, int x, int y) { return level.rgb(x, y); }));
}

} // namespace alhazen
