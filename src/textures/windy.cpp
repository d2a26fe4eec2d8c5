/// Water under wind: waves whose height follows gusts (pbrt-v4).
#include "textures/noise_texture.h"

namespace alhazen {

namespace {

template <class Family>
struct Windy final : NoiseTexture<Family, Windy<Family>> {
    static void describe(Fields<Windy>& f) {
        f.about("Waves of noise in texture space, as strong as a slower noise says; of both signs. As a "
                "colour, a grey between 0 and 1.");
        f.example("waves", {});
    }
    float number(Vec3 p, float width) const {
        return std::abs(fractal_noise(p * 0.1f, 0.5f, 3, width * 0.1f)) * fractal_noise(p, 0.5f, 6, width);
    }
};

} // namespace

Kind<FloatNode> windy_float_texture() {
    return make_kind<FloatNode, Windy<FloatNode>>("windy");
}
Kind<SpectrumNode> windy_spectrum_texture() {
    return make_kind<SpectrumNode, Windy<SpectrumNode>>("windy");
}

} // namespace alhazen
