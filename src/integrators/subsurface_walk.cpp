#include "integrators/subsurface_walk.h"

#include <bit>

#include "base/hash.h"

namespace alhazen {

namespace {

// For choosing among the places that a probe meets, of which nobody can say how many there will be.
Rng choices_of(PathContext& path) {
    const float u = path.samples.next1();
    const SampleState& s = path.samples.state();
    return Rng(hash_of(std::bit_cast<std::uint32_t>(u), s.pixel.x, s.pixel.y, s.sample, s.dimension));
}

// Of the distance from the origin: what floats cannot resolve well any more.
constexpr float no_distance = 1e-4f;

SubsurfaceExit seen_along_normal(const Hit& hit, Spectrum weight) {
    SubsurfaceExit exit{hit, weight};
    exit.hit.wo = hit.ns;
    return exit;
}

} // namespace

const Bssrdf* matter_entered(const Hit& hit, const BsdfSample& next, PathContext& path) {
    // Seen from inside there is nothing that scatters: what leads there has been left out.
    if (!has(next.lobes, Lobes::transmission) || !(dot(hit.wo, hit.ns) > 0)) return nullptr;
    return hit.material->subsurface(hit, path.lambda, path.arena);
}

Task<std::optional<SubsurfaceExit>> leave_matter(const Hit& hit, const Bssrdf& matter, PathContext& path) {
    const float u = path.samples.next1();
    const std::optional<Bssrdf::Probe> probe = matter.sample(u, path.samples.next2());
    Rng choices = choices_of(path);
    if (!probe) co_return std::nullopt;
    if (matter.reach() < no_distance * max_component(abs(hit.p)))
        co_return seen_along_normal(hit, matter.total());

    const Frame frame = Frame::from_z(hit.ns);
    const Material* material = hit.material->choose(hit);
    const Vec3 end = hit.p + frame.to_world(probe->to);
    Ray ray{hit.p + frame.to_world(probe->from), {}, 1, hit.time};
    ray.d = end - ray.o;
    const Vec3 along = ray.d;
    Hit chosen;
    std::uint32_t places = 0;
    // Rounding may carry the ray's start past the end.
    while (dot(ray.d, along) > 0) {
        const std::optional<Hit> met = co_await path.closest(ray);
        if (!met) break;
        if (met->material->choose(*met) == material && choices.below(++places) == 0) chosen = *met;
        ray.o = offset_origin(met->p, met->p_error, met->ng, end - met->p);
        ray.d = end - ray.o;
    }
    if (places == 0) co_return std::nullopt;

    const Vec3 offset = chosen.p - hit.p;
    const float pdf = matter.pdf(frame.to_local(offset), frame.to_local(chosen.ng));
    if (!(pdf > 0)) co_return std::nullopt;
    co_return seen_along_normal(chosen, matter.eval(length(offset)) * (static_cast<float>(places) / pdf));
}

} // namespace alhazen
