/// Round spots, at random in about two fifths of the squares of a board (as pbrt-v4 has them).
#include "textures/mapping.h"
#include "textures/noise.h"
#include "textures/texture_node.h"

namespace alhazen {

namespace {

constexpr float radius = 0.35f, farthest_shift = 0.5f - radius;

float square_noise(float s, float t) {
    return noise({s, t, 0.5f});
}

bool is_in_dot(Vec2 st) {
    const Vec2 square{std::floor(st.x + 0.5f), std::floor(st.y + 0.5f)};
    if (!(square_noise(square.x + 0.5f, square.y + 0.5f) > 0)) return false;
    const Vec2 centre{square.x + farthest_shift * square_noise(square.x + 1.5f, square.y + 2.8f),
                      square.y + farthest_shift * square_noise(square.x + 4.5f, square.y + 9.8f)};
    return sqr(st.x - centre.x) + sqr(st.y - centre.y) < sqr(radius);
}

template <class Family>
struct Dots final : TextureNodeOf<Family, Dots<Family>>, TextureMapping {
    TextureInput<Family> around{1}, spots{0};

    static void describe(Fields<Dots>& f) {
        f.about("Round spots of one texture on another: one at a random place in about half of the unit "
                "squares of "
                "texture coordinates.");
        f.field("inside", &Dots::around,
                "what is around the spots (pbrt-v4 has the two names the wrong way round, and its scenes are "
                "made to look right with it)");
        f.field("outside", &Dots::spots, "the spots");
        describe_mapping(f);
        f.example("spots", {make_float("uscale", 8), make_float("vscale", 8)});
    }
    void finish(const Node&, BuildContext& context) { place(context); }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        return is_in_dot(map(at)) ? spots.eval(at, lambda...) : around.eval(at, lambda...);
    }
};

} // namespace

Kind<FloatNode> dots_float_texture() {
    return make_kind<FloatNode, Dots<FloatNode>>("dots");
}
Kind<SpectrumNode> dots_spectrum_texture() {
    return make_kind<SpectrumNode, Dots<SpectrumNode>>("dots");
}

} // namespace alhazen
