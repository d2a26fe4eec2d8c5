#include "materials/layered.h"

#include <bit>

namespace alhazen {

namespace {

// Radiance would be squeezed by the border's index and stretched again.
constexpr TransportMode mode = TransportMode::importance;

std::uint64_t bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) | std::uint64_t{std::bit_cast<std::uint32_t>(b)} << 32;
}
std::uint64_t hash_direction(std::uint64_t salt, Vec3 w) {
    return hash_of(salt, bits(w.x, w.y), bits(w.z, 0));
}
Vec2 pair(Rng& rng) {
    float u = rng.uniform();
    return {u, rng.uniform()};
}

// Power heuristic of two densities.
float share(float a, float b) {
    return a > 0 ? 1 / (1 + sqr(b / a)) : 0;
}

// The walk turned by a surface; false when its light is lost there.
template <class Walk>
bool turn(Walk& walk, const std::optional<BsdfSample>& s) {
    if (!s || s->wi.z == 0) return false;
    walk.weight *= s->f / s->pdf;
    walk.w = s->wi;
    walk.is_specular &= has(s->lobes, Lobes::specular);
    return !walk.weight.is_black();
}

// A density near that of the directions that come through the border from the base.
float density_through(const DielectricBsdf&, const DiffuseBsdf&, Vec3, Vec3 wi) {
    return cosine_hemisphere_pdf(wi.z);
}

// The base's density for the directions below a smooth border, as solid angles above it. A rough border turns
// light by (1 - 1 / eta) of its slope, twice, and mirrors turn it by twice theirs: so the base is widened.
// What this misses, the matte part catches.
float density_through(const DielectricBsdf& border, const ConductorBsdf& base, Vec3 wo, Vec3 wi) {
    constexpr float matte = 0.1f;
    const float pdf = matte * cosine_hemisphere_pdf(wi.z);
    auto in = refract(wo, {0, 0, 1}, border.eta), out = refract(wi, {0, 0, 1}, border.eta);
    if (!in || !out || in->wt.z == 0 || out->wt.z == 0) return pdf;
    const TrowbridgeReitz facets = base.facets.widened_by(border.facets, 0.5f * sqr(1 - 1 / border.eta));
    if (facets.is_smooth()) return pdf;
    const Vec3 from = -in->wt, to = -out->wt, wm = normalize(from + to);
    const float to_above = wi.z / (sqr(border.eta) * to.z);
    return pdf + (1 - matte) * to_above * facets.visible_density(from, wm) / (4 * abs_dot(from, wm));
}

} // namespace

std::uint64_t place_salt(const Hit& hit) {
    return hash_of(bits(hit.p.x, hit.p.y), bits(hit.p.z, hit.time));
}

template <class Base>
Scatter LayeredBsdf<Base>::eval(Vec3 wo, Vec3 wi, TransportMode) const {
    if (!same_hemisphere(wo, wi) || is_mirror()) return {};
    if (wo.z < 0) {
        wo = -wo;
        wi = -wi;
    }
    Scatter s{border_.eval(wo, wi, mode).f, density(wo, wi), density(wi, wo)};
    Rng rng(hash_direction(hash_direction(salt_, wo), wi));
    Spectrum sum = 0;
    for (int i = 0; i < layer_.nsamples; ++i) sum += between(wo, wi, rng);
    s.f += sum / static_cast<float>(layer_.nsamples);
    return s;
}

// One walk from wo; at each base or particle that it comes to, the light that wi brings there.
template <class Base>
Spectrum LayeredBsdf<Base>::between(Vec3 wo, Vec3 wi, Rng& rng) const {
    float u = rng.uniform();
    auto in = border_.sample(wo, u, pair(rng), mode, Sides::across);
    u = rng.uniform();
    auto out = border_.sample(wi, u, pair(rng), TransportMode::radiance, Sides::across);
    if (!in || !out) return 0;
    const Exit exit{wi, -out->wi, out->f / out->pdf * (wi.z / std::abs(out->wi.z)), out->pdf};
    Walk walk{in->wi, layer_.thickness, in->f / in->pdf};
    Spectrum sum = 0;
    for (; !walk.weight.is_black() && goes_on(walk, rng); ++walk.depth) {
        if (meets_particle(walk, rng)) {
            sum += leave_from_particle(walk, exit, rng);
        } else if (walk.w.z < 0) {
            sum += leave_from_base(walk, exit, rng);
        } else {
            u = rng.uniform();
            if (!turn(walk, border_.sample(-walk.w, u, pair(rng), mode, Sides::same))) break;
        }
    }
    return sum;
}

