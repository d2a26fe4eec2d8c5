/// Two textures on the squares of a board, or the cubes of a space-filling one, with unit sides. Squares are
/// told apart by the parity of the sum of their whole coordinates.
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
        return is_second(at) ? tex2.eval(at, lambda...) : tex1.eval(at, lambda...);
    }

    bool is_second(const TexturePoint& at) const {
        if (dimension == 3) {
            Vec3 p = texture_point(at);
            return is_odd(p.x) ^ is_odd(p.y) ^ is_odd(p.z);
        }
        Vec2 st = map(at);
        return is_odd(st.x) ^ is_odd(st.y);
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
