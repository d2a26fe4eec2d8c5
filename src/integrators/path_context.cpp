#include "integrators/path_context.h"

namespace alhazen {

namespace {

/// Share of light that is scattered, from wo; by a few samples, always the same ones.
Spectrum albedo_of(const Bsdf& bsdf, Vec3 wo) {
    constexpr int count = 16;
    Spectrum sum = 0;
    for (int i = 0; i < count; ++i) {
        // A lattice with the golden ratio's relatives (Roberts 2018).
        const float n = static_cast<float>(i) + 0.5f;
        auto fraction = [](float v) { return v - std::floor(v); };
        const Vec2 u2{fraction(n * 0.7548777f), fraction(n * 0.5698403f)};
        // By flux, which refraction does not squeeze.
        if (auto s = bsdf.sample(wo, n / count, u2, TransportMode::importance)) sum += s->f * (1 / s->pdf);
    }
    return sum * (1.0f / count);
}

} // namespace

void PathContext::see(const Ray& ray, const Hit& hit) {
    // Borders between media are looked through; past any other surface or scattering rays turn.
    if (surface->is_there || !(ray.d == first_direction_)) return;
    Wavelengths its_lambda = lambda;
    const Bsdf* bsdf = hit.material->at(hit, its_lambda, arena);
    if (!bsdf) return;
    auto facing = [&](Vec3 n) { return dot(n, hit.wo) < 0 ? -n : n; };
    surface->is_there = true;
    surface->time = ray.time;
    surface->lambda = its_lambda;
    surface->p = hit.p;
    surface->n = facing(hit.ng);
    surface->ns = facing(hit.ns);
    surface->uv = hit.uv;
    surface->albedo = albedo_of(*bsdf, hit.shading_frame().to_local(hit.wo));
}

} // namespace alhazen
