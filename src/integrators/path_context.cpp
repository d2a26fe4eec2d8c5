#include "integrators/path_context.h"

#include "materials/albedo.h"

namespace alhazen {

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
    // By flux, and always by the same few samples.
    surface->albedo = albedo_of(*bsdf, hit.shading_frame().to_local(hit.wo), 16, TransportMode::importance);
}

} // namespace alhazen