// Adds the light by both ways to find it: the exit's way up, and the walk's own.
template <class Base>
Spectrum LayeredBsdf<Base>::leave_from_base(Walk& walk, const Exit& exit, Rng& rng) const {
    Spectrum sum = 0;
    if (!base_is_specular()) {
        Scatter s = base_.eval(-walk.w, exit.up, mode);
        float weight = border_.is_specular() ? 1 : share(exit.pdf, s.pdf);
        sum = walk.weight * s.f * exit.weight * (weight * layer_.transmittance(layer_.thickness, exit.up));
    }
    float u = rng.uniform();
    auto next = base_.sample(-walk.w, u, pair(rng), mode);
    walk.height = 0;
    if (!turn(walk, next)) {
        walk.weight = 0;
        return sum;
    }
    return sum + leave_along(walk, exit, base_is_specular() ? infinity : next->pdf);
}

template <class Base>
Spectrum LayeredBsdf<Base>::leave_from_particle(Walk& walk, const Exit& exit, Rng& rng) const {
    walk.weight *= layer_.albedo;
    float phase = layer_.phase.eval(-walk.w, exit.up);
    float weight = border_.is_specular() ? 1 : share(exit.pdf, phase);
    float height = layer_.thickness - walk.height;
    Spectrum sum = exit.weight * (phase * weight * layer_.transmittance(height, exit.up));
    if (border_.is_specular() && base_is_specular()) sum = (sum + mirrored_exit(walk, exit)) * echoes(exit);
    sum *= walk.weight;
    PhaseSample next = layer_.phase.sample(-walk.w, pair(rng));
    walk.w = next.wi;
    return sum + leave_along(walk, exit, next.pdf);
}

// Between two mirrors the walk itself never finds the exit. From a particle there are two ways to it,
// straight up and by the base, ...
template <class Base>
Spectrum LayeredBsdf<Base>::mirrored_exit(const Walk& walk, const Exit& exit) const {
    const Vec3 down{exit.up.x, exit.up.y, -exit.up.z};
    const float clear =
        layer_.transmittance(walk.height, down) * layer_.transmittance(layer_.thickness, exit.up);
    return base_.whitted(exit.up).mirror * exit.weight * (layer_.phase.eval(-walk.w, down) * clear);
}

// ... both with any number of echoes before.
template <class Base>
Spectrum LayeredBsdf<Base>::echoes(const Exit& exit) const {
    const float clear = sqr(layer_.transmittance(layer_.thickness, exit.up));
    return 1 / (1 - base_.whitted(exit.up).mirror * (border_.specular_reflection(exit.wi) * clear));
}

// Straight up and through the border; pdf is that of the walk's direction.
template <class Base>
Spectrum LayeredBsdf<Base>::leave_along(const Walk& walk, const Exit& exit, float pdf) const {
    if (border_.is_specular() || walk.w.z <= 0) return 0;
    Scatter s = border_.eval(-walk.w, exit.wi, mode, Sides::across);
    float weight = share(pdf, s.pdf_reverse);
    return walk.weight * s.f * (weight * layer_.transmittance(layer_.thickness - walk.height, walk.w));
}

// False at the end of a walk: too long, or by Russian roulette.
template <class Base>
bool LayeredBsdf<Base>::goes_on(Walk& walk, Rng& rng) const {
    if (walk.depth >= layer_.maxdepth || walk.w.z == 0) return false;
    float left = walk.weight.max();
    if (walk.depth <= 3 || left >= 0.25f) return true;
    if (rng.uniform() >= left) return false;
    walk.weight /= left;
    return true;
}

// Moves the walk up or down to the next particle, or to the border or base.
template <class Base>
bool LayeredBsdf<Base>::meets_particle(Walk& walk, Rng& rng) const {
    const bool is_up = walk.w.z > 0;
    const float end = is_up ? layer_.thickness : 0;
    if (layer_.is_cloudy()) {
        float height = walk.height - std::log(1 - rng.uniform()) * walk.w.z;
        if (height > 0 && height < layer_.thickness) {
            walk.height = height;
            walk.is_specular = false;
            return true;
        }
    } else {
        walk.weight *= layer_.transmittance(layer_.thickness, walk.w);
    }
    walk.height = end;
    return false;
}

