#include "raster/shading.h"

namespace alhazen {

Spectrum LocalShading::radiance(const Hit& hit, const Bsdf& bsdf) const {
    const Frame frame = hit.shading_frame();
    const Vec3 wo = frame.to_local(hit.wo);
    const WhittedTerms k = bsdf.whitted(wo);
    Spectrum sum =
        k.ambient * options_.ambient + from_lights(hit, bsdf, wo, frame) + from_surroundings(bsdf, wo, frame);
    sum *= Spectrum(1) - k.mirror;
    if (!k.mirror.is_black()) sum += k.mirror * blurred(frame.to_world({-wo.x, -wo.y, wo.z}));
    if (!k.refract.is_black()) sum += k.refract * blurred(-hit.wo);
    if (hit.area_light) sum += hit.area_light->emitted(hit, Wavelengths::rgb());
    return sum;
}

Spectrum LocalShading::from_lights(const Hit& hit, const Bsdf& bsdf, Vec3 wo, const Frame& frame) const {
    Spectrum sum = 0;
    for (std::size_t i = 0; i < lights_.lights.size(); ++i) {
        const auto arriving = lights_.lights[i].at(hit.p);
        if (!arriving) continue;
        Spectrum reflected =
            bsdf.local(wo, frame.to_local(arriving->wi), options_.highlight) * arriving->irradiance;
        if (reflected.is_black()) continue;
        if (visibility_) reflected *= visibility_->lit(hit.p, hit.ng, i, arriving->wi);
        sum += reflected;
    }
    return sum;
}

// Matte parts gather light around the normal. Rough metals are asked for one direction that they reflect
// light from.
Spectrum LocalShading::from_surroundings(const Bsdf& bsdf, Vec3 wo, const Frame& frame) const {
    if (has(bsdf.lobes(), Lobes::diffuse)) {
        if (lights_.surroundings.is_black()) return 0;
        const Vec3 n{0, 0, wo.z < 0 ? -1.0f : 1.0f};
        return bsdf.local(wo, n, options_.highlight) * lights_.surroundings.irradiance(frame.to_world(n));
    }
    if (!has(bsdf.lobes(), Lobes::glossy)) return 0;
    auto sample = bsdf.sample(wo, 0.5f, {0.5f, 0.5f});
    if (!sample || !(sample->pdf > 0) || !has(sample->lobes, Lobes::glossy)) return 0;
    return sample->f / sample->pdf * blurred(frame.to_world(sample->wi));
}

} // namespace alhazen
