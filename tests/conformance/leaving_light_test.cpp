// Light that sets out from lights, for all that the registries document: it is drawn with the densities that
// are claimed, carries the light's power, and lights a small disk as light sampling says.
#include "image/codec.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"
#include "tests/support/glowing_shapes.h"
#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

using testing_support::chi_square_2d;
using testing_support::p_threshold;
using testing_support::random_pair;

constexpr double pi_d = 3.14159265358979323846;

void check_contract(const Light& light) {
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
        const float time = rng.uniform();
        auto s = light.sample_leaving(random_pair(rng), random_pair(rng), rgb_lanes, time);
        if (!s) continue;
        ASSERT_NEAR(length(s->ray.d), 1, 1e-5f);
        ASSERT_EQ(s->ray.time, time);
        ASSERT_TRUE(s->L.is_finite() && s->L.min() >= 0 && !s->L.is_black());
        ASSERT_TRUE(s->pdf_position > 0 && std::isfinite(s->pdf_position));
        ASSERT_TRUE(s->pdf_direction > 0 && std::isfinite(s->pdf_direction));
        LeavingPdf pdf = light.pdf_leaving(s->ng, s->ray.d);
        ASSERT_EQ(pdf.position, s->pdf_position);
        ASSERT_NEAR(pdf.direction / s->pdf_direction, 1, light.is_infinite() ? 1e-3f : 1e-5f);
        ASSERT_NEAR(s->cosine, s->ng == Vec3() ? 1 : abs_dot(s->ng, s->ray.d), 1e-6f);
        ASSERT_LT(length(s->ray.o - s->p), 1e-4f);
        if (light.is_far()) {
            // From outside, and through the scene's sphere.
            ASSERT_GT(length(s->ray.o), std::sqrt(48.0f));
            ASSERT_LT(length(cross(s->ray.o, s->ray.d)), std::sqrt(48.0f) * 1.0001f);
            ASSERT_LT(dot(s->ray.o, s->ray.d), 0);
        }
    }
}

/// Directions around the normal, or around the middle of what a point light shines into, as azimuth and
/// height.
void check_directions(const Light& light) {
    const auto bounds = light.bounds();
    const bool is_point = bounds && bounds->bounds.diagonal() == Vec3();
    // Area lights are asked in the frame of a normal along z.
    const Vec3 ng = bounds && !is_point ? Vec3(0, 0, 1) : Vec3();
    const Frame middle = is_point ? Frame::from_z(bounds->axis) : Frame();
    float widest = pi;
    if (is_point) widest = std::min(pi, std::acos(bounds->cos_normals) + std::acos(bounds->cos_falloff));
    Rng rng(3);
    auto sample = [&](Vec2 u) {
        auto s = light.sample_leaving(random_pair(rng), u, rgb_lanes, 0);
        if (!s) return Vec2(-100, 0);
        Vec3 w = (s->ng == Vec3() ? middle : Frame::from_z(s->ng)).to_local(s->ray.d);
        float phi = std::atan2(w.y, w.x);
        return Vec2(phi < 0 ? phi + 2 * pi : phi, w.z);
    };
    auto density = [&](Vec2 p) {
        float r = safe_sqrt(1 - p.y * p.y);
        Vec3 w = middle.to_world({r * std::cos(p.x), r * std::sin(p.x), p.y});
        return static_cast<double>(light.pdf_leaving(ng, w).direction);
    };
    const testing_support::Box2 box{0, 2 * pi_d, static_cast<double>(std::cos(widest)), 1};
    EXPECT_GT(chi_square_2d(sample, density, box, 50000, 16, 96), p_threshold);
}

void check_leaving_power(const Light& light) {
    Rng rng(4);
    constexpr int n = 50000;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        auto s = light.sample_leaving(random_pair(rng), random_pair(rng), rgb_lanes, 0);
        const double flux = s ? static_cast<double>(s->flux()[1]) : 0;
        sum += flux;
        squares += flux * flux;
    }
    const double mean = sum / n, error = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
    const auto power = static_cast<double>(light.power(rgb_lanes)[1]);
    EXPECT_NEAR(mean, power, 5 * error + 1e-4 * power);
}

