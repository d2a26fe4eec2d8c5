/// What every texture must satisfy: its examples build without a message, in every role and colour mode, and
/// give finite values that are not negative and depend on the point alone. Numbers of noise have both signs.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "textures/texture_set.h"

namespace alhazen {

namespace {

bool has_both_signs(const std::string& kind) {
    return kind == "fbm" || kind == "windy" || kind == "bilerp";
}

constexpr SpectrumRole roles[] = {SpectrumRole::albedo, SpectrumRole::unbounded, SpectrumRole::illuminant};

TextureNode node_of(const std::string& kind, const Example& example, bool is_spectrum) {
    TextureNode t;
    t.node.type = kind;
    t.node.name = "t";
    t.node.parameters = example.parameters;
    t.is_spectrum = is_spectrum;
    return t;
}

TexturePoint point(Rng& rng) {
    auto number = [&] { return 200 * rng.uniform() - 100; };
    return {{number(), number(), number()}, {0, 0, 1}, {number(), number()}};
}

TEST(Textures, NumbersOfEveryExample) {
    for (const auto& kind : float_texture_kinds().all())
        for (const Example& example : kind.doc().examples) {
            SCOPED_TRACE(kind.name + " / " + example.name);
            Messages messages;
            BuildContext context{messages};
            TextureSet set;
            set.build({node_of(kind.name, example, false)}, context);
            auto node = set.find_float("t");
            ASSERT_TRUE(node && messages.list().empty());
            Rng rng(1);
            for (int i = 0; i < 1000; ++i) {
                TexturePoint at = point(rng);
                float v = node->eval(at);
                ASSERT_TRUE(std::isfinite(v) && (v >= 0 || has_both_signs(kind.name)));
                ASSERT_LE(v, node->max_value());
                ASSERT_EQ(v, node->eval(at));
            }
        }
}

TEST(Textures, ColorsOfEveryExample) {
    for (const auto& kind : spectrum_texture_kinds().all())
        for (const Example& example : kind.doc().examples)
            for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb})
                for (SpectrumRole role : roles) {
                    SCOPED_TRACE(kind.name + " / " + example.name);
                    Messages messages;
                    BuildContext context{messages, mode};
                    TextureSet set;
                    set.build({node_of(kind.name, example, true)}, context);
                    auto node = set.find_spectrum("t", role, &messages);
                    ASSERT_TRUE(node && messages.list().empty());
                    Rng rng(2);
                    for (int i = 0; i < 300; ++i) {
                        TexturePoint at = point(rng);
                        Wavelengths lambda = mode == ColorMode::rgb
                                                 ? Wavelengths::rgb()
                                                 : Wavelengths::sample_visible(rng.uniform());
                        Spectrum v = node->eval(at, lambda);
                        ASSERT_TRUE(v.is_finite() && v.min() >= 0);
                        if (role == SpectrumRole::albedo) {
                            ASSERT_LE(v.max(), 1 + 1e-5f);
                        }
                        ASSERT_EQ(v, node->eval(at, lambda));
                    }
                }
}

TEST(Textures, EveryKindServesBothFamilies) {
    EXPECT_EQ(float_texture_kinds().names(), spectrum_texture_kinds().names());
}

} // namespace

} // namespace alhazen
