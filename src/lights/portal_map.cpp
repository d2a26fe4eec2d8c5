#include "lights/portal_map.h"

#include "base/threads.h"

namespace alhazen {

bool is_rectangle(const PortalCorners& c) {
    constexpr float tolerance = 1e-3f;
    const Vec3 sides[] = {c[1] - c[0], c[2] - c[1], c[2] - c[3], c[3] - c[0]};
    Vec3 unit[4];
    for (int i = 0; i < 4; ++i) {
        const float l = length(sides[i]);
        if (!(l > 0) || !std::isfinite(l)) return false;
        unit[i] = sides[i] / l;
    }
    return std::abs(dot(unit[0], unit[2]) - 1) <= tolerance &&
           std::abs(dot(unit[1], unit[3]) - 1) <= tolerance && std::abs(dot(unit[0], unit[3])) <= tolerance &&
           std::abs(dot(unit[0], unit[1])) <= tolerance;
}

PortalMap::PortalMap(const PortalCorners& corners, int resolution, const std::function<Vec3(Vec3)>& sky,
                     const RgbColorSpace& space, ColorMode mode)
    : lo_(corners[0]), hi_(corners[2]) {
    const Vec3 x = corners[3] - corners[0], y = corners[1] - corners[0];
    frame_ = Frame::from_z_and_tangent(normalize(cross(x, y)), x);
    const auto n = static_cast<std::size_t>(resolution);
    Image image = Image::rgb_image(resolution, resolution);
    image.info.metadata["color_space"] = space.name;
    std::vector<float> weights(n * n);
    const float cell = 1 / static_cast<float>(resolution);
    Vec3d sum;
    for (int j = 0; j < resolution; ++j)
        for (int i = 0; i < resolution; ++i) {
            const Vec3 w =
                direction({(static_cast<float>(i) + 0.5f) * cell, (static_cast<float>(j) + 0.5f) * cell});
            const Vec3 rgb = max(sky(w), Vec3(0));
            image.set_rgb(i, j, rgb);
            const float omega = stretch(w);
            weights[static_cast<std::size_t>(j) * n + static_cast<std::size_t>(i)] =
                (rgb.x + rgb.y + rgb.z) / 3 * omega;
            sum += Vec3d(rgb * (omega * dot(w, frame_.z)));
        }
    texels_.emplace(image, mode);
    distribution_.emplace(weights, resolution, resolution);
    flux_ =
        convert_rgb(space, srgb_space()) * Vec3(sum / static_cast<double>(n * n)) * (length(x) * length(y));
}

// The angles of the direction about the window's sides, each from -90 to 90 degrees over the unit interval.
Vec3 PortalMap::direction(Vec2 uv) const {
    const float a = pi * (uv.x - 0.5f), b = pi * (uv.y - 0.5f);
    // (tan a, tan b, 1), times both cosines so that it stays finite.
    return frame_.to_world(
        normalize(Vec3(std::sin(a) * std::cos(b), std::cos(a) * std::sin(b), std::cos(a) * std::cos(b))));
}

std::optional<Vec2> PortalMap::place_of(Vec3 w) const {
    const Vec3 v = frame_.to_local(w);
    if (!(v.z > 0)) return std::nullopt;
    return Vec2{std::clamp(std::atan2(v.x, v.z) * inv_pi + 0.5f, 0.0f, 1.0f),
                std::clamp(std::atan2(v.y, v.z) * inv_pi + 0.5f, 0.0f, 1.0f)};
}

// Of the plane z = 1, (1 + x^2 + y^2)^(-3/2) is solid angle over area, and pi (1 + x^2) is dx over du.
float PortalMap::stretch(Vec3 w) const {
    const Vec3 v = frame_.to_local(w);
    return sqr(pi) * (1 - sqr(v.x)) * (1 - sqr(v.y)) / v.z;
}

std::optional<PortalMap::Window> PortalMap::window_from(Vec3 p) const {
    auto a = place_of(lo_ - p), b = place_of(hi_ - p);
    if (!a || !b) return std::nullopt;
    return Window{{std::min(a->x, b->x), std::min(a->y, b->y)}, {std::max(a->x, b->x), std::max(a->y, b->y)}};
}

std::optional<PortalMap::Sample> PortalMap::sample(Vec3 p, Vec2 u) const {
    auto window = window_from(p);
    if (!window) return std::nullopt;
    auto drawn = distribution_->sample(u, *window);
    if (!drawn) return std::nullopt;
    const Vec3 w = direction(drawn->p);
    const float omega = stretch(w);
    if (!(omega > 0) || !std::isfinite(omega)) return std::nullopt;
    return Sample{w, drawn->pdf / omega, drawn->cell};
}

float PortalMap::pdf(Vec3 p, Vec3 w) const {
    auto window = window_from(p);
    auto place = place_of(w);
    if (!window || !place) return 0;
    const float omega = stretch(w);
    return omega > 0 ? distribution_->pdf(*place, *window) / omega : 0;
}

std::optional<Vec2i> PortalMap::texel_seen(Vec3 p, Vec3 w) const {
    auto window = window_from(p);
    auto place = place_of(w);
    if (!window || !place || !window->contains(*place)) return std::nullopt;
    return texels_->nearest(*place);
}

} // namespace alhazen
