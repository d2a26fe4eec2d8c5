/// Ambient occlusion (Zhukov, Iones and Kronin 1998): how much of the sky each point sees, whatever the
/// materials and lights. The picture: a clay model on a cloudy day.
#include "color/spectrum_value.h"
#include "integrators/integrator.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct AmbientOcclusion final : Integrator {
    bool cossample = true;
    float maxdistance = infinity;

    static void describe(Fields<AmbientOcclusion>& f) {
        f.about("Shades each point by how much of the hemisphere above it is open.");
        f.field("cossample", &AmbientOcclusion::cossample, "draw directions by the cosine, not uniformly");
        f.field("maxdistance", &AmbientOcclusion::maxdistance, "objects farther than this block nothing")
            .above(0)
            .unit("scene units")
            .otherwise("infinity");
    }

    /// The light of the sky: an open point is white in every colour mode.
    SpectrumValue white = SpectrumValue::illuminant_rgb(*find_color_space("srgb"), {1, 1, 1});

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        std::optional<Hit> hit = co_await path.closest(ray);
        while (hit && hit->material->choose(*hit)->is_interface()) {
            ray = hit->spawn(ray.d);
            hit = co_await path.closest(ray);
        }
        if (!hit) co_return Spectrum(0);
        Vec3 n = face_forward(hit->ng, hit->wo);
        Frame frame = Frame::from_z(n);
        Vec2 u = path.samples.next2();
        Vec3 wi = cossample ? sample_cosine_hemisphere(u) : sample_hemisphere(u);
        float pdf = cossample ? cosine_hemisphere_pdf(wi.z) : hemisphere_pdf();
        if (pdf == 0) co_return Spectrum(0);
        Ray occluder = hit->spawn(frame.to_world(wi));
        occluder.tmax = maxdistance;
        bool open = co_await path.visible(occluder);
        if (!open) co_return Spectrum(0);
        co_return white.eval(path.lambda) * (white.light_scale(path.lambda.mode) * wi.z * inv_pi / pdf);
    }
};

} // namespace

Kind<Integrator> ambientocclusion_integrator() {
    return make_kind<Integrator, AmbientOcclusion>("ambientocclusion");
}

} // namespace alhazen
