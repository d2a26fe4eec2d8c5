/// Rays that are followed together, lane by lane: the very bits of following them one by one, by every
/// kernel, in scenes that bring out each branch.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "integrators/bundle/bundles.h"
#include "render/flight.h"
#include "tests/support/render_scene.h"

namespace alhazen::testing {
namespace {

std::unique_ptr<World> world_of_balls(const std::string& text, const RenderSettings& settings = {}) {
    Messages messages;
    return build_world(read_pbrt_string(text, ALHAZEN_SOURCE_DIR "/scenes", messages), settings, messages);
}

struct Followed {
    std::vector<Spectrum> radiance;
    RayCounts counts;
};

Followed one_by_one(const World& world, std::span<const Ray> rays) {
    Followed all;
    Arena arena;
    for (const Ray& ray : rays) {
        arena.reset();
        PathContext path(*world.scene, SampleStream(*world.sampler, {0, 0}, 0), Wavelengths::rgb(), arena,
                         all.counts);
        all.radiance.push_back(world.integrator->radiance(ray, path).result());
    }
    return all;
}

Followed together(const RayBundles& bundles, std::span<const Ray> rays) {
    Followed all;
    all.radiance.resize(rays.size());
    bundles.radiance(rays, all.radiance, all.counts);
    return all;
}

std::vector<Ray> camera_rays(const World& world) {
    std::vector<Ray> rays;
    const Vec2i size = world.film->resolution();
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            CameraSample at;
            at.film = {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
            if (auto ray = world.camera->ray(at)) rays.push_back(ray->ray);
        }
    return rays;
}

// By the names that tests print.
struct Case {
    std::string name, text;
    int maxdepth = 5;
    bool shadows = true, is_lit = true;
};

const std::string camera_at_9 = R"(
Film "rgb" "integer xresolution" 61 "integer yresolution" 45
LookAt 0 2 -9  0 1 0  0 1 0
Camera "perspective" "float fov" 40
)";

std::string integrator(const Case& c) {
    return "Integrator \"whitted\" \"rgb ambient\" [ .1 .2 .3 ] \"integer maxdepth\" " +
           std::to_string(c.maxdepth) + " \"bool shadows\" " + (c.shadows ? "true" : "false") + camera_at_9;
}

std::string number(float v) {
    return fmt::format("{:.9g} ", v);
}

// Balls of all kinds in each other's way: some inside others, some turned inside out, some far larger.
std::string random_balls(std::uint32_t seed, int count, float size) {
    Rng rng(seed);
    auto next = [&](float lo, float hi) { return lo + (hi - lo) * rng.uniform(); };
    std::string text = "WorldBegin\nScale " + number(size) + number(size) + number(size) + "\n";
    for (int i = 0; i < 3; ++i) {
        text += "LightSource \"point\" \"point3 from\" [ " + number(next(-9, 9)) + number(next(-3, 9)) +
                number(next(-9, 9)) + "] \"rgb I\" [ " + number(next(0, 2)) + number(next(0, 2)) + "0 ]" +
                (i == 1 ? "\n" : " \"string falloff\" \"none\"\n");
    }
    for (int i = 0; i < count; ++i) {
        auto color = [&](const char* name) {
            return fmt::format("\"rgb {}\" [ {}{}{}] ", name, number(next(0, 1)), number(next(0, 1)),
                               number(next(0, 1)));
        };
        const float kind = next(0, 1);
        text += "AttributeBegin\n";
        if (kind < 0.2f) text += "ReverseOrientation\n";
        text += "Material \"phong\" " + color("diffuse") + (kind < 0.5f ? color("specular") : "") +
                (kind > 0.8f ? "\"rgb specular\" [ 0 0 0 ] " : "") + "\"float shininess\" " +
                number(kind < 0.1f ? 0 : next(0, 600));
        if (next(0, 1) < 0.6f) text += "\"float reflectivity\" " + number(next(0, 1));
        if (next(0, 1) < 0.5f)
            text += "\"float transparency\" " + number(next(0, 1)) + "\"float eta\" " + number(next(0.5f, 2));
        const bool is_large = next(0, 1) < 0.1f;
        text += "\nTranslate " + number(next(-3, 3)) + number(next(-2, 4)) + number(next(-4, 4)) +
                "\nShape \"sphere\" \"float radius\" " + number(is_large ? next(8, 40) : next(0.1f, 1.5f)) +
                "\nAttributeEnd\n";
    }
    return text;
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (std::uint32_t seed : {1u, 2u, 3u, 4u})
        all.push_back({"random" + std::to_string(seed), random_balls(seed, 12, 1)});
    all.push_back({"many", random_balls(5, 60, 1)});
    all.push_back({"one", random_balls(6, 1, 1)});
    all.push_back({"nothing", "WorldBegin\n", 5, true, false});
    all.push_back({"dark", "WorldBegin\nMaterial \"phong\" \"float reflectivity\" .5\nShape \"sphere\"\n"});
    all.push_back({"deep", random_balls(7, 12, 1), whitted_whole_depth});
    all.push_back({"flat", random_balls(7, 12, 1), 1});
    all.push_back({"empty", random_balls(7, 12, 1), 0, true, false});
    all.push_back({"without shadows", random_balls(8, 12, 1), 5, false});
    // Several balls at one place: the lowest number is seen.
    std::string same = "WorldBegin\nLightSource \"point\" \"point3 from\" [ 3 4 -5 ]\n";
    for (float green : {.9f, .5f, .1f})
        same += "Material \"phong\" \"rgb diffuse\" [ 0 " + number(green) +
                "0 ] \"float transparency\" .5\nShape \"sphere\" \"float radius\" 2\n";
    all.push_back({"same place", same});
    all.push_back({"far away", "WorldBegin\nTranslate 0 0 100000\n" + random_balls(9, 10, 10000).substr(11)});
    return all;
}

void expect_same(const World& world, std::span<const Ray> rays, const WhittedSettings& settings) {
    const Followed alone = one_by_one(world, rays);
    for (std::string_view kernel : bundle_kernel_names()) {
        SCOPED_TRACE(kernel);
        auto bundles = whitted_bundles(*world.scene, settings, kernel);
        ASSERT_TRUE(bundles);
        // One more ray than bundles have room for, and fewer.
        for (std::size_t count : {rays.size(), std::size_t{9}, std::size_t{1}}) {
            const Followed all = together(*bundles, rays.first(count));
            int different = 0;
            for (std::size_t i = 0; i < count; ++i)
                if (!(all.radiance[i] == alone.radiance[i])) ++different;
            EXPECT_EQ(different, 0) << "of " << count;
        }
        const Followed all = together(*bundles, rays);
        EXPECT_EQ(all.counts.camera, alone.counts.camera);
        EXPECT_EQ(all.counts.bounce, alone.counts.bounce);
        EXPECT_EQ(all.counts.shadow, alone.counts.shadow);
    }
}

int count_lit(const World& world, std::span<const Ray> rays) {
    const Followed alone = one_by_one(world, rays);
    return static_cast<int>(std::count_if(alone.radiance.begin(), alone.radiance.end(),
                                          [](Spectrum s) { return !s.is_black(); }));
}

TEST(Bundles, GiveTheBitsOfRaysFollowedOneByOne) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name);
        auto world = world_of_balls(integrator(c) + c.text);
        const std::vector<Ray> rays = camera_rays(*world);
        if (c.is_lit)
            EXPECT_GT(count_lit(*world, rays), 10);
        else
            EXPECT_EQ(count_lit(*world, rays), 0);
        expect_same(*world, rays, {c.maxdepth, c.shadows, {.1f, .2f, .3f, .2f}});
    }
}

