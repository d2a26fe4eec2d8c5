/// Between four corners of the unit square of texture coordinates; beyond it, straight on, as in pbrt-v4.
#include "textures/mapping.h"
#include "textures/texture_node.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

template <class Family>
struct Bilerp final : TextureNodeOf<Family, Bilerp<Family>>, TextureMapping {
    TextureInput<Family> v00{0}, v01{1}, v10{0}, v11{1};

    static void describe(Fields<Bilerp>& f) {
        f.about("Interpolates between values at the four corners of the unit square in texture coordinates.");
        f.field("v00", &Bilerp::v00, "the value at (0, 0)");
        f.field("v01", &Bilerp::v01, "the value at (0, 1)");
        f.field("v10", &Bilerp::v10, "the value at (1, 0)");
        f.field("v11", &Bilerp::v11, "the value at (1, 1)");
        describe_mapping(f);
        f.example("ramp", {});
        if constexpr (!is_float_family<Family>)
            f.example("four colours", {make_rgb("v00", 0.8f, 0.1f, 0.1f), make_rgb("v01", 0.1f, 0.8f, 0.1f),
                                       make_rgb("v10", 0.1f, 0.1f, 0.8f), make_rgb("v11", 0.8f, 0.8f, 0.1f)});
    }
    void finish(const Node&, BuildContext& context) {
        place(context);
        if (context.texture_use && context.texture_use->role == SpectrumRole::albedo) most_ = 1;
    }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        const Vec2 st = map(at);
        auto on_side = [&](const TextureInput<Family>& low, const TextureInput<Family>& high) {
            return low.eval(at, lambda...) * (1 - st.y) + high.eval(at, lambda...) * st.y;
        };
        const auto v = on_side(v00, v01) * (1 - st.x) + on_side(v10, v11) * st.x;
        if constexpr (is_float_family<Family>)
            return v;
        else
            return clamp(v, 0, most_);
    }

  private:
    float most_ = infinity; ///< that colours can be
};

} // namespace

Kind<FloatNode> bilerp_float_texture() {
    return make_kind<FloatNode, Bilerp<FloatNode>>("bilerp");
}
Kind<SpectrumNode> bilerp_spectrum_texture() {
    return make_kind<SpectrumNode, Bilerp<SpectrumNode>>("bilerp");
}

} // namespace alhazen
