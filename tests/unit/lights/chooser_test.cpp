#include <map>

#include "lights/light_chooser.h"
#include "tests/support/density_test.h"
#include "tests/support/light_probe.h"
#include "tests/unit/lights/test_shapes.h"

namespace alhazen {
namespace {

// Lights of all kinds at random places, with the shapes they live on.
struct RandomScene {
    std::vector<std::unique_ptr<Shape>> shapes;
    std::vector<std::unique_ptr<Light>> owned;
    std::vector<const Light*> lights;
    Rng rng;

    explicit RandomScene(std::uint64_t seed) : rng(seed) {}
    float between(float lo, float hi) { return lo + (hi - lo) * rng.uniform(); }
    Vec3 place(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    Parameter color(const char* name) {
        float bright = std::exp(between(-3, 3));
        return make_rgb(name, rng.uniform() * bright, rng.uniform() * bright, rng.uniform() * bright);
    }
    void add(std::unique_ptr<Light> light) {
        light->prepare({Vec3(-10), Vec3(10)});
        lights.push_back(light.get());
        owned.push_back(std::move(light));
    }
    void add_triangle(float size, float extent, bool two_sided) {
        Vec3 p = place(extent);
        shapes.push_back(std::make_unique<TestTriangle>(p, p + place(size), p + place(size)));
        add(make_area_light({color("L"), make_bool("twosided", two_sided)})->attach(*shapes.back(), 0));
    }
    void add_any() {
        switch (rng.below(6)) {
        case 0:
            return add(make_light("point", {color("I"), make_point3("from", place(10))}));
        case 1:
            return add(
                make_light("spot", {color("I"), make_point3("from", place(10)), make_point3("to", place(10)),
                                    make_float("coneangle", between(1, 90)),
                                    make_float("conedeltaangle", between(0, 60))}));
        case 2:
            shapes.push_back(std::make_unique<TestSphere>(place(10), between(0.01f, 3)));
            return add(make_area_light({color("L")})->attach(*shapes.back(), 0));
        case 3:
            return add_triangle(3, 10, true);
        default:
            return add_triangle(rng.uniform() < 0.5f ? 0.01f : 3, 10, false);
        }
    }
    LightReceiver receiver() {
        LightReceiver at{place(12), {}};
        if (rng.uniform() < 0.8f) at.ns = sample_sphere({rng.uniform(), rng.uniform()});
        return at;
    }
};

class Choosers : public testing::TestWithParam<std::string> {
  public:
    std::unique_ptr<LightChooser> make(const std::vector<const Light*>& lights) const {
        return make_light_chooser(GetParam(), lights);
    }
};

std::vector<LightReceiver> receivers_of(RandomScene& scene, int n) {
    std::vector<LightReceiver> all;
    for (int i = 0; i < n; ++i) all.push_back(scene.receiver());
    return all;
}

TEST_P(Choosers, ProbabilitiesSumToOneAndFrequenciesFollow) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        RandomScene scene(seed);
        for (int i = 0; i < 28; ++i) scene.add_any();
        if (seed & 1) scene.add(make_light("distant", {}));
        if (seed & 2) scene.add(make_light("infinite", {}));
        auto chooser = make(scene.lights);
        for (const LightReceiver& at : receivers_of(scene, 5)) {
            double sum = 0;
            std::map<const Light*, int> counts;
            constexpr int n = 40000;
            for (int i = 0; i < n; ++i) {
                auto chosen = chooser->choose(at, (static_cast<float>(i) + scene.rng.uniform()) / n);
                if (!chosen) continue;
                ASSERT_FLOAT_EQ(chosen->probability, chooser->probability(at, chosen->light));
                ++counts[chosen->light];
            }
            std::vector<double> observed, expected;
            double rest = n, rest_expected = n; // nothing chosen
            for (const Light* light : scene.lights) {
                auto p = static_cast<double>(chooser->probability(at, light));
                sum += p;
                observed.push_back(counts[light]);
                expected.push_back(n * p);
                rest -= observed.back();
                rest_expected -= expected.back();
            }
            observed.push_back(rest);
            expected.push_back(rest_expected > 1e-3 * n ? rest_expected : rest);
            EXPECT_GT(testing_support::chi_square_test(observed, expected).p_value,
                      testing_support::p_threshold);
            EXPECT_LE(sum, 1.0001);
            EXPECT_GE(sum, GetParam() == "bvh" ? 0 : 0.9999);
        }
    }
}

TEST_P(Choosers, NeverOverlookALightThatContributes) {
    for (std::uint64_t seed = 100; seed < 130; ++seed) {
        RandomScene scene(seed);
        int count = 1 + static_cast<int>(scene.rng.below(40));
        for (int i = 0; i < count; ++i) scene.add_any();
        auto chooser = make(scene.lights);
        for (const LightReceiver& at : receivers_of(scene, 200))
            for (const Light* light : scene.lights)
                for (Vec2 u : {Vec2{0.5f, 0.5f}, Vec2{0.01f, 0.02f}, Vec2{0.97f, 0.3f}}) {
                    auto s = light->sample(at, u, Wavelengths::rgb());
                    if (s && (at.ns == Vec3() || dot(s->wi, at.ns) != 0)) {
                        ASSERT_GT(chooser->probability(at, light), 0) << "seed " << seed;
                    }
                }
    }
}

TEST_P(Choosers, EstimateTheSumOverAllLights) {
    RandomScene scene(7);
    for (int i = 0; i < 30; ++i) scene.add_any();
    scene.add(make_light("infinite", {make_rgb("L", .1f, .1f, .1f)}));
    auto chooser = make(scene.lights);
    Wavelengths lambda = Wavelengths::rgb();
    for (const LightReceiver& at : receivers_of(scene, 4)) {
        LightReceiver facing{at.p, at.ns == Vec3() ? Vec3(0, 0, 1) : at.ns};
        double expected = 0;
        for (const Light* light : scene.lights)
            expected += static_cast<double>(sampled_irradiance(*light, facing, lambda, 100)[0]);
        double sum = 0, squares = 0;
        constexpr int n = 200000;
        for (int i = 0; i < n; ++i) {
            auto chosen = chooser->choose(facing, scene.rng.uniform());
            if (!chosen) continue;
            auto s = chosen->light->sample(facing, {scene.rng.uniform(), scene.rng.uniform()}, lambda);
            if (!s) continue;
            auto e = static_cast<double>(s->L[0] * std::max(0.0f, dot(s->wi, facing.ns)) /
                                         (s->pdf * chosen->probability));
            sum += e;
            squares += e * e;
        }
        double mean = sum / n, sigma = std::sqrt((squares / n - mean * mean) / n);
        // Five standard deviations: a false alarm in two million; 1 % more for the expected value's own
        // error.
        EXPECT_NEAR(mean, expected, 5 * sigma + 0.01 * expected);
    }
}

TEST_P(Choosers, WorkForTenThousandLights) {
    RandomScene scene(1);
    for (int i = 0; i < 10000; ++i) scene.add_triangle(0.1f, 10, false);
    auto chooser = make(scene.lights);
    LightReceiver at{{0.3f, 0.1f, 0.2f}, {0, 0, 1}};
    double sum = 0;
    for (const Light* light : scene.lights) sum += static_cast<double>(chooser->probability(at, light));
    EXPECT_LE(sum, 1.001);
    EXPECT_GT(sum, 0.9);
    for (int i = 0; i < 1000; ++i) {
        auto chosen = chooser->choose(at, scene.rng.uniform());
        if (!chosen) continue;
        EXPECT_FLOAT_EQ(chosen->probability, chooser->probability(at, chosen->light));
    }
}

TEST_P(Choosers, CopeWithNoneBlackOrEqualLights) {
    LightReceiver at{{0, 0, 0}, {0, 0, 1}};
    auto none = make({});
    EXPECT_FALSE(none->choose(at, 0.5f));
    auto stranger = make_light("point", {});
    EXPECT_EQ(none->probability(at, stranger.get()), 0);

    RandomScene black(1);
    for (int i = 0; i < 5; ++i) black.add(make_light("point", {make_rgb("I", 0, 0, 0)}));
    auto chooser = make(black.lights);
    float sum = 0;
    for (const Light* light : black.lights) sum += chooser->probability(at, light);
    EXPECT_LE(sum, 1.0001f);
    EXPECT_EQ(chooser->probability(at, stranger.get()), 0);

    // A hundred lights at one point, and the receiver there too.
    RandomScene equal(1);
    for (int i = 0; i < 100; ++i) equal.add(make_light("point", {make_point3("from", {1, 1, 1})}));
    chooser = make(equal.lights);
    for (Vec3 p : {Vec3(1), Vec3(0), Vec3(1e15f), Vec3(1e-30f)})
        for (const Light* light : equal.lights)
            EXPECT_NEAR(chooser->probability({p, {}}, light), 0.01f, 1e-4f);
    for (const Light* light : equal.lights) EXPECT_GT(chooser->probability({Vec3(1e25f), {}}, light), 0);
    for (float u : {0.0f, 0.25f, one_minus_epsilon}) EXPECT_TRUE(chooser->choose(at, u));
}

INSTANTIATE_TEST_SUITE_P(All, Choosers, testing::ValuesIn(light_chooser_names()),
                         [](const auto& test) { return test.param; });

TEST(LightChoosers, AreKnownByName) {
    EXPECT_EQ(light_chooser_names(), (std::vector<std::string>{"uniform", "power", "bvh"}));
    EXPECT_EQ(make_light_chooser("best", {}), nullptr);
}

TEST(PowerChooser, FollowsPower) {
    RandomScene scene(1);
    scene.add(make_light("point", {make_rgb("I", 1, 1, 1)}));
    scene.add(make_light("point", {make_rgb("I", 3, 3, 3)}));
    auto chooser = make_light_chooser("power", scene.lights);
    EXPECT_NEAR(chooser->probability({}, scene.lights[0]), 0.25f, 1e-5f);
    EXPECT_NEAR(chooser->probability({}, scene.lights[1]), 0.75f, 1e-5f);
}

TEST(BvhChooser, PrefersTheLightsNearby) {
    // Two rows of lamps far apart: a receiver beneath one of them hardly ever gets one of the other.
    RandomScene scene(1);
    for (int i = 0; i < 50; ++i) {
        auto x = static_cast<float>(i) * 0.1f;
        scene.add(make_light("point", {make_point3("from", {x, 0, 1})}));
        scene.add(make_light("point", {make_point3("from", {x, 1000, 1})}));
    }
    auto chooser = make_light_chooser("bvh", scene.lights);
    LightReceiver at{{2, 0, 0}, {0, 0, 1}};
    float near = 0;
    for (std::size_t i = 0; i < 100; i += 2) near += chooser->probability(at, scene.lights[i]);
    EXPECT_GT(near, 0.9999f);
}

TEST(BvhChooser, LeavesOutLightsThatFaceAway) {
    RandomScene scene(1);
    TestTriangle up({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), down({5, 0, 0}, {5, 1, 0}, {6, 0, 0});
    scene.add(make_area_light({})->attach(up, 0));
    scene.add(make_area_light({})->attach(down, 0));
    auto chooser = make_light_chooser("bvh", scene.lights);
    LightReceiver at{{3, 0, 4}, {0, 0, -1}};
    EXPECT_EQ(chooser->probability(at, scene.lights[0]), 1);
    EXPECT_EQ(chooser->probability(at, scene.lights[1]), 0);
}

TEST(BvhChooser, InfiniteLightsShareWithTheTree) {
    RandomScene scene(1);
    scene.add(make_light("infinite", {}));
    scene.add(make_light("distant", {}));
    auto chooser = make_light_chooser("bvh", scene.lights);
    EXPECT_EQ(chooser->probability({}, scene.lights[0]), 0.5f);
    scene.add(make_light("point", {}));
    chooser = make_light_chooser("bvh", scene.lights);
    EXPECT_FLOAT_EQ(chooser->probability({{1, 0, 0}, {}}, scene.lights[0]), 1 / 3.0f);
    EXPECT_FLOAT_EQ(chooser->probability({{1, 0, 0}, {}}, scene.lights[2]), 1 / 3.0f);
    EXPECT_FALSE(make_light_chooser("bvh", {scene.lights.data(), 1})->choose({}, 0.3f) == std::nullopt);
}

} // namespace
} // namespace alhazen