/// What stands around an area light: its own shape.
bool is_free(const Shape* shape, const Ray& ray) {
    Intersection found;
    for (std::uint32_t i = 0; shape && i < shape->primitive_count(); ++i)
        if (shape->intersect(ray, i, found)) return false;
    return true;
}

struct Disk {
    Vec3 center, normal;
    float radius = 1.5f;
};

struct Measured {
    double mean = 0, variance = 0; ///< variance of the mean
};

Measured leaving_flux(const Light& light, const Disk& disk, const Shape* shape) {
    Rng rng(5);
    constexpr int n = 50000;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        auto s = light.sample_leaving(random_pair(rng), random_pair(rng), rgb_lanes, 0);
        if (!s || dot(s->ray.d, disk.normal) >= 0) continue;
        Ray ray = s->ray;
        ray.tmax = dot(disk.center - ray.o, disk.normal) / dot(ray.d, disk.normal);
        if (!(ray.tmax > 0) || length(ray.at(ray.tmax) - disk.center) > disk.radius || !is_free(shape, ray))
            continue;
        const auto flux = static_cast<double>(s->flux()[1] * (s->fades ? 1 : sqr(ray.tmax)));
        sum += flux;
        squares += flux * flux;
    }
    return {sum / n, squares / n / n};
}

Measured arriving_flux(const Light& light, const Disk& disk, const Shape* shape) {
    Rng rng(6);
    constexpr int n = 10000;
    const Frame frame = Frame::from_z(disk.normal);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const Vec2 d = sample_disk(random_pair(rng)) * disk.radius;
        Hit at;
        at.p = disk.center + frame.x * d.x + frame.y * d.y;
        at.ng = at.ns = disk.normal;
        auto s = light.sample({at.p, at.ns}, random_pair(rng), rgb_lanes);
        if (!s || !is_free(shape, at.spawn_to(s->p, s->p_error, s->ng))) continue;
        const float e = s->L[1] * std::max(0.0f, dot(s->wi, disk.normal)) / s->pdf;
        const double flux = static_cast<double>(e * pi * sqr(disk.radius));
        sum += flux;
        squares += flux * flux;
    }
    return {sum / n, squares / n / n};
}

/// The same flux onto a disk by light that leaves and by light sampling.
void check_disk(const Light& light, const Disk& disk, const Shape* shape = nullptr) {
    const Measured leaving = leaving_flux(light, disk, shape), arriving = arriving_flux(light, disk, shape);
    EXPECT_GT(leaving.mean, 0);
    // Five standard deviations: a false alarm in two million.
    EXPECT_NEAR(leaving.mean, arriving.mean,
                5 * std::sqrt(leaving.variance + arriving.variance) + 1e-4 * arriving.mean);
}

void check_light(const Light& light, const Disk& disk, const Shape* shape = nullptr) {
    check_contract(light);
    if (!light.is_far() || !light.is_delta()) check_directions(light);
    if (auto s = light.sample_leaving({0.5f, 0.5f}, {0.5f, 0.5f}, rgb_lanes, 0); s && s->fades)
        check_leaving_power(light);
    check_disk(light, disk, shape);
}

Image spotted(Vec2i size) {
    Image image = Image::rgb_image(size.x, size.y);
    Rng rng(11);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) image.set_rgb(x, y, Vec3(0.2f + 3 * rng.uniform(), 1, 0.5f));
    return image;
}

// Some light that leaves; of what comes through a window alone, not every pair of numbers gives one.
std::optional<LeavingLight> any_leaving(const Light& light) {
    Rng rng(12);
    for (int i = 0; i < 10000; ++i)
        if (auto s = light.sample_leaving(random_pair(rng), random_pair(rng), rgb_lanes, 0)) return s;
    return std::nullopt;
}