// Where rounding is worst: rays from far away, rays that graze a ball, balls that touch where they are met,
// of all sizes.
TEST(Bundles, GiveTheBitsOfRaysThatAreHardToFollow) {
    for (const float scale : {1e-22f, 1e-6f, 1.0f, 1e6f}) {
        SCOPED_TRACE(scale);
        const std::string size = number(scale);
        auto world = world_of_balls(integrator({}) + "WorldBegin\nScale " + size + size + size + R"(
LightSource "point" "point3 from" [ -3 4 -9 ] "string falloff" "none"
Material "phong" "rgb diffuse" [ .1 .9 .1 ] "float reflectivity" .3
AttributeBegin
Translate 0 0 2
Shape "sphere" "float radius" 2
AttributeEnd
Material "phong" "rgb diffuse" [ .9 .1 .1 ] "float transparency" .5
Translate 0 0 1
Shape "sphere" "float radius" 1
)");
        std::vector<Ray> rays{{{0, 0, -5}, {0, 0, 1}}, {{0, 0, -5}, {0, 0, 3}}, {{0, 0, 0}, {0, 0, 1}}};
        Rng rng(3);
        for (int i = 0; i < 4000; ++i) {
            const float distance = std::pow(10.0f, 7 * rng.uniform()),
                        miss = std::pow(10.0f, -7 * rng.uniform());
            const float radius = i % 2 ? 1 : 2,
                        beside = i % 4 < 2 ? radius * (1 - miss) : radius * rng.uniform();
            const float angle = 2 * pi * rng.uniform();
            const Vec3 o{beside * std::cos(angle), beside * std::sin(angle), -distance};
            rays.push_back({o, {0, 0, i % 3 ? 1 : distance}});
        }
        for (Ray& ray : rays) ray.o *= scale;
        EXPECT_GT(count_lit(*world, rays), 3000);
        expect_same(*world, rays, {5, true, {.1f, .2f, .3f, .2f}});
    }
}

