#include "raster/shadow_map.h"

#include "raster/rasterizer.h"

namespace alhazen {

namespace {

/// All maps together, bytes; beyond, they get coarser.
constexpr std::size_t most_bytes = std::size_t{1} << 30;
/// Lights within a narrower cone than this (radians, half of it) need one map.
constexpr float one_map_angle = 1.2f;

} // namespace

ShadowCamera::ShadowCamera(Vec3 from, const Frame& frame, float half_size, int resolution,
                           bool is_perspective)
    : from_(from), x_(frame.x), y_(frame.y), z_(frame.z), half_size_(static_cast<double>(half_size)),
      step_(2 * half_size_ / resolution) {
    const double scale = 1 / step_, middle = resolution / 2.0;
    projection_.is_perspective = is_perspective;
    auto& m = projection_.film_from_world.m;
    auto set_row = [&](std::size_t row, Vec3d along, double offset) {
        m[row] = {along.x, along.y, along.z, offset - dot(along, from_)};
    };
    if (is_perspective) {
        set_row(0, x_ * scale + z_ * middle, 0);
        set_row(1, y_ * scale + z_ * middle, 0);
        set_row(3, z_, 0);
    } else {
        set_row(0, x_ * scale, middle);
        set_row(1, y_ * scale, middle);
        m[3] = {0, 0, 0, 1};
    }
    set_row(2, z_, 0);
}

std::optional<CameraRay> ShadowCamera::ray(const CameraSample& sample) const {
    const Vec3d across = x_ * (static_cast<double>(sample.film.x) * step_ - half_size_) +
                         y_ * (static_cast<double>(sample.film.y) * step_ - half_size_);
    if (projection_.is_perspective) return CameraRay{{Vec3(from_), Vec3(normalize(across + z_))}, 1};
    return CameraRay{{Vec3(from_ + across), Vec3(z_)}, 1};
}

ShadowMaps::ShadowMaps(const Scene& scene, const LocalLights& lights, const ShadowMapOptions& options)
    : resolution_(options.resolution), radius_(options.radius) {
    auto bytes = [&] {
        return 6 * sizeof(float) * lights.lights.size() * static_cast<std::size_t>(resolution_) *
               static_cast<std::size_t>(resolution_);
    };
    while (resolution_ > 64 && bytes() > most_bytes) resolution_ /= 2;
    for (const LocalLight& light : lights.lights) lights_.push_back(draw_light(scene, light));
}

ShadowMaps::Map ShadowMaps::draw(const Scene& scene, const LocalLight& light, Vec3 from, const Frame& frame,
                                 float half_size, bool is_perspective) const {
    // A border of texels for the filter.
    const float wider =
        half_size * (1 + 2 * static_cast<float>(radius_ + 2) / static_cast<float>(resolution_));
    const ShadowCamera camera(from, frame, wider, resolution_, is_perspective);
    Map map;
    map.projection = *camera.projection();
    map.texel = 2 * wider / static_cast<float>(resolution_);
    map.nearness.resize(static_cast<std::size_t>(resolution_) * static_cast<std::size_t>(resolution_));
    Rasterizer rasterizer(scene, camera, 1);
    rasterizer.leave_out(light.shape());
    rasterizer.run({{0, 0}, {resolution_, resolution_}}, [&](const DrawnTile& tile) {
        for (int y = tile.pixels().lo.y; y < tile.pixels().hi.y; ++y)
            for (int x = tile.pixels().lo.x; x < tile.pixels().hi.x; ++x)
                map.nearness[static_cast<std::size_t>(y) * static_cast<std::size_t>(resolution_) +
                             static_cast<std::size_t>(x)] = tile.nearness({x, y}, 0);
    });
    return map;
}

ShadowMaps::LightMaps ShadowMaps::draw_light(const Scene& scene, const LocalLight& light) const {
    LightMaps all;
    if (light.kind() == LocalLight::Kind::distant) {
        const Sphere3 sphere = bounding_sphere(scene.bounds());
        const Vec3 from = sphere.center + light.direction() * (1.01f * sphere.radius);
        all.maps.push_back(draw(scene, light, from, Frame::from_z(-light.direction()), sphere.radius, false));
        return all;
    }
    const LocalLight::Cone cone = light.cone();
    const Frame frame = Frame::from_z(cone.axis);
    if (cone.angle < one_map_angle) {
        all.maps.push_back(draw(scene, light, light.position(), frame, std::tan(cone.angle), true));
        return all;
    }
    // The faces of a cube around the axis; the last looks back.
    const Vec3 x = frame.x, y = frame.y, z = frame.z;
    const std::array<Frame, 6> faces{Frame{x, y, z}, Frame{y, z, x},  Frame{z, y, -x},
                                     Frame{z, x, y}, Frame{x, z, -y}, Frame{y, x, -z}};
    const std::size_t count = cone.angle <= pi / 2 + 0.01f ? 5 : 6;
    for (std::size_t i = 0; i < count; ++i)
        all.maps.push_back(draw(scene, light, light.position(), faces[i], 1, true));
    return all;
}

float ShadowMaps::lit(Vec3 p, Vec3 ng, std::size_t light, Vec3 wi) const {
    for (const Map& map : lights_[light].maps) {
        bool is_inside = false;
        const float part = lit(map, p, ng, wi, is_inside);
        if (is_inside) return part;
    }
    return 1;
}

float ShadowMaps::lit(const Map& map, Vec3 point, Vec3 ng, Vec3 wi, bool& is_inside) const {
    const auto& m = map.projection.film_from_world.m;
    auto row = [&](std::size_t i, Vec3 p) {
        return static_cast<float>(m[i][0] * static_cast<double>(p.x) + m[i][1] * static_cast<double>(p.y) +
                                  m[i][2] * static_cast<double>(p.z) + m[i][3]);
    };
    const float depth = row(2, point);
    if (!(depth > 0)) return 1;
    const bool is_perspective = map.projection.is_perspective;
    const float texel = map.texel * (is_perspective ? depth : 1.0f);
    // A texel shows one depth of a surface that runs through many. The point is moved off its surface by how
    // far the filter reaches over it, so that the surface does not shade itself.
    const Vec3 n = face_forward(ng, wi);
    const float cosine = std::abs(dot(n, wi)), sine = safe_sqrt(1 - cosine * cosine);
    const float reach = texel * (static_cast<float>(radius_) + 1);
    const Vec3 p = point + n * (1.5f * reach * sine) + wi * texel;
    const float w = row(3, p), x = row(0, p) / w, y = row(1, p) / w;
    const auto border = static_cast<float>(radius_), end = static_cast<float>(resolution_) - border;
    is_inside = row(2, p) > 0 && x >= border && x < end && y >= border && y < end;
    if (!is_inside) return 1;
    const float q = is_perspective ? 1 / w : -row(2, p);
    const int cx = static_cast<int>(x), cy = static_cast<int>(y);
    int open = 0;
    for (int dy = -radius_; dy <= radius_; ++dy)
        for (int dx = -radius_; dx <= radius_; ++dx)
            open += map.nearness[static_cast<std::size_t>(cy + dy) * static_cast<std::size_t>(resolution_) +
                                 static_cast<std::size_t>(cx + dx)] <= q;
    const int side = 2 * radius_ + 1;
    return static_cast<float>(open) / static_cast<float>(side * side);
}

} // namespace alhazen
