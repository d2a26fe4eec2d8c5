/// Textures without images against their closed forms; mappings; names and messages.
#include "tests/unit/textures/support.h"

namespace alhazen {

namespace {

using testing::HasSubstr;

TEST_F(TextureTest, Constant) {
    EXPECT_EQ(number("constant", {make_float("value", 0.25f)}, at_uv(0, 0)), 0.25f);
    EXPECT_EQ(number("constant", {}, at_uv(0, 0)), 1);
}

TEST_F(TextureTest, ConstantColor) {
    build({texture_node("constant", {make_rgb("value", 0.8f, 0.4f, 0.1f)}, true)}, ColorMode::rgb);
    Spectrum c = color(at_uv(0, 0), rgb);
    EXPECT_NEAR(c[0], 0.8f, 1e-6f);
    EXPECT_NEAR(c[1], 0.4f, 1e-6f);
    EXPECT_NEAR(c[2], 0.1f, 1e-6f);
}

TEST_F(TextureTest, ScaleMultiplies) {
    EXPECT_FLOAT_EQ(number("scale", {make_float("tex", 3), make_float("scale", 0.5f)}, at_uv(0, 0)), 1.5f);
}

TEST_F(TextureTest, MixInterpolates) {
    EXPECT_FLOAT_EQ(number("mix", {make_float("tex1", 2), make_float("tex2", 6), make_float("amount", 0.25f)},
                           at_uv(0, 0)),
                    3);
}

TEST_F(TextureTest, TexturesOfTextures) {
    build({texture_node("checkerboard", {make_float("uscale", 2)}, false, "board"),
           texture_node(
               "mix", {make_rgb("tex1", 1, 0, 0), make_rgb("tex2", 0, 0, 1), make_texture("amount", "board")},
               true, "mixed"),
           texture_node("scale", {make_texture("tex", "mixed"), make_float("scale", 0.5f)}, true, "t")},
          ColorMode::rgb);
    EXPECT_EQ(messages.error_count(), 0u) << first_message();
    // u = 0.2 is in an even square: tex1 of the board, 1, so blue.
    EXPECT_NEAR(color(at_uv(0.2f, 0.5f), rgb)[2], 0.5f, 1e-6f);
    EXPECT_NEAR(color(at_uv(0.7f, 0.5f), rgb)[0], 0.5f, 1e-6f);
    EXPECT_EQ(color(at_uv(0.7f, 0.5f), rgb)[2], 0);
}

TEST_F(TextureTest, CheckerboardAlternates) {
    build({texture_node("checkerboard", {make_float("uscale", 4), make_float("vscale", 2)}, false)});
    auto node = textures.find_float("t");
    for (int i = -8; i < 8; ++i)
        for (int j = -4; j < 4; ++j) {
            auto u = (static_cast<float>(i) + 0.4f) / 4, v = (static_cast<float>(j) + 0.7f) / 2;
            EXPECT_EQ(node->eval(at_uv(u, v)), (i + j) % 2 == 0 ? 1 : 0) << i << " " << j;
        }
    EXPECT_TRUE(std::isfinite(node->eval(at_uv(1e30f, -1e30f))));
}

TEST_F(TextureTest, CheckerboardInSpace) {
    TextureNode cubes = texture_node("checkerboard", {make_integer("dimension", 3)}, false);
    // Texture space is twice as large as the world's: cubes of side 2.
    cubes.world_from_texture.start = Matrix4::scale({2, 2, 2});
    build({cubes});
    auto node = textures.find_float("t");
    EXPECT_EQ(node->eval(at_point({0.5f, 0.5f, 0.5f})), 1);
    EXPECT_EQ(node->eval(at_point({1.5f, 0.5f, 0.5f})), 1);
    EXPECT_EQ(node->eval(at_point({2.5f, 0.5f, 0.5f})), 0);
    EXPECT_EQ(node->eval(at_point({2.5f, 2.5f, 0.5f})), 1);
    EXPECT_EQ(node->eval(at_point({2.5f, 2.5f, -0.5f})), 0);
}

TEST_F(TextureTest, CheckerboardHasTwoOrThreeDimensions) {
    build({texture_node("checkerboard", {make_integer("dimension", 4)}, false)});
    EXPECT_THAT(first_message(), HasSubstr("\"dimension\" is 4; it must be 2 to 3"));
}

TEST_F(TextureTest, BilerpGoesStraightBetweenCorners) {
    build({texture_node(
        "bilerp", {make_float("v00", 1), make_float("v01", 2), make_float("v10", 4), make_float("v11", 8)},
        false)});
    auto node = textures.find_float("t");
    EXPECT_EQ(node->eval(at_uv(0, 0)), 1);
    EXPECT_EQ(node->eval(at_uv(0, 1)), 2);
    EXPECT_EQ(node->eval(at_uv(1, 0)), 4);
    EXPECT_EQ(node->eval(at_uv(1, 1)), 8);
    EXPECT_FLOAT_EQ(node->eval(at_uv(0.25f, 0.5f)), 0.75f * 1.5f + 0.25f * 6);
    EXPECT_EQ(node->eval(at_uv(3, -2)), -10); // beyond the square: straight on
}

TEST_F(TextureTest, DirectionMixFollowsTheNormal) {
    TextureNode mix = texture_node("directionmix",
                                   {make_float("tex1", 1), make_float("tex2", 3),
                                    make_array<Vec3>("dir", ValueType::vector3, {{0, 0, 5}})},
                                   false);
    build({mix});
    auto node = textures.find_float("t");
    auto facing = [&](Vec3 n) { return node->eval(TexturePoint({}, normalize(n), {})); };
    EXPECT_FLOAT_EQ(facing({0, 0, 1}), 1);
    EXPECT_FLOAT_EQ(facing({0, 0, -1}), 1);
    EXPECT_FLOAT_EQ(facing({1, 0, 0}), 3);
    EXPECT_FLOAT_EQ(facing({1, 0, std::sqrt(3.0f)}), std::sqrt(0.75f) + 3 * (1 - std::sqrt(0.75f)));
    build({texture_node("directionmix", {make_array<Vec3>("dir", ValueType::vector3, {{0, 0, 0}})}, false)});
    EXPECT_THAT(first_message(), HasSubstr("\"dir\" must be a direction, not zero"));
}

// A board whose squares are a tenth wide tells in which tenth a coordinate lies.
float board_value(Messages& messages, std::vector<Parameter> parameters, Vec3 p) {
    TextureSet set;
    BuildContext context{messages};
    set.build({texture_node("checkerboard", std::move(parameters), false)}, context);
    return set.find_float("t")->eval(at_point(p));
}

TEST_F(TextureTest, PlanarMapping) {
    std::vector<Parameter> plane{
        make_string("mapping", "planar"), make_array<Vec3>("v1", ValueType::vector3, {{0, 0, 10}}),
        make_array<Vec3>("v2", ValueType::vector3, {{0, 0, 0}}), make_float("udelta", 1)};
    EXPECT_EQ(board_value(messages, plane, {5, 7, 0.05f}), 0); // s = 1.5
    EXPECT_EQ(board_value(messages, plane, {5, 7, 0.15f}), 1); // s = 2.5
    EXPECT_EQ(messages.error_count(), 0u);
}

TEST_F(TextureTest, SphericalAndCylindricalMappings) {
    // A point on the equator at 90 degrees: s = 1/2, t = 1/4, both below 1.
    EXPECT_EQ(board_value(messages, {make_string("mapping", "spherical")}, {0, 3, 0}), 1);
    // z = 1.5: t = 1.5.
    EXPECT_EQ(board_value(messages, {make_string("mapping", "cylindrical")}, {1, 0, 1.5f}), 0);
    EXPECT_EQ(board_value(messages, {make_string("mapping", "cylindrical")}, {1, 0, 2.5f}), 1);
}

TEST_F(TextureTest, UnknownMappingIsAnError) {
    build({texture_node("checkerboard", {make_string("mapping", "sphericl")}, false)});
    EXPECT_THAT(first_message(), HasSubstr("\"mapping\" is \"sphericl\", which is not known (did you mean "
                                           "\"spherical\"?)"));
}

TEST_F(TextureTest, UnknownTextureIsAnError) {
    build({texture_node("constant", {}, true, "wood"),
           texture_node("scale", {make_texture("tex", "woood")}, true, "t")});
    EXPECT_THAT(first_message(),
                HasSubstr("parameter \"tex\" refers to the spectrum texture \"woood\", which is not "
                          "defined (did you mean \"wood\"?)"));
    EXPECT_EQ(textures.find_spectrum("t", SpectrumRole::albedo), nullptr);
}

TEST_F(TextureTest, LaterTexturesAreNotKnownYet) {
    build({texture_node("scale", {make_texture("tex", "later")}, true, "t"),
           texture_node("constant", {}, true, "later")});
    EXPECT_THAT(first_message(), HasSubstr("\"later\", which is not defined"));
}

TEST_F(TextureTest, TheOtherFamilyIsHinted) {
    build({texture_node("constant", {}, false, "height"),
           texture_node("scale", {make_texture("tex", "height")}, true, "t")});
    EXPECT_THAT(first_message(),
                HasSubstr("there is a float texture of that name, but this must be a spectrum texture"));
}

TEST_F(TextureTest, DuplicateNamesAreErrors) {
    build({texture_node("constant", {}, false), texture_node("constant", {}, true)});
    EXPECT_EQ(messages.error_count(), 0u) << "the families have names of their own";
    Messages more;
    BuildContext context{more};
    TextureSet set;
    set.build({texture_node("constant", {}, true), texture_node("mix", {}, true)}, context);
    EXPECT_THAT(more.list().at(0).text, HasSubstr("the spectrum texture \"t\" is already defined"));
}

TEST_F(TextureTest, PtexSaysWhatToDo) {
    build({texture_node("ptex", {make_string("filename", "x.ptx")}, true)});
    EXPECT_THAT(first_message(),
                HasSubstr("\"ptex\" cannot be read; bake them into images for \"imagemap\""));
    Messages lenient;
    lenient.lenient = true;
    BuildContext context{lenient};
    TextureSet set;
    set.build({texture_node("ptex", {make_string("filename", "x.ptx")}, true)}, context);
    EXPECT_NE(set.find_spectrum("t", SpectrumRole::albedo, &lenient), nullptr);
    EXPECT_EQ(lenient.warnings().size(), 1u);
}

TEST_F(TextureTest, UnknownKindIsAnErrorOrAConstant) {
    build({texture_node("marbel", {}, true)});
    EXPECT_THAT(first_message(), HasSubstr("unknown spectrum texture \"marbel\""));
    Messages lenient;
    lenient.lenient = true;
    BuildContext context{lenient};
    TextureSet set;
    set.build({texture_node("marbel", {make_float("variation", 2)}, true)}, context);
    EXPECT_NE(set.find_spectrum("t", SpectrumRole::albedo, &lenient), nullptr);
    EXPECT_EQ(lenient.warnings().size(), 1u);
    EXPECT_EQ(lenient.error_count(), 0u);
}

// Light of 3 is light; a reflectance of 3 is not.
TEST_F(TextureTest, RolesDecideWhatColorsMayBe) {
    build({texture_node("constant", {make_rgb("value", 3, 2, 1)}, true)});
    EXPECT_EQ(messages.error_count(), 0u);
    EXPECT_GT(color(at_uv(0, 0), some, SpectrumRole::unbounded).max(), 1);
    EXPECT_EQ(textures.find_spectrum("t", SpectrumRole::albedo, &messages), nullptr);
    EXPECT_THAT(first_message(), HasSubstr("a reflectance must be 0 to 1"));
}

TEST_F(TextureTest, ParametersOfMaterialsMayBeTextures) {
    build({texture_node("constant", {make_float("value", 0.4f)}, false, "f"),
           texture_node("constant", {make_float("value", 0.6f)}, true, "s")});
    BuildContext context{messages};
    context.textures = &textures;
    FloatTexture f;
    read_float_texture(f, make_texture("roughness", "f"), context);
    EXPECT_FALSE(f.is_constant());
    EXPECT_EQ(f.eval(at_uv(0, 0)), 0.4f);
    SpectrumTexture s;
    read_spectrum_texture(s, make_texture("reflectance", "s"), SpectrumRole::albedo, context);
    EXPECT_EQ(s.eval(at_uv(0, 0), some)[2], 0.6f);
    read_float_texture(f, make_string("roughness", "f"), context);
    EXPECT_THAT(first_message(),
                HasSubstr("\"roughness\" is declared as string, but must be float | texture"));
}

} // namespace

} // namespace alhazen
