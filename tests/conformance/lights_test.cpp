/// What every light owes the integrators, whatever its kind: checked for all that the registries document.
#include "image/codec.h"
#include "lights/light_chooser.h"
#include "tests/support/area_density.h"
#include "tests/support/density_test.h"
#include "tests/support/family.h"
#include "tests/support/glowing_shapes.h"
#include "tests/support/light_probe.h"

namespace alhazen {
namespace {

using testing_support::p_threshold;
using testing_support::random_pair;

LightReceiver random_receiver(Rng& rng) {
    Vec3 p = Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * 8.0f - Vec3(4);
    return {p, sample_sphere(random_pair(rng))};
}
Vec3 color_of_power(const Light& light, ColorMode mode) {
    return film_color(mode, [&](const Wavelengths& lambda) { return light.power(lambda); });
}

// Both modes' lights of one description.
using TwoModes = std::array<std::unique_ptr<Light>, 2>;

void check_sample(const Light& light, const LightReceiver& at, const LightSample& s) {
    ASSERT_NEAR(length(s.wi), 1, 1e-5f);
    ASSERT_TRUE(s.L.is_finite() && s.L.min() >= 0 && !s.L.is_black());
    ASSERT_TRUE(s.pdf > 0 && std::isfinite(s.pdf));
    ASSERT_GT(dot(normalize(s.p - at.p), s.wi), 1 - 1e-5f);
    ASSERT_TRUE(!light.is_delta() || s.pdf == 1);
    if (auto b = light.bounds()) {
        Bounds3 box = b->bounds;
        box.lo -= s.p_error + Vec3(1e-5f);
        box.hi += s.p_error + Vec3(1e-5f);
        ASSERT_TRUE(box.contains(s.p));
    } else {
        ASSERT_FALSE(wide_scene.contains(s.p));
        ASSERT_EQ(s.ng, Vec3());
    }
}

void check_contract(const Light& light, const Wavelengths& lambda) {
    const Light* all[] = {&light};
    Rng rng(1);
    for (const std::string& name : light_chooser_names()) {
        auto chooser = make_light_chooser(name, all);
        for (int i = 0; i < 200; ++i) {
            LightReceiver at = random_receiver(rng);
            auto s = light.sample(at, random_pair(rng), lambda);
            if (!s) continue;
            check_sample(light, at, *s);
            ASSERT_GT(chooser->probability(at, &light), 0) << name;
        }
    }
    ASSERT_FALSE(light.is_delta() && light.is_infinite());
    if (!light.is_infinite()) {
        EXPECT_TRUE(light.escaped({}, {0, 0, 1}, lambda).is_black());
        EXPECT_EQ(light.pdf_escaped({}, {0, 0, 1}), 0);
    }
    ASSERT_TRUE(light.power(lambda).is_finite() && light.power(lambda).min() >= 0);
    EXPECT_EQ(light.bounds() ? light.bounds()->power > 0 : !light.power(rgb_lanes).is_black(), true);
}

// Infinite lights: what is sampled is what escaping rays see, and as often as claimed. Those that are seen
// through a portal have edges that the grid of the chi-square test does not follow.
void check_escaped(const Light& light, const Wavelengths& lambda, bool has_edges) {
    Rng rng(2);
    int misplaced = 0; // on the edge of a texel a direction may be rounded into the next one
    for (int i = 0; i < 5000; ++i) {
        auto s = light.sample({}, random_pair(rng), lambda);
        if (!s) continue;
        bool same = light.escaped({}, s->wi, lambda) == s->L &&
                    std::abs(light.pdf_escaped({}, s->wi) - s->pdf) <= 1e-3f * s->pdf;
        misplaced += !same;
    }
    EXPECT_LE(misplaced, 10);
    if (has_edges) return;
    auto direction = [](Vec2 p) {
        float r = safe_sqrt(1 - p.y * p.y);
        return Vec3{r * std::cos(p.x), r * std::sin(p.x), p.y};
    };
    // Azimuth and height z: an area of the cylinder is the solid angle.
    auto sample = [&](Vec2 u) {
        auto s = light.sample({}, u, lambda);
        if (!s) return Vec2{-100, 0};
        float phi = std::atan2(s->wi.y, s->wi.x);
        return Vec2{phi < 0 ? phi + 2 * pi : phi, s->wi.z};
    };
    auto density = [&](Vec2 p) { return static_cast<double>(light.pdf_escaped({}, direction(p))); };
    EXPECT_GT(testing_support::chi_square_2d(sample, density, {0, 2 * static_cast<double>(pi), -1, 1}, 100000,
                                             16, 32),
              p_threshold);
}

// The flux through a sphere around the light, or that of escaping rays through the scene's sphere.
void check_power(const Light& light) {
    auto power = static_cast<double>(light.power(rgb_lanes)[0]);
    auto bounds = light.bounds();
    if (bounds) {
        bool is_point = bounds->bounds.diagonal() == Vec3();
        double flux = is_point ? flux_through_sphere(light, bounds->bounds.lo, 1, rgb_lanes, 400, 1)
                               : flux_through_sphere(light, bounds->bounds.centroid(), 20, rgb_lanes, 60, 8);
        EXPECT_NEAR(flux / power, 1, 0.02);
        return;
    }
    // The disk seen from each direction has an area of 48 pi.
    double sum = 0;
    constexpr int side = 256;
    if (light.is_delta()) {
        sum = static_cast<double>(light.sample({}, {}, rgb_lanes)->L[0]);
    } else {
        for (int i = 0; i < side * side; ++i) {
            Vec3 d = sample_sphere(
                {(static_cast<float>(i % side) + 0.5f) / side, (static_cast<float>(i / side) + 0.5f) / side});
            sum += static_cast<double>(light.escaped({}, d, rgb_lanes)[0]) * 4 * static_cast<double>(pi) /
                   (side * side);
        }
    }
    EXPECT_NEAR(sum * 48 * static_cast<double>(pi) / power, 1, 0.01);
}

void check_light(const TwoModes& lights, bool has_portal = false) {
    for (std::size_t i = 0; i < 2; ++i) {
        const Wavelengths lambda =
            both_modes[i] == ColorMode::rgb ? rgb_lanes : Wavelengths::sample_visible(0.3f);
        lights[i]->prepare(wide_scene);
        check_contract(*lights[i], lambda);
        if (lights[i]->is_infinite()) check_escaped(*lights[i], lambda, has_portal);
    }
    // What comes through a portal differs from place to place.
    if (!has_portal) check_power(*lights[0]);
    expect_color(color_of_power(*lights[1], ColorMode::spectral), color_of_power(*lights[0], ColorMode::rgb),
                 0.01f);
}

bool has(const Example& example, std::string_view parameter) {
    return std::any_of(example.parameters.begin(), example.parameters.end(),
                       [&](const Parameter& p) { return p.name == parameter; });
}

// Every pixel another colour, one fifty times as bright.
Image speckled_image(Vec2i size) {
    Image image = Image::rgb_image(size.x, size.y);
    Rng rng(9);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            image.set_rgb(
                x, y, Vec3(rng.uniform(), rng.uniform(), rng.uniform()) * (x == 3 && y == 3 ? 50.0f : 1.0f));
    return image;
}

// The kind's examples, and what it is without parameters unless it needs some.
std::vector<Example> examples_of(const KindDoc& doc) {
    std::vector<Example> examples = doc.examples;
    if (std::none_of(doc.fields.begin(), doc.fields.end(), [](const FieldDoc& f) { return f.is_required; }))
        examples.insert(examples.begin(), Example{"defaults", {}});
    return examples;
}

TEST(LightConformance, EveryDocumentedLight) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_conformance_documented_lights";
    std::filesystem::create_directories(folder);
    for (const char* name : {"sky.exr", "lamp.exr"}) write_image(folder / name, speckled_image({16, 16}));
    write_image(folder / "slide.png", speckled_image({24, 16}));
    for (const Matrix4& world : {Matrix4{}, Matrix4::translate({1, 0, 2}) * Matrix4::rotate(40, {1, 2, 3})})
        for (const Kind<Light>& kind : light_kinds().all()) {
            for (const Example& example : examples_of(kind.doc())) {
                SCOPED_TRACE(kind.name + ", " + example.name);
                TwoModes lights;
                for (std::size_t i = 0; i < 2; ++i)
                    lights[i] = make_light(kind.name, example.parameters, {both_modes[i], world, folder});
                ASSERT_TRUE(lights[0] && lights[1]);
                check_light(lights, has(example, "portal"));
            }
        }
    std::filesystem::remove_all(folder);
}

TEST(LightConformance, EnvironmentImagesOfBothMappings) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen_conformance_lights";
    std::filesystem::create_directories(folder);
    for (Vec2i size : {Vec2i{16, 16}, Vec2i{16, 8}}) {
        write_image(folder / "sky.pfm", speckled_image(size));
        TwoModes lights;
        for (std::size_t i = 0; i < 2; ++i)
            lights[i] = make_light("infinite", {make_string("filename", "sky.pfm")},
                                   {both_modes[i], Matrix4::rotate(40, {1, 2, 3}), folder});
        ASSERT_TRUE(lights[0] && lights[1]);
        check_light(lights);
    }
    std::filesystem::remove_all(folder);
}

