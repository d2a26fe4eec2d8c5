/// The first step of paths that go with the light: a light chosen by its power, and a ray that leaves it.
#pragma once

#include <optional>

#include "lights/light_chooser.h"
#include "samplers/sampler.h"

namespace alhazen {

/// Lights by their power alone, for those who do not know yet what will be lit.
inline std::unique_ptr<LightChooser> lights_by_power(std::span<const Light* const> lights) {
    return make_light_chooser("power", lights);
}

struct LightStart {
    const Light* light = nullptr;
    float probability = 0; ///< of choosing the light
    LeavingLight leaving;

    /// The flux that the path stands for.
    Spectrum flux() const { return leaving.flux() / probability; }
    /// The place on the light as a ray would meet it; without direction.
    Hit place() const {
        Hit hit;
        hit.p = leaving.p;
        hit.p_error = leaving.p_error;
        hit.ng = hit.ns = leaving.ng;
        hit.uv = leaving.uv;
        hit.time = leaving.ray.time;
        hit.area_light = light;
        return hit;
    }
    /// What is seen of the light itself from direction hit.wo, hit being the place: radiance over the density
    /// of choosing the place. Black for lights that no ray can meet, and for far ones.
    Spectrum seen_along(const Hit& hit, const Wavelengths& lambda) const {
        if (light->is_delta() || light->is_far()) return 0;
        return light->emitted(hit, lambda) * (leaving.presence / (leaving.pdf_position * probability));
    }
    /// What it is multiplied by at the first thing that is met, at a distance: 1 but for light that does not
    /// fade.
    float growth(float distance_squared) const { return leaving.fades ? 1 : distance_squared; }
};

/// Takes five numbers, whatever comes of them; nullopt when no light leaves.
inline std::optional<LightStart> start_at_light(const LightChooser& lights, SampleStream& samples,
                                                const Wavelengths& lambda, float time) {
    const std::optional<ChosenLight> chosen = lights.choose({}, samples.next1());
    const Vec2 u1 = samples.next2(), u2 = samples.next2();
    if (!chosen) return std::nullopt;
    const std::optional<LeavingLight> leaving = chosen->light->sample_leaving(u1, u2, lambda, time);
    if (!leaving) return std::nullopt;
    return LightStart{chosen->light, chosen->probability, *leaving};
}

} // namespace alhazen
