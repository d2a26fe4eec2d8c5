/// Marble: veins of colour along y, bent by noise (Perlin 1985; the colours and their spline are pbrt-v4's).
#include "color/color_space.h"
#include "textures/noise_texture.h"

namespace alhazen {

namespace {

// From one side of a vein to the other, linear sRGB.
constexpr std::array<Vec3, 9> colors{
    Vec3{0.58f, 0.58f, 0.6f}, Vec3{0.58f, 0.58f, 0.6f}, Vec3{0.58f, 0.58f, 0.6f},
    Vec3{0.5f, 0.5f, 0.5f},   Vec3{0.6f, 0.59f, 0.58f}, Vec3{0.58f, 0.58f, 0.6f},
    Vec3{0.58f, 0.58f, 0.6f}, Vec3{0.2f, 0.2f, 0.33f},  Vec3{0.58f, 0.58f, 0.6f}};

// On cubic Bezier curves over four colours each, of which neighbours share three, so that there are edges
// between them; t in [0, 1].
Vec3 color_at(float t) {
    constexpr int curves = static_cast<int>(colors.size()) - 3;
    const int first = std::min(static_cast<int>(t * curves), curves - 1);
    const float x = t * curves - static_cast<float>(first);
    auto control = [&](int i) { return colors[static_cast<std::size_t>(first + i)]; };
    const float y = 1 - x;
    const Vec3 color = control(0) * (y * y * y) + control(1) * (3 * y * y * x) +
                       control(2) * (3 * y * x * x) + control(3) * (x * x * x);
    return color * 1.5f;
}

template <class Family>
struct Marble final : TextureNodeOf<Family, Marble<Family>> {
    int octaves = 8;
    float roughness = 0.5f, scale = 1, variation = 0.2f;
    Transform texture_from_world;
    SpectrumRole role = SpectrumRole::unbounded;

    static void describe(Fields<Marble>& f) {
        f.about(
            "Marble: pale stone with dark veins across texture space's y axis. As a number, its luminance.");
        f.field("octaves", &Marble::octaves, "of the noise that bends the veins").in(1, 64);
        f.field("roughness", &Marble::roughness, "strength of each octave over that of the one before")
            .in(0, 1);
        f.field("scale", &Marble::scale, "factor of texture space: larger makes finer veins");
        f.field("variation", &Marble::variation, "how much the veins are bent");
        f.example("marble", {make_float("scale", 4)});
    }
    void finish(const Node&, BuildContext& context) {
        texture_from_world = context.world_from_node.inverse();
        if (context.texture_use) role = context.texture_use->role;
    }

    Vec3 rgb(const TexturePoint& at) const {
        const Vec3 p = texture_from_world.point(at.p) * scale;
        const float width = pixel_width(at, texture_from_world) * scale;
        return color_at(0.5f +
                        0.5f * std::sin(p.y + variation * fractal_noise(p, roughness, octaves, width)));
    }
    float value(const TexturePoint& at) const { return dot(rgb(at), Vec3{0.2126f, 0.7152f, 0.0722f}); }
    Spectrum value(const TexturePoint& at, const Wavelengths& lambda) const {
        return SpectrumValue::rgb(srgb_space(), rgb(at), role).eval(lambda);
    }
};

} // namespace

Kind<FloatNode> marble_float_texture() {
    return make_kind<FloatNode, Marble<FloatNode>>("marble");
}
Kind<SpectrumNode> marble_spectrum_texture() {
    return make_kind<SpectrumNode, Marble<SpectrumNode>>("marble");
}

} // namespace alhazen