// The nearest point of the shape along the ray.
std::optional<Hit> trace(const Shape& shape, Ray ray) {
    std::optional<Hit> nearest;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i) {
        Intersection found;
        if (!shape.intersect(ray, i, found)) continue;
        nearest = shape.surface(ray, i, found);
        nearest->primitive = i;
        ray.tmax = found.t;
    }
    return nearest;
}

std::vector<std::unique_ptr<Light>> attach_all(const AreaLight& description, const Shape& shape) {
    std::vector<std::unique_ptr<Light>> lights;
    for (std::uint32_t i = 0; i < shape.primitive_count(); ++i)
        lights.push_back(description.attach(shape, i));
    return lights;
}

struct Tally {
    double sum = 0, squares = 0;
    void add(double v) {
        sum += v;
        squares += v * v;
    }
};

// Whether a ray sees what was sampled: as bright, and chosen as often.
bool is_seen_alike(const GlowingShape& glowing, const Light& light, const LightReceiver& at,
                   const LightSample& s, const Hit& hit) {
    float pdf = light.pdf_hit(at, hit, s.wi);
    if (!(light.emitted(hit, rgb_lanes) == s.L)) return false;
    if (!glowing.curvature) return std::abs(pdf - s.pdf) <= 1e-5f * s.pdf;
    return testing_support::same_density({s.p, s.p_error, s.pdf}, {hit.p, hit.p_error, pdf}, at.p,
                                         glowing.shape->area(hit.primitive), *glowing.curvature);
}

