/// The same value everywhere.
#include "textures/texture_node.h"

namespace alhazen {

namespace {

template <class Family>
struct Constant final : TextureNodeOf<Family, Constant<Family>> {
    TextureInput<Family> input{1};

    static void describe(Fields<Constant>& f) {
        f.about("The same value everywhere.");
        f.field("value", &Constant::input, "the value");
        if constexpr (is_float_family<Family>)
            f.example("half", {make_float("value", 0.5f)});
        else
            f.example("orange", {make_rgb("value", 0.8f, 0.4f, 0.1f)});
    }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        return input.eval(at, lambda...);
    }
};

} // namespace

Kind<FloatNode> constant_float_texture() {
    return make_kind<FloatNode, Constant<FloatNode>>("constant");
}
Kind<SpectrumNode> constant_spectrum_texture() {
    return make_kind<SpectrumNode, Constant<SpectrumNode>>("constant");
}

} // namespace alhazen
