/// Two textures on the squares of a board, or the cubes of a space-filling one, with unit sides. Squares are
/// told apart by the parity of the sum of their whole coordinates. Where a pixel covers several squares, they
/// are blended by a tent around it (Pharr et al. 2023, section 10.4.4).
#include <fmt/format.h>

#include "textures/mapping.h"
#include "textures/texture_node.h"

namespace alhazen {

namespace {

// Parity of floor(x), for numbers of any size.
bool is_odd(float x) {
    float whole = std::floor(x);
    return whole - 2 * std::floor(whole / 2) != 0;
}

// 1 where floor(x) is even and -1 where it is odd, integrated twice from 0.
double wave_integral(double x) {
    const double y = x / 2 - std::floor(x / 2) - 0.5;
    return x / 2 + y * (1 - 2 * std::abs(y));
}

// That wave blurred by a tent of half width r: the second difference of its second integral.
float blurred_wave(float x, float r) {
    if (!(r > 0) || std::floor(x - r) == std::floor(x + r)) return is_odd(x) ? -1.0f : 1.0f;
    if (!(r < 1e4f)) return 0;
    const double width = static_cast<double>(r);
    // Near the origin, where numbers are fine.
    const double from_even = static_cast<double>(x) - 2 * std::floor(static_cast<double>(x) / 2);
    const double curvature =
        wave_integral(from_even + width) - 2 * wave_integral(from_even) + wave_integral(from_even - width);
    return static_cast<float>(std::clamp(curvature / (width * width), -1.0, 1.0));
}

template <class Family>
struct Checkerboard final : TextureNodeOf<Family, Checkerboard<Family>>, TextureMapping {
    int dimension = 2;
    TextureInput<Family> tex1{1}, tex2{0};

    static void describe(Fields<Checkerboard>& f) {
        f.about("Alternates two textures in squares (or cubes) with sides of 1 in texture coordinates.");
        f.field("dimension", &Checkerboard::dimension,
                "2: squares in the mapped coordinates; 3: cubes in texture space")
            .in(2, 3);
        f.field("tex1", &Checkerboard::tex1, "the squares whose coordinates have an even sum");
        f.field("tex2", &Checkerboard::tex2, "the others");
        describe_mapping(f);
        f.example("board", {make_float("uscale", 8), make_float("vscale", 8)});
        f.example("cubes", {make_integer("dimension", 3)});
        if constexpr (!is_float_family<Family>)
            f.example("tiles", {make_rgb("tex1", 0.7f, 0.2f, 0.1f), make_rgb("tex2", 0.1f, 0.2f, 0.7f),
                                make_string("mapping", "planar")});
    }
    void finish(const Node&, BuildContext& context) { place(context); }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        const float share = share_of_second(at);
        if (share == 0) return tex1.eval(at, lambda...);
        if (share == 1) return tex2.eval(at, lambda...);
        return tex1.eval(at, lambda...) * (1 - share) + tex2.eval(at, lambda...) * share;
    }

    float share_of_second(const TexturePoint& at) const {
        if (dimension == 3) {
            const Vec3 p = texture_point(at);
            return is_odd(p.x) ^ is_odd(p.y) ^ is_odd(p.z) ? 1 : 0;
        }
        const Vec2 st = map(at);
        const TextureFootprint covered = footprint(at);
        constexpr float pixels = 1.5f; // half of the tent's width
        return (1 - blurred_wave(st.x, pixels * std::max(std::abs(covered.a.x), std::abs(covered.b.x))) *
                        blurred_wave(st.y, pixels * std::max(std::abs(covered.a.y), std::abs(covered.b.y)))) /
               2;
    }
};

} // namespace

Kind<FloatNode> checkerboard_float_texture() {
    return make_kind<FloatNode, Checkerboard<FloatNode>>("checkerboard");
}
Kind<SpectrumNode> checkerboard_spectrum_texture() {
    return make_kind<SpectrumNode, Checkerboard<SpectrumNode>>("checkerboard");
}

} // namespace alhazen