template <class Base>
std::optional<BsdfSample> LayeredBsdf<Base>::sample(Vec3 wo, float u, Vec2 u2, TransportMode) const {
    if (wo.z == 0) return std::nullopt;
    const bool is_flipped = wo.z < 0;
    if (is_flipped) wo = -wo;
    std::optional<BsdfSample> s;
    if (is_mirror()) {
        s = finish(wo, {-wo.x, -wo.y, wo.z}, mirrored(wo), true);
    } else {
        auto first = border_.sample(wo, u, u2, mode);
        if (!first || first->wi.z == 0) return std::nullopt;
        const Spectrum weight = first->f / first->pdf;
        const bool is_specular = has(first->lobes, Lobes::specular);
        if (has(first->lobes, Lobes::reflection)) {
            s = finish(wo, first->wi, weight, is_specular);
        } else {
            Rng rng(hash_of(hash_direction(salt_, wo), bits(u2.x, u2.y), bits(u, 0)));
            Walk walk{first->wi, layer_.thickness, weight, 0, is_specular};
            // A smooth border needs no numbers for where to go, and well spread ones are worth keeping.
            s = follow(walk, wo, is_specular ? u2 : pair(rng), rng);
        }
    }
    if (s && is_flipped) s->wi = -s->wi;
    return s;
}

// Until it is out. u2 is for the first reflection at the base.
template <class Base>
std::optional<BsdfSample> LayeredBsdf<Base>::follow(Walk walk, Vec3 wo, Vec2 u2, Rng& rng) const {
    for (; goes_on(walk, rng); ++walk.depth) {
        if (meets_particle(walk, rng)) {
            walk.weight *= layer_.albedo;
            walk.w = layer_.phase.sample(-walk.w, pair(rng)).wi;
        } else if (walk.w.z < 0) {
            float u = rng.uniform();
            if (!turn(walk, base_.sample(-walk.w, u, walk.depth == 0 ? u2 : pair(rng), mode)))
                return std::nullopt;
        } else {
            float u = rng.uniform();
            auto next = border_.sample(-walk.w, u, pair(rng), mode);
            if (!turn(walk, next)) return std::nullopt;
            if (has(next->lobes, Lobes::transmission))
                return finish(wo, walk.w, walk.weight, walk.is_specular);
        }
    }
    return std::nullopt;
}

template <class Base>
BsdfSample LayeredBsdf<Base>::finish(Vec3 wo, Vec3 wi, Spectrum weight, bool is_specular) const {
    if (is_specular) return {wi, weight, 1, 1, Lobes::reflection | Lobes::specular, 1};
    float pdf = density(wo, wi);
    return {wi, weight * pdf, pdf, density(wi, wo), Lobes::reflection | Lobes::glossy, 1};
}

// Mirror over mirror: R + T B T + T B R B T + ... without chance. Seen from within, the border is the same.
template <class Base>
Spectrum LayeredBsdf<Base>::mirrored(Vec3 wo) const {
    const float outer = border_.specular_reflection(wo);
    auto in = refract(wo, {0, 0, 1}, border_.eta);
    if (!in || in->wt.z == 0) return outer;
    const Spectrum base = base_.whitted(in->wt).mirror * sqr(layer_.transmittance(layer_.thickness, in->wt));
    Spectrum sum = 0, term = sqr(1 - outer);
    for (int i = 0; i < layer_.maxdepth; i += 2, term *= outer) sum += term *= base;
    return outer + sum;
}

template <class Base>
Lobes LayeredBsdf<Base>::lobes() const {
    if (is_mirror()) return Lobes::reflection | Lobes::specular;
    Lobes all = Lobes::reflection | Lobes::glossy;
    if (has(base_.lobes(), Lobes::diffuse) || layer_.is_cloudy()) all = all | Lobes::diffuse;
    return border_.is_specular() ? all | Lobes::specular : all;
}

template <class Base>
WhittedTerms LayeredBsdf<Base>::whitted(Vec3 wo) const {
    wo.z = std::abs(wo.z);
    WhittedTerms terms = base_.whitted(wo);
    terms.mirror = is_mirror() ? mirrored(wo) : border_.whitted(wo).mirror;
    return terms;
}

template <class Base>
float LayeredBsdf<Base>::density(Vec3 wo, Vec3 wi) const {
    const float in = 1 - border_.specular_reflection(wo);
    if (!layer_.is_cloudy())
        return border_.eval(wo, wi, mode).pdf + in * density_through(border_, base_, wo, wi);
    // Unscattered on the way down and up, or as if from a matte surface.
    const float clear = std::exp(-2 * layer_.thickness);
    return border_.eval(wo, wi, mode).pdf +
           in * lerp(clear, cosine_hemisphere_pdf(wi.z), density_through(border_, base_, wo, wi));
}

template class LayeredBsdf<DiffuseBsdf>;
template class LayeredBsdf<ConductorBsdf>;

} // namespace alhazen
