#include "materials/relief.h"

#include <fmt/format.h>

#include "image/codec.h"
#include "image/encoding.h"
#include "textures/parameter_step.h"

namespace alhazen {

namespace {

// Over what change of a parameter heights are compared: half a pixel (Pharr et al. 2023, section 10.5.3);
// where rays have no footprint, as pbrt-v4. Never so little that the rounding of the point, or of the
// parameter, shows in slopes.
float step_along(Vec3 p, Vec3 tangent, float half_pixel) {
    if (!(half_pixel > 0)) return 0.0005f;
    constexpr float rounding = 1.5e-5f;
    const float size = length(tangent);
    const float least = size > 0 ? rounding * std::max(1.0f, length(p) / size) : rounding;
    return std::max(half_pixel, std::min(least, 0.0005f));
}

// The surface's tangents once it is raised by the height along its normal. The last term says that on a
// curved surface the raised one is wider or narrower.
struct Tangents {
    Vec3 dpdu, dpdv;
};
Tangents raised(const Hit& hit, const NormalChange& change, const FloatTexture& height) {
    const TexturePoint here(hit);
    const float h = height.eval(here);
    const Vec2 half = half_pixel(hit);
    auto slope = [&](Vec3 tangent, Vec2 along, float half_along) {
        const float step = step_along(hit.p, tangent, half_along);
        // The texture is blurred there as it is here.
        TexturePoint beside = here;
        beside.p = here.p + tangent * step;
        beside.uv = here.uv + along * step;
        return (height.eval(beside) - h) / step;
    };
    return {hit.dpdu + hit.ns * slope(hit.dpdu, {1, 0}, half.x) + change.dndu * h,
            hit.dpdv + hit.ns * slope(hit.dpdv, {0, 1}, half.y) + change.dndv * h};
}

Tangents across(Vec3 n, const Hit& hit) {
    const Vec3 u = hit.dpdu - n * dot(n, hit.dpdu);
    if (!(length_squared(u) > 0)) {
        const Frame frame = Frame::from_z(n);
        return {frame.x * length(hit.dpdu), frame.y * length(hit.dpdv)};
    }
    return {normalize(u) * length(hit.dpdu), normalize(cross(n, u)) * length(hit.dpdv)};
}

} // namespace

NormalMap::NormalMap(const std::filesystem::path& path) {
    const Image image = read_image(path, {Encoding::linear()});
    if (image.channels() < 3) throw std::runtime_error("the image is grey; a normal map has three channels");
    Pyramid<Vec3>::Level level{image.size(), {}};
    level.texels.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) level.texels.push_back(image.rgb(x, y) * 2 - Vec3(1));
    normals_ = std::make_shared<Pyramid<Vec3>>(std::vector{std::move(level)}, WrapMode::repeat);
}

Vec3 NormalMap::at(Vec2 uv) const {
    const Vec3 n = normals_->bilinear(0, {uv.x, 1 - uv.y});
    const float size = length(n);
    return size > 0 && std::isfinite(size) ? n / size : Vec3(0, 0, 1);
}

void FieldType<NormalMap>::read(NormalMap& out, const Parameter& p, BuildContext& context) {
    std::string filename;
    FieldType<std::string>::read(filename, p, context);
    if (filename.empty()) return; // none, or told already
    const std::filesystem::path path = context.resolve(filename);
    try {
        out = NormalMap(path);
    } catch (const std::exception& e) {
        context.messages.add_error(p.place, fmt::format("normal map \"{}\": {}", path.string(), e.what()));
    }
}

void Relief::apply(Hit& hit, const NormalChange& change) const {
    Tangents tangents;
    if (normalmap.empty())
        tangents = raised(hit, change, displacement);
    else
        tangents = across(hit.shading_frame().to_world(normalmap.at(hit.uv)), hit);
    const Vec3 n = cross(tangents.dpdu, tangents.dpdv);
    const float size = length(n);
    // Without tangents, or with heights that are no numbers, the surface stays smooth.
    if (!(size > 0) || !std::isfinite(size)) return;
    hit.ns = face_forward(n / size, hit.ng);
    hit.dpdu = tangents.dpdu;
    hit.dpdv = tangents.dpdv;
}

} // namespace alhazen