TEST(LeavingLight, EveryDocumentedLight) {
    const auto folder = std::filesystem::temp_directory_path() / "alhazen_conformance_leaving_light";
    std::filesystem::create_directories(folder);
    for (const char* name : {"sky.exr", "lamp.exr"}) write_image(folder / name, spotted({16, 16}));
    write_image(folder / "slide.png", spotted({24, 16}));
    // No light looks along the test's own axis, around which the edge of a beam cuts slivers off its cells.
    for (const Matrix4& world :
         {Matrix4::rotate(75, {1, 0.5, 0}), Matrix4::translate({1, 0, 2}) * Matrix4::rotate(40, {1, 2, 3})})
        for (const Kind<Light>& kind : light_kinds().all()) {
            const KindDoc doc = kind.doc();
            std::vector<Example> examples = doc.examples;
            if (std::none_of(doc.fields.begin(), doc.fields.end(),
                             [](const FieldDoc& f) { return f.is_required; }))
                examples.insert(examples.begin(), Example{"defaults", {}});
            for (const Example& example : examples) {
                SCOPED_TRACE(kind.name + ", " + example.name);
                auto light = make_light(kind.name, example.parameters, {ColorMode::rgb, world, folder});
                ASSERT_TRUE(light);
                light->prepare(wide_scene);
                auto from = any_leaving(*light);
                ASSERT_TRUE(from);
                // Lit by every light: where one arrives from, a disk faces it.
                const Disk disk{light->is_far() ? Vec3(0.5f, 1, 0) : from->ray.at(3), -from->ray.d};
                const bool has_window = std::any_of(example.parameters.begin(), example.parameters.end(),
                                                    [](const Parameter& p) { return p.name == "portal"; });
                if (has_window)
                    check_disk(*light, disk);
                else
                    check_light(*light, disk);
            }
        }
    std::filesystem::remove_all(folder);
}

// A spot whose space is stretched shines into a cone that is none.
TEST(LeavingLight, StretchedSpot) {
    auto light = make_light("spot", {make_float("coneangle", 60), make_float("conedeltaangle", 40)},
                            {ColorMode::rgb, Matrix4::rotate(30, {1, 1, 0}) * Matrix4::scale({3, 1, 0.5})});
    ASSERT_TRUE(light);
    auto from = light->sample_leaving({}, {0.3f, 0.1f}, rgb_lanes, 0);
    ASSERT_TRUE(from);
    check_contract(*light);
    check_directions(*light);
    check_disk(*light, {from->ray.at(3), -from->ray.d});
}

TEST(LeavingLight, EnvironmentImage) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_leaving_light";
    std::filesystem::create_directories(folder);
    Image image = Image::rgb_image(16, 8);
    Rng rng(9);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            image.set_rgb(
                x, y, Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * (x == 3 && y == 3 ? 50.0f : 1.0f));
    write_image(folder / "sky.pfm", image);
    auto light = make_light("infinite", {make_string("filename", "sky.pfm")},
                            {ColorMode::rgb, Matrix4::rotate(40, {1, 2, 3}), folder});
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(light);
    light->prepare(wide_scene);
    check_light(*light, {{0.5f, 1, 0}, normalize(Vec3(1, 1, 1))});
}

TEST(LeavingLight, FarLightOfASceneWithoutExtentDoesNotLeave) {
    for (const char* kind : {"distant", "infinite"}) {
        auto light = make_light(kind, {});
        light->prepare({{1, 1, 1}, {1, 1, 1}});
        EXPECT_FALSE(light->sample_leaving({0.5f, 0.5f}, {0.5f, 0.5f}, rgb_lanes, 0));
    }
}

TEST(LeavingLight, EveryDocumentedAreaLightOnEveryShape) {
    int number = 0;
    for (const GlowingShape& glowing : shapes_to_light()) {
        ASSERT_NE(glowing.shape, nullptr);
        ++number;
        for (const Kind<AreaLight>& kind : area_light_kinds().all())
            for (const Example& example : kind.doc().examples) {
                SCOPED_TRACE(kind.name + ", " + example.name + ", shape " + std::to_string(number));
                auto description = make_area_light(example.parameters);
                ASSERT_TRUE(description);
                auto light = description->attach(*glowing.shape, 0);
                auto from = light->sample_leaving({0.4f, 0.3f}, {0.2f, 0.2f}, rgb_lanes, 0);
                ASSERT_TRUE(from);
                check_light(*light, {from->p + from->ng * 3.0f, -from->ng}, glowing.shape.get());
            }
    }
}

} // namespace
} // namespace alhazen
