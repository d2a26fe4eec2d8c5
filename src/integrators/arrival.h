/// Lights that a path from the camera runs into, weighed beside next event estimation.
#pragma once

#include "integrators/path_context.h"
#include "integrators/weights.h"

namespace alhazen {

/// How a path came to where it is: what the light it finds there weighs beside light sampling.
struct Arrival {
    float pdf = 0;        ///< of the BSDF sample that led here
    bool specular = true; ///< light sampling had no part in finding what this ray finds
    LightReceiver from;   ///< where the way here began, in a straight line but for borders of media

    float weight(float light_pdf) const { return power_heuristic(pdf, light_pdf, specular); }
};

/// What the ray sees that hits nothing.
inline Spectrum escaped_light(const Ray& ray, const Arrival& arrival, const PathContext& path) {
    Spectrum sum = 0;
    for (const Light* light : path.scene.infinite_lights()) {
        float pdf = 0;
        if (!arrival.specular)
            pdf = path.scene.light_probability(arrival.from, light) *
                  light->pdf_escaped_beside_bsdf(arrival.from, ray.d);
        sum += light->escaped(arrival.from.p, ray.d, path.lambda) * arrival.weight(pdf);
    }
    return sum;
}

/// What the area light that the ray has hit sends back.
inline Spectrum emitted_light(const Hit& hit, const Ray& ray, const Arrival& arrival,
                              const PathContext& path) {
    Spectrum L = hit.area_light->emitted(hit, path.lambda);
    if (L.is_black() || arrival.specular) return L;
    float pdf = path.scene.light_probability(arrival.from, hit.area_light) *
                hit.area_light->pdf_hit(arrival.from, hit, ray.d);
    return L * arrival.weight(pdf);
}

} // namespace alhazen