// Adds what a sample of the primitive's light gives when nothing hides it; counts those that rays see
// otherwise.
void tally_sample(const GlowingShape& glowing, std::uint32_t primitive, const Light& light,
                  const LightReceiver& at, Vec2 u, Tally& tally, int& unlike) {
    auto s = light.sample(at, u, rgb_lanes);
    if (!s || dot(s->wi, at.ns) <= 0) return;
    auto hit = trace(*glowing.shape, {at.p, s->wi, infinity, 0});
    float far = hit ? length(hit->p - s->p) : infinity;
    if (far > 1e-3f * length(s->p - at.p)) return; // in the shadow of another part
    // Just behind the edge of a round shape is near what hides it, too.
    if (dot(hit->ng, s->wi) * dot(s->ng, s->wi) < 0) return;
    // On the border between two primitives the ray may meet either.
    unlike += hit->primitive == primitive && !is_seen_alike(glowing, light, at, *s, *hit);
    tally.add(static_cast<double>(s->L[0] * dot(s->wi, at.ns) / s->pdf));
}

// Sampling the lights, with shadow rays, against looking into all directions.
void compare_with_brute_force(const GlowingShape& glowing,
                              const std::vector<std::unique_ptr<Light>>& lights) {
    const Shape& shape = *glowing.shape;
    Rng rng(4);
    Vec3 middle = shape.bounds(0).centroid();
    for (int k = 0; k < 3; ++k) {
        Vec3 away = sample_sphere(random_pair(rng));
        LightReceiver at{middle + away * (2 + rng.uniform()), {}};
        at.ns = normalize(sample_sphere(random_pair(rng)) * 0.5f - away);
        Tally sampled, looked;
        int unlike = 0;
        constexpr int side = 100;
        for (int i = 0; i < side * side; ++i) {
            Vec2 u{(static_cast<float>(i % side) + rng.uniform()) / side,
                   (static_cast<float>(i / side) + rng.uniform()) / side};
            Vec3 d = Frame::from_z(at.ns).to_world(sample_cosine_hemisphere(u));
            if (auto hit = trace(shape, {at.p, d, infinity, 0}))
                looked.add(static_cast<double>(lights[hit->primitive]->emitted(*hit, rgb_lanes)[0] * pi));
            for (std::uint32_t p = 0; p < lights.size(); ++p)
                tally_sample(glowing, p, *lights[p], at, u, sampled, unlike);
        }
        EXPECT_EQ(unlike, 0);
        // Five standard deviations: a false alarm in two million (these squares are upper bounds of
        // variances).
        EXPECT_NEAR(sampled.sum, looked.sum, 5 * std::sqrt(sampled.squares + looked.squares));
    }
}

TEST(LightConformance, EveryDocumentedAreaLightOnEveryShape) {
    int number = 0;
    for (const GlowingShape& glowing : shapes_to_light()) {
        ASSERT_NE(glowing.shape, nullptr);
        ++number;
        for (const Kind<AreaLight>& kind : area_light_kinds().all())
            for (const Example& example : kind.doc().examples) {
                SCOPED_TRACE(kind.name + ", " + example.name + ", shape " + std::to_string(number));
                TwoModes first;
                for (std::size_t i = 0; i < 2; ++i) {
                    auto description = make_area_light(example.parameters, {both_modes[i]});
                    ASSERT_TRUE(description);
                    auto lights = attach_all(*description, *glowing.shape);
                    for (const auto& light : lights)
                        check_contract(*light, both_modes[i] == ColorMode::rgb
                                                   ? rgb_lanes
                                                   : Wavelengths::sample_visible(0.3f));
                    if (both_modes[i] == ColorMode::rgb) compare_with_brute_force(glowing, lights);
                    first[i] = std::move(lights[0]);
                }
                if (!first[0]->bounds()->two_sided) check_power(*first[0]);
                expect_color(color_of_power(*first[1], ColorMode::spectral),
                             color_of_power(*first[0], ColorMode::rgb), 0.01f);
            }
    }
}

} // namespace
} // namespace alhazen
