/// Surfaces displaced by textures, which see single precision only.

#include "tests/support/sdf_world.h"
#include "tests/unit/shapes/support.h"
#include "textures/texture_set.h"

namespace alhazen {
namespace {

using namespace shape_test;
using ::testing::HasSubstr;
using testing_support::sdf_node;

/// A ball displaced by a texture of that kind.
struct Displaced {
    TextureSet textures;
    SdfSet sdfs;
    Messages messages;

    explicit Displaced(const std::string& kind, std::vector<Parameter> more = {}) {
        BuildContext context{.messages = messages};
        TextureNode texture;
        texture.node.name = "bumps";
        texture.node.type = kind;
        texture.is_spectrum = false;
        textures.build({texture}, context);
        more.push_back(make_string("child", "ball"));
        more.push_back(make_texture("texture", "bumps"));
        more.push_back(make_float("amplitude", 0.2f));
        sdfs.build({sdf_node("ball", "sphere", {}), sdf_node("rough", "displacement", std::move(more))},
                   context);
    }
    std::string text() const {
        std::string all;
        for (const Message& m : messages.list()) all += m.text + "\n";
        return all;
    }
};

TEST(DisplacedSdfs, AreNowhereNearerThanTheFieldSays) {
    Displaced made("fbm");
    auto field = made.sdfs.find("rough");
    ASSERT_TRUE(field) << made.text();
    EXPECT_GT(field->noise(), 0);
    Rng rng(1);
    auto number = [&] { return 1.5 * (2 * static_cast<double>(rng.uniform()) - 1); };
    double lowest = Box::far, highest = -Box::far;
    for (int i = 0; i < 20000; ++i) {
        Vec3d p{number(), number(), number()}, q{number(), number(), number()};
        double step = std::pow(10.0, -4 * static_cast<double>(rng.uniform()));
        q = p + q * (step / length(q));
        ASSERT_LE(std::abs(field->value(p) - field->value(q)), step * (1 + 1e-6) + 4 * field->noise());
        Vec3d d = normalize(p);
        double f = field->value(d);
        lowest = std::min(lowest, f);
        highest = std::max(highest, f);
    }
    // It is displaced, up and down.
    EXPECT_LT(lowest, -0.003);
    EXPECT_GT(highest, 0.003);
}

TEST(DisplacedSdfs, AreLeftByTheRaysThatTheySend) {
    Displaced made("fbm");
    Node node;
    node.type = "sdf";
    node.parameters = {make_string("field", "rough")};
    BuildContext context{.messages = made.messages};
    context.sdfs = &made.sdfs;
    auto shape = shape_kinds().make(node, context, "");
    ASSERT_TRUE(shape) << made.text();
    Rng rng(2);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        auto number = [&] { return 2 * rng.uniform() - 1; };
        Vec3 o{4 * number(), 4 * number(), 4 * number()};
        Intersection met;
        Ray ray{o, Vec3{number(), number(), number()} * 0.8f - o};
        if (!shape->intersect(ray, 0, met)) continue;
        ++hits;
        Hit hit = shape->surface(ray, 0, met);
        double off = std::abs(made.sdfs.find("rough")->value(Vec3d(hit.p)));
        ASSERT_LE(off, static_cast<double>(dot(abs(hit.ng), hit.p_error)));
        for (float side : {1.0f, -1.0f}) {
            Vec3 d{number(), number(), number()};
            d = normalize(d);
            if (dot(d, hit.ng) * side < 0) d = -d;
            if (abs_dot(d, hit.ng) < 0.2f) continue;
            Intersection again;
            bool is_met = shape->intersect(hit.spawn(d), 0, again);
            // The next bump may be near, but not as near as rounding.
            ASSERT_TRUE(!is_met || again.t > 2e-5f) << again.t;
        }
    }
    EXPECT_GT(hits, 500);
}

TEST(DisplacedSdfs, AreRefusedWhereTheTextureJumps) {
    EXPECT_THAT(Displaced("checkerboard").text(), HasSubstr("the texture jumps"));
    EXPECT_THAT(Displaced("fbm", {make_float("slope", 0.01f)}).text(), HasSubstr("must be at least that"));
}

} // namespace
} // namespace alhazen
