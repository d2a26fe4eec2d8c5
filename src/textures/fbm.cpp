/// Fractional Brownian motion: clouds, rust, the roughness of rock. See noise.h.
#include "textures/noise_texture.h"

namespace alhazen {

namespace {

template <class Family>
struct FractalNoise final : OctavesTexture<Family, FractalNoise<Family>> {
    static void describe(Fields<FractalNoise>& f) {
        f.about("Noise of several frequencies in texture space, around 0 and of both signs; as a colour, a "
                "grey between 0 and 1.");
        FractalNoise::describe_octaves(f);
    }
    float number(Vec3 p, float width) const {
        return fractal_noise(p, this->roughness, this->octaves, width);
    }
};

} // namespace

Kind<FloatNode> fbm_float_texture() {
    return make_kind<FloatNode, FractalNoise<FloatNode>>("fbm");
}
Kind<SpectrumNode> fbm_spectrum_texture() {
    return make_kind<SpectrumNode, FractalNoise<SpectrumNode>>("fbm");
}

} // namespace alhazen
