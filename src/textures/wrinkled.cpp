/// Noise with creases: crumpled paper, wood. See turbulence in noise.h.
#include "textures/noise_texture.h"

namespace alhazen {

namespace {

template <class Family>
struct Wrinkled final : OctavesTexture<Family, Wrinkled<Family>> {
    static void describe(Fields<Wrinkled>& f) {
        f.about("Noise of several frequencies in texture space, each without its sign: smooth bumps that "
                "meet in creases.");
        Wrinkled::describe_octaves(f);
    }
    float number(Vec3 p, float width) const { return turbulence(p, this->roughness, this->octaves, width); }
};

} // namespace

Kind<FloatNode> wrinkled_float_texture() {
    return make_kind<FloatNode, Wrinkled<FloatNode>>("wrinkled");
}
Kind<SpectrumNode> wrinkled_spectrum_texture() {
    return make_kind<SpectrumNode, Wrinkled<SpectrumNode>>("wrinkled");
}

} // namespace alhazen
