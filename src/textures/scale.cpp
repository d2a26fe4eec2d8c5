/// One texture times a number.
#include "textures/texture_node.h"

namespace alhazen {

namespace {

template <class Family>
struct Scale final : TextureNodeOf<Family, Scale<Family>> {
    TextureInput<Family> tex{1};
    FloatTexture scale{1};

    static void describe(Fields<Scale>& f) {
        f.about("A texture times a number, which may itself be a texture.");
        f.field("tex", &Scale::tex, "what is scaled");
        f.field("scale", &Scale::scale, "the factor");
        if constexpr (is_float_family<Family>)
            f.example("third", {make_float("tex", 2), make_float("scale", 1.0f / 6)});
        else
            f.example("dim blue", {make_rgb("tex", 0.2f, 0.3f, 0.9f), make_float("scale", 0.5f)});
    }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        float factor = scale.eval(at);
        // A mask costs nothing where it is black.
        if (factor == 0) return 0;
        return tex.eval(at, lambda...) * factor;
    }
};

} // namespace

Kind<FloatNode> scale_float_texture() {
    return make_kind<FloatNode, Scale<FloatNode>>("scale");
}
Kind<SpectrumNode> scale_spectrum_texture() {
    return make_kind<SpectrumNode, Scale<SpectrumNode>>("scale");
}

} // namespace alhazen
