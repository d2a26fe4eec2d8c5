#include "raster/local_lights.h"

#include <unordered_set>

namespace alhazen {

namespace {

/// Samples a side of the grid with which a light that surrounds the scene is measured.
constexpr int sky_samples = 64;
/// How much longer the sum of a mesh's area vectors must be than that of something round for it to be flat.
constexpr float flatness = 0.5f;

const Wavelengths rgb = Wavelengths::rgb();

// What leaves the middle of a primitive to the side of the unit vector w.
Spectrum emitted_towards(const Light& light, const ShapeSample& middle, Vec3 w) {
    Hit hit;
    hit.p = middle.p;
    hit.ng = hit.ns = middle.ng;
    hit.uv = middle.uv;
    hit.wo = w;
    return light.emitted(hit, rgb);
}

} // namespace

LocalLight::LocalLight(const Light& light) : light_(&light) {
    auto bounds = light.bounds();
    if (bounds) {
        p_ = bounds->bounds.centroid();
        return;
    }
    kind_ = Kind::distant;
    if (auto sample = light.sample({Vec3{}, Vec3{}}, {0.5f, 0.5f}, rgb)) {
        normal_ = sample->wi;
        radiance_ = sample->L / sample->pdf;
    }
}

LocalLight::LocalLight(const PlacedShape& placed, const Light& example) {
    const Shape& shape = *placed.shape;
    Vec3d centre, vector;
    double area = 0;
    bool bends = false;
    Spectrum sum = 0, back = 0;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i) {
        if (!placed.lights[i]) continue;
        const ShapeSample middle = shape.sample(i, {0.5f, 0.5f});
        const double a = static_cast<double>(shape.area(i));
        const bool is_flat = shape.normals(i).cosine > 0.9f;
        bends |= !is_flat;
        centre += Vec3d(is_flat ? middle.p : shape.bounds(i).centroid()) * a;
        if (is_flat) vector += Vec3d(middle.ng) * a;
        area += a;
        sum += emitted_towards(*placed.lights[i], middle, middle.ng) * static_cast<float>(a);
        back += emitted_towards(*placed.lights[i], middle, -middle.ng) * static_cast<float>(a);
    }
    if (!(area > 0)) return;
    light_ = &example;
    shape_ = &placed;
    p_ = Vec3(centre * (1 / area));
    is_two_sided_ = !back.is_black();
    radiance_ = sum / static_cast<float>(area);
    const auto facing = static_cast<float>(length(vector));
    if (!bends && facing > flatness * static_cast<float>(area)) {
        kind_ = Kind::flat;
        area_ = facing;
        normal_ = Vec3(normalize(vector));
    } else {
        // A convex body shows a quarter of its surface, on average (Cauchy 1832).
        kind_ = Kind::round;
        area_ = static_cast<float>(area) / 4;
    }
}

LocalLight::Cone LocalLight::cone() const {
    if (kind_ == Kind::flat) return {normal_, is_two_sided_ ? pi : pi / 2};
    if (kind_ != Kind::asked || !light_) return {};
    auto bounds = light_->bounds();
    if (!bounds) return {};
    const float angle = std::acos(std::clamp(bounds->cos_normals, -1.0f, 1.0f)) +
                        std::acos(std::clamp(bounds->cos_falloff, -1.0f, 1.0f));
    return {bounds->axis, std::min(angle, pi)};
}

std::optional<ArrivingLight> LocalLight::at(Vec3 p) const {
    if (kind_ == Kind::distant) return ArrivingLight{normal_, radiance_};
    if (kind_ == Kind::asked) {
        if (!light_) return std::nullopt;
        auto sample = light_->sample({p, Vec3{}}, {0.5f, 0.5f}, rgb);
        if (!sample || !(sample->pdf > 0)) return std::nullopt;
        return ArrivingLight{sample->wi, sample->L / sample->pdf};
    }
    const Vec3 d = p_ - p;
    const float d2 = length_squared(d);
    if (!(d2 > 0)) return std::nullopt;
    const Vec3 wi = d / std::sqrt(d2);
    float cosine = 1;
    if (kind_ == Kind::flat) {
        cosine = -dot(wi, normal_);
        if (is_two_sided_) cosine = std::abs(cosine);
        if (!(cosine > 0)) return std::nullopt;
    }
    return ArrivingLight{wi, radiance_ * (cosine * area_ / (d2 + area_ * inv_pi))};
}

LocalLights::LocalLights(const Scene& scene) {
    std::unordered_set<const Light*> of_shapes;
    for (const PlacedShape& placed : scene.root().shapes()) {
        const Light* example = nullptr;
        for (const Light* light : placed.lights)
            if (light) {
                of_shapes.insert(light);
                example = light;
            }
        if (example) lights.emplace_back(placed, *example);
    }
    for (const Light* light : scene.lights()) {
        if (of_shapes.contains(light)) continue;
        if (!light->is_infinite() || light->is_delta()) {
            lights.emplace_back(*light);
            continue;
        }
        infinite.push_back(light);
        constexpr float cell = 1.0f / sky_samples;
        for (int j = 0; j < sky_samples; ++j)
            for (int i = 0; i < sky_samples; ++i) {
                const Vec2 u{(static_cast<float>(i) + 0.5f) * cell, (static_cast<float>(j) + 0.5f) * cell};
                auto sample = light->sample(
                    {scene.bounds().empty() ? Vec3{} : scene.bounds().centroid(), Vec3{}}, u, rgb);
                if (sample && sample->pdf > 0)
                    surroundings.add(sample->wi, sample->L, cell * cell / sample->pdf);
            }
    }
}

Spectrum LocalLights::background(Vec3 origin, Vec3 direction) const {
    Spectrum sum = 0;
    for (const Light* light : infinite) sum += light->escaped(origin, direction, rgb);
    return sum;
}

} // namespace alhazen
