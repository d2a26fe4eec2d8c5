/// Between two textures, by where the surface faces.
#include "textures/texture_node.h"

namespace alhazen {

namespace {

template <class Family>
struct DirectionMix final : TextureNodeOf<Family, DirectionMix<Family>> {
    TextureInput<Family> tex1{0}, tex2{1};
    Vec3 dir{0, 1, 0};

    static void describe(Fields<DirectionMix>& f) {
        f.about("Mixes two textures by the surface's direction: tex1 where it faces along dir or against it, "
                "tex2 "
                "where it stands across; the weight of tex1 is the cosine between dir and the normal.");
        f.field("tex1", &DirectionMix::tex1, "the value where the surface faces dir");
        f.field("tex2", &DirectionMix::tex2, "the value where it stands across");
        f.field("dir", &DirectionMix::dir, "a direction in texture space; its length does not matter");
        f.example("snow on slopes", {make_float("tex1", 0.9f), make_float("tex2", 0.2f)});
    }
    void finish(const Node& node, BuildContext& context) {
        dir = context.world_from_node.vector(dir);
        if (const float size = length(dir); size > 0 && std::isfinite(size))
            dir = dir / size;
        else
            context.messages.add_error(node.place,
                                       "texture \"directionmix\": \"dir\" must be a direction, not zero");
    }

    template <class... Lambda>
    TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const {
        const float amount = std::min(abs_dot(at.ng, dir), 1.0f);
        return tex1.eval(at, lambda...) * amount + tex2.eval(at, lambda...) * (1 - amount);
    }
};

} // namespace

Kind<FloatNode> directionmix_float_texture() {
    return make_kind<FloatNode, DirectionMix<FloatNode>>("directionmix");
}
Kind<SpectrumNode> directionmix_spectrum_texture() {
    return make_kind<SpectrumNode, DirectionMix<SpectrumNode>>("directionmix");
}

} // namespace alhazen
