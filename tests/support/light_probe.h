/// Lights for tests: built from parameters as a scene would, and measured as a film or a light meter would.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "color/sensor.h"
#include "lights/area_light.h"
#include "lights/light.h"
#include "math/warp.h"

namespace alhazen {

inline constexpr ColorMode both_modes[] = {ColorMode::rgb, ColorMode::spectral};
/// What lights are prepared for.
inline const Bounds3 unit_scene{{-1, -1, -1}, {1, 1, 1}};
inline const Bounds3 wide_scene{{-4, -4, -4}, {4, 4, 4}};
inline const Wavelengths rgb_lanes = Wavelengths::rgb();

inline Node make_node(std::string type, std::vector<Parameter> parameters) {
    Node node;
    node.type = std::move(type);
    node.parameters = std::move(parameters);
    return node;
}

struct LightSetting {
    ColorMode mode = ColorMode::rgb;
    Matrix4 world_from_light = {};
    std::filesystem::path folder = {};
};

/// Fails the test, and gives nullptr, when the light cannot be built.
template <class Family>
std::unique_ptr<Family> build_or_fail(const KindList<Family>& kinds, const Node& node,
                                      const LightSetting& setting) {
    Messages messages;
    BuildContext context{messages};
    context.color_mode = setting.mode;
    context.world_from_node = Transform(setting.world_from_light);
    context.base_folder = setting.folder;
    auto made = kinds.make(node, context, "");
    for (const Message& m : messages.list()) ADD_FAILURE() << m.full_text();
    return made;
}
inline std::unique_ptr<Light> make_light(const std::string& type, std::vector<Parameter> parameters,
                                         const LightSetting& setting = {}) {
    return build_or_fail(light_kinds(), make_node(type, std::move(parameters)), setting);
}
inline std::unique_ptr<AreaLight> make_area_light(std::vector<Parameter> parameters,
                                                  const LightSetting& setting = {}) {
    return build_or_fail(area_light_kinds(), make_node("diffuse", std::move(parameters)), setting);
}
/// The text of the one error that building must give.
template <class Family>
std::string build_error(const KindList<Family>& kinds, const Node& node,
                        const std::filesystem::path& folder = {}) {
    Messages messages;
    BuildContext context{messages};
    context.base_folder = folder;
    EXPECT_EQ(kinds.make(node, context, ""), nullptr);
    EXPECT_EQ(messages.error_count(), 1u);
    return messages.list().empty() ? "" : messages.list()[0].text;
}

/// Linear sRGB that a film shows for a radiance given as a function of the wavelengths.
template <class F>
Vec3 film_color(ColorMode mode, F radiance) {
    Sensor sensor;
    int n = mode == ColorMode::rgb ? 1 : 255; // odd: no partner is another sample
    Vec3d sum;
    for (int i = 0; i < n; ++i) {
        Wavelengths lambda =
            mode == ColorMode::rgb
                ? Wavelengths::rgb()
                : Wavelengths::sample_visible((static_cast<float>(i) + 0.5f) / static_cast<float>(n));
        sum += Vec3d(sensor.to_sensor_rgb(radiance(lambda), lambda));
    }
    return sensor.output_from_sensor(srgb_space(), mode) * Vec3(sum / n);
}

inline void expect_color(Vec3 actual, Vec3 expected, float relative) {
    float tolerance = relative * std::max(max_component(abs(expected)), 1e-6f);
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

/// Irradiance at a surface by side x side jittered samples; nothing is in the way.
inline Spectrum sampled_irradiance(const Light& light, const LightReceiver& at, const Wavelengths& lambda,
                                   int side, std::uint64_t seed = 1) {
    Rng rng(seed);
    double sum[4] = {0, 0, 0, 0};
    int n = light.is_delta() ? 1 : side;
    for (int i = 0; i < n * n; ++i) {
        Vec2 u{(static_cast<float>(i % n) + rng.uniform()) / static_cast<float>(n),
               (static_cast<float>(i / n) + rng.uniform()) / static_cast<float>(n)};
        u = {std::min(u.x, one_minus_epsilon), std::min(u.y, one_minus_epsilon)};
        auto s = light.sample(at, u, lambda);
        if (!s) continue;
        Spectrum e = s->L * (std::max(0.0f, dot(s->wi, at.ns)) / s->pdf);
        for (int c = 0; c < 4; ++c) sum[c] += static_cast<double>(e[c]);
    }
    auto mean = [&](int c) { return static_cast<float>(sum[c] / (n * n)); };
    return {mean(0), mean(1), mean(2), mean(3)};
}

/// The flux that arrives on the inside of a sphere around the light, by as many receivers.
inline double flux_through_sphere(const Light& light, Vec3 center, float radius, const Wavelengths& lambda,
                                  int receivers_per_side, int samples_per_side) {
    double sum = 0;
    int n = receivers_per_side;
    Rng rng(7);
    for (int i = 0; i < n * n; ++i) {
        Vec2 u{(static_cast<float>(i % n) + rng.uniform()) / static_cast<float>(n),
               (static_cast<float>(i / n) + rng.uniform()) / static_cast<float>(n)};
        Vec3 d = sample_sphere({std::min(u.x, 1.0f), u.y});
        sum += static_cast<double>(sampled_irradiance(light, {center + d * radius, -d}, lambda,
                                                      samples_per_side, static_cast<std::uint64_t>(i))[0]);
    }
    return sum / (n * n) * 4 * static_cast<double>(pi * radius * radius);
}

} // namespace alhazen
