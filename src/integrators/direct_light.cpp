#include "integrators/direct_light.h"

#include "integrators/weights.h"

namespace alhazen {

float DirectLight::mis_weight() const {
    return power_heuristic(light_pdf, bsdf_pdf, is_delta);
}

std::optional<DirectLight> propose_light(const Hit& hit, const Bsdf& bsdf, const Frame& frame,
                                         PathContext& path, LightSampling sampling) {
    LightReceiver at{hit.p, hit.ns};
    std::optional<ChosenLight> chosen = path.scene.choose_light(at, path.samples.next1());
    if (!chosen) {
        path.samples.skip(2);
        return std::nullopt;
    }
    const Vec2 u = path.pair_for(*chosen->light);
    std::optional<LightSample> light = sampling == LightSampling::alone
                                           ? chosen->light->sample(at, u, path.lambda)
                                           : chosen->light->sample_beside_bsdf(at, u, path.lambda);
    if (!light || !(light->pdf > 0) || light->L.is_black()) return std::nullopt;
    Scatter scatter = bsdf.eval(frame.to_local(hit.wo), frame.to_local(light->wi));
    if (scatter.f.is_black()) return std::nullopt;

    DirectLight direct;
    direct.light_pdf = chosen->probability * light->pdf;
    direct.bsdf_pdf = scatter.pdf;
    direct.is_delta = chosen->light->is_delta();
    direct.is_sky = chosen->light->is_infinite() && !direct.is_delta;
    direct.value = scatter.f * light->L / direct.light_pdf;
    direct.shadow_ray = hit.spawn_to(light->p, light->p_error, light->ng);
    return direct;
}

} // namespace alhazen