// Through the whole program: pixels at the edge, filters, a lens, several samples, threads.
TEST(Bundles, MakeThePicturesThatSinglePathsMake) {
    const std::string text = R"(
Integrator "whitted"
Sampler "halton" "integer pixelsamples" 3
PixelFilter "mitchell"
Film "rgb" "integer xresolution" 53 "integer yresolution" 37
LookAt 0 2 -9  0 1 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" .2 "float focaldistance" 8
)" + random_balls(11, 14, 1);
    RenderSettings settings;
    settings.paths_in_flight = 1;
    settings.threads = 1;
    const Rendered alone = render_text(text, settings);
    EXPECT_GT(mean_of(alone.image, 0), 0.05);
    settings.paths_in_flight = 0;
    for (int threads : {1, 3})
        for (int tile : {5, 16, 64}) {
            settings.threads = threads;
            settings.tile_size = tile;
            const Rendered bundled = render_text(text, settings);
            const auto a = bundled.image.values(), b = alone.image.values();
            ASSERT_EQ(a.size(), b.size());
            EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0) << threads << ' ' << tile;
            EXPECT_EQ(bundled.stats.rays.total(), alone.stats.rays.total());
        }
}

// Infinite and undefined values come out as they do one by one, and are counted.
TEST(Bundles, CountValuesThatAreNotFinite) {
    const std::string text = "Integrator \"whitted\"\n" + camera_at_9 + R"(
WorldBegin
LightSource "point" "point3 from" [ 0 9 -9 ] "rgb I" [ 3e38 3e38 3e38 ] "string falloff" "none"
LightSource "point" "point3 from" [ 0 9 -8 ] "rgb I" [ 3e38 3e38 3e38 ] "string falloff" "none"
Material "phong" "rgb diffuse" [ 1 1 1 ] "rgb specular" [ 1 1 1 ]
Shape "sphere" "float radius" 2
)";
    RenderSettings settings;
    settings.paths_in_flight = 1;
    const RenderStats alone = render_text(text, settings).stats;
    EXPECT_GT(alone.bad_samples, 50u);
    settings.paths_in_flight = 0;
    EXPECT_EQ(render_text(text, settings).stats.bad_samples, alone.bad_samples);
}

// Scenes that have anything that kernels do not know are left to single paths.
TEST(Bundles, AreForBallsOfOneColorOnly) {
    const std::string start = "Integrator \"whitted\"\n" + camera_at_9;
    const std::string light = "LightSource \"point\"\n";
    const std::string ball = "Material \"phong\"\nShape \"sphere\"\n";
    auto is_bundled = [&](const std::string& world) {
        auto built = world_of_balls(start + "WorldBegin\n" + world);
        return built->integrator->bundles(*built->scene) != nullptr;
    };
    EXPECT_TRUE(is_bundled(light + ball));
    auto built = world_of_balls(start + "WorldBegin\n" + light + ball);
    EXPECT_TRUE(whitted_bundles(*built->scene, {whitted_whole_depth}));
    EXPECT_FALSE(whitted_bundles(*built->scene, {whitted_whole_depth + 1}));
    EXPECT_TRUE(is_bundled(light + "Scale -1 2 1\nScale 1 .5 1\n" + ball));
    const std::string checks = "Texture \"t\" \"spectrum\" \"checkerboard\"\n";
    const std::string many = [&] {
        std::string text = light;
        for (int i = 0; i < 65; ++i) text += ball;
        return text;
    }();
    for (const std::string& other :
         {light + "Scale 1 2 1\n" + ball, light + "Material \"phong\"\nShape \"sphere\" \"float zmax\" .5\n",
          light + "Material \"phong\"\nShape \"sphere\" \"float alpha\" .5\n",
          light + ball + "Shape \"disk\"\n", light + "Material \"diffuse\"\nShape \"sphere\"\n",
          light + "Material \"interface\"\nShape \"sphere\"\n",
          light + checks + "Material \"phong\" \"texture diffuse\" \"t\"\nShape \"sphere\"\n",
          "AreaLightSource \"diffuse\"\n" + ball, "LightSource \"infinite\"\n" + ball,
          "LightSource \"distant\"\n" + ball, "LightSource \"spot\"\n" + ball,
          light + "ObjectBegin \"a\"\n" + ball + "ObjectEnd\nObjectInstance \"a\"\n",
          light + "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\n" + ball, many})
        EXPECT_FALSE(is_bundled(other)) << other;

    // Whoever chooses a structure means it.
    std::string error;
    RenderSettings settings;
    settings.accel = parse_accel("sah/stack", error);
    auto chosen = world_of_balls(start + "WorldBegin\n" + light + ball, settings);
    EXPECT_EQ(chosen->integrator->bundles(*chosen->scene), nullptr);
}

} // namespace
} // namespace alhazen::testing
