/// Between two textures, by a third.
#include "textures/texture_node.h"

namespace alhazen {

namespace {

template <class Family>
struct Mix final : TextureNodeOf<Family, Mix<Family>> {
    TextureInput<Family> tex1{0}, tex2{1};
    FloatTexture amount{0.5f};

    static void describe(Fields<Mix>& f) {
        f.about("Interpolates linearly between two textures: (1 - amount) tex1 + amount tex2.");
        f.field("tex1", &Mix::tex1, "the value where amount is 0");
        f.field("tex2", &Mix::tex2, "the value where amount is 1");
        f.field("amount", &Mix::amount, "weight of tex2").in(0, 1);
        if constexpr (is_float_family<Family>)
            f.example("quarter", {make_float("amount", 0.25f)});
        else
            f.example("purple", {make_rgb("tex1", 0.8f, 0.1f, 0.1f), make_rgb("tex2", 0.1f, 0.1f, 0.8f)});
    }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        float t = amount.eval(at);
        TextureValue<Family> a = 0, b = 0;
        if (t != 1) a = tex1.eval(at, lambda...);
        if (t != 0) b = tex2.eval(at, lambda...);
        return a * (1 - t) + b * t;
    }
};

} // namespace

Kind<FloatNode> mix_float_texture() {
    return make_kind<FloatNode, Mix<FloatNode>>("mix");
}
Kind<SpectrumNode> mix_spectrum_texture() {
    return make_kind<SpectrumNode, Mix<SpectrumNode>>("mix");
}

} // namespace alhazen
