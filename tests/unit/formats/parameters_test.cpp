#include <gtest/gtest.h>

#include "parse.h"

namespace alhazen {
namespace {

Parameter one(const std::string& text) {
    SceneDescription scene = parse_scene(in_world("Shape \"sphere\" " + text));
    const auto& parameters = scene.world.shapes.at(0).node.parameters;
    EXPECT_EQ(parameters.size(), 1u);
    return parameters.at(0);
}

std::string fault(const std::string& text) {
    return errors_of("WorldBegin Shape \"sphere\"\n" + text);
}

template <class T>
void expect_values(const std::string& text, ValueType type, const std::vector<T>& values) {
    Parameter p = one(text);
    EXPECT_EQ(p.name, "v") << text;
    EXPECT_EQ(p.type, type) << text;
    ASSERT_TRUE(std::holds_alternative<std::vector<T>>(p.values)) << text;
    EXPECT_EQ(std::get<std::vector<T>>(p.values), values) << text;
}

TEST(PbrtParameters, Bool) {
    expect_values<std::uint8_t>("\"bool v\" true", ValueType::boolean, {1});
    expect_values<std::uint8_t>("\"bool v\" [false true]", ValueType::boolean, {0, 1});
    expect_values<std::uint8_t>("\"bool v\" \"true\"", ValueType::boolean, {1});
    expect_values<std::uint8_t>("\"bool v\" [\"false\"]", ValueType::boolean, {0});
    EXPECT_EQ(fault("\"bool v\" 1"), "<string>:2:10: error: expected true or false for \"bool v\", found 1");
    EXPECT_EQ(fault("\"bool v\" \"yes\""),
              "<string>:2:10: error: expected true or false for \"bool v\", found the string \"yes\"");
}

TEST(PbrtParameters, Integer) {
    expect_values<int>("\"integer v\" 7", ValueType::integer, {7});
    expect_values<int>("\"integer v\" [-1 +2 2147483647]", ValueType::integer, {-1, 2, 2147483647});
    expect_values<int>("\"integer v\" []", ValueType::integer, {});
    EXPECT_EQ(fault("\"integer v\" 1.5"), "<string>:2:13: error: \"1.5\" is not an integer");
    EXPECT_EQ(fault("\"integer v\" [1 3000000000]"),
              "<string>:2:16: error: 3000000000 is too large for a 32-bit integer");
    EXPECT_EQ(fault("\"integer v\" \"1\""),
              "<string>:2:13: error: expected an integer for \"integer v\", found the string \"1\"");
}

TEST(PbrtParameters, Float) {
    expect_values<float>("\"float v\" 1.5", ValueType::real, {1.5f});
    expect_values<float>("\"float v\" [1 2e1 -.5]", ValueType::real, {1, 20, -0.5f});
    expect_values<float>("\" float\t v \" 1", ValueType::real, {1});
    EXPECT_EQ(fault("\"float v\" true"),
              "<string>:2:11: error: expected a number for \"float v\", found true");
    EXPECT_EQ(fault("\"float v\" [1 nan]"),
              "<string>:2:14: error: expected a number for \"float v\", found nan");
    EXPECT_EQ(fault("\"float v\" 1e40"), "<string>:2:11: error: 1e40 is too large for a 32-bit float");
}

TEST(PbrtParameters, Vectors) {
    expect_values<Vec2>("\"point2 v\" [1 2 3 4]", ValueType::point2, {{1, 2}, {3, 4}});
    expect_values<Vec2>("\"vector2 v\" [1 2]", ValueType::vector2, {{1, 2}});
    expect_values<Vec3>("\"point3 v\" [1 2 3 4 5 6]", ValueType::point3, {{1, 2, 3}, {4, 5, 6}});
    expect_values<Vec3>("\"vector3 v\" [1 2 3]", ValueType::vector3, {{1, 2, 3}});
    expect_values<Vec3>("\"normal v\" [1 2 3]", ValueType::normal, {{1, 2, 3}});
    EXPECT_EQ(fault("\"point3 v\" [1 2 3 4]"),
              "<string>:2:1: error: \"point3 v\" has 4 numbers; expected a multiple of 3");
    EXPECT_EQ(fault("\"point2 v\" [1 2 3]"),
              "<string>:2:1: error: \"point2 v\" has 3 numbers; expected a multiple of 2");
}

TEST(PbrtParameters, Rgb) {
    expect_values<float>("\"rgb v\" [.1 .2 .3]", ValueType::rgb, {.1f, .2f, .3f});
    EXPECT_EQ(fault("\"rgb v\" [1 2]"),
              "<string>:2:1: error: \"rgb v\" has 2 numbers; expected 3 in brackets");
    EXPECT_EQ(fault("\"rgb v\" 1 2 3"),
              "<string>:2:1: error: \"rgb v\" has 1 number; expected 3 in brackets");
    EXPECT_EQ(fault("\"rgb v\" [1 2 3 4 5 6]"),
              "<string>:2:1: error: \"rgb v\" has 6 numbers; expected 3 in brackets");
}

TEST(PbrtParameters, RgbListsInMedia) {
    SceneDescription scene = parse_scene(
        "MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 2 3 4 5 6]\nWorldBegin");
    EXPECT_EQ(scene.media.at(0).node.parameters.at(0).count(), 6u);
    EXPECT_EQ(
        errors_of("MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 2 3 4]\nWorldBegin"),
        "<string>:1:45: error: \"rgb sigma_a\" has 4 numbers; expected a multiple of 3");
}

TEST(PbrtParameters, Blackbody) {
    expect_values<float>("\"blackbody v\" 6500", ValueType::blackbody, {6500});
    EXPECT_EQ(fault("\"blackbody v\" [6500 1]"),
              "<string>:2:1: error: \"blackbody v\" has 2 numbers; expected 1, the temperature in kelvins");
}

TEST(PbrtParameters, Spectrum) {
    expect_values<std::string>("\"spectrum v\" \"metal-Au-eta\"", ValueType::spectrum, {"metal-Au-eta"});
    expect_values<std::string>("\"spectrum v\" [ \"a.spd\" ]", ValueType::spectrum, {"a.spd"});
    expect_values<float>("\"spectrum v\" [400 1 500 .5]", ValueType::spectrum, {400, 1, 500, .5f});
    EXPECT_EQ(
        fault("\"spectrum v\" [400 1 500]"),
        "<string>:2:1: error: \"spectrum v\" has 3 numbers; expected pairs of wavelength (nm) and value");
    EXPECT_EQ(
        fault("\"spectrum v\" [500 1 400 1]"),
        "<string>:2:1: error: \"spectrum v\": wavelength 400 after 500; expected increasing wavelengths");
    EXPECT_EQ(
        fault("\"spectrum v\" []"),
        "<string>:2:1: error: \"spectrum v\" has 0 numbers; expected pairs of wavelength (nm) and value");
    EXPECT_EQ(
        fault("\"spectrum v\" [\"a\" 1]"),
        "<string>:2:19: error: expected a spectrum's name in quotes or numbers for \"spectrum v\", found 1");
}

TEST(PbrtParameters, StringAndTexture) {
    expect_values<std::string>("\"string v\" \"a b\"", ValueType::string, {"a b"});
    expect_values<std::string>("\"string v\" [\"a\" \"\"]", ValueType::string, {"a", ""});
    expect_values<std::string>("\"string v\" \"a\\\\b\"", ValueType::string, {"a\\b"});
    expect_values<std::string>("\"texture v\" \"t\"", ValueType::texture, {"t"});
    EXPECT_EQ(fault("\"string v\" 5"),
              "<string>:2:12: error: expected a string in quotes for \"string v\", found 5");
    EXPECT_EQ(fault("\"texture v\" [\"a\" \"b\"]"),
              "<string>:2:1: error: \"texture v\" names 2 textures; expected 1");
}

TEST(PbrtParameters, KeepPlaceAndColorSpace) {
    SceneDescription scene =
        parse_scene("ColorSpace \"rec2020\"\nFilm \"rgb\"\n  \"integer xresolution\" 4\nWorldBegin");
    const Parameter& p = scene.film.parameters.at(0);
    EXPECT_EQ(p.place.text(), "<string>:3:3");
    EXPECT_EQ(p.color_space, "rec2020");
}

TEST(PbrtParameters, Declarations) {
    EXPECT_EQ(fault("\"float\" 1"),
              "<string>:2:1: error: bad parameter declaration \"float\"; expected \"type name\"");
    EXPECT_EQ(fault("\"float a b\" 1"),
              "<string>:2:1: error: bad parameter declaration \"float a b\"; expected \"type name\"");
    EXPECT_EQ(fault("\"flaot v\" 1"),
              "<string>:2:1: error: unknown parameter type \"flaot\" (did you mean \"float\"?)");
    EXPECT_EQ(fault("\"float v\" 1\n\"float v\" 2"),
              "<string>:3:1: error: parameter \"v\" is given twice; first at line 2");
    EXPECT_EQ(fault("\"float v\""),
              "<string>:2:10: error: expected a number for \"float v\", found the end of the file");
    EXPECT_EQ(fault("\"float v\" [1 2"),
              "<string>:2:11: error: the file ends inside the values of \"float v\"; expected \"]\"");
    EXPECT_EQ(fault("\"float v\" ]"), "<string>:2:11: error: expected a number for \"float v\", found \"]\"");
    EXPECT_EQ(fault("\"float v\" [[1]]"),
              "<string>:2:12: error: expected a number for \"float v\", found \"[\"");
    EXPECT_EQ(fault("\"color v\" [1 1 1]"),
              "<string>:2:1: error: parameter type \"color\" is an older pbrt's name; "
              "pbrt-v4 calls it \"rgb\"; --lenient would use \"rgb\" instead");
    EXPECT_EQ(fault("\"xyz v\" [1 1 1]"),
              "<string>:2:1: error: parameter type \"xyz\" is an older pbrt's; pbrt-v4 has nothing of that "
              "name: give \"rgb\" or \"spectrum\"");
    for (std::string old : {"point", "vector"})
        EXPECT_EQ(fault("\"" + old + " v\" [1 1 1]"), "<string>:2:1: error: parameter type \"" + old +
                                                          "\" is an older pbrt's name; pbrt-v4 calls it \"" +
                                                          old + "3\"; --lenient would use \"" + old +
                                                          "3\" instead");
}

TEST(PbrtParameters, LenientTakesPointForPoint3) {
    Messages messages;
    messages.lenient = true;
    SceneDescription scene = read_pbrt_string(
        in_world("Shape \"sphere\" \"point a\" [1 2 3] \"vector b\" [1 2 3] \"normal3 c\" [1 2 3]"), {},
        messages);
    const auto& p = scene.world.shapes.at(0).node.parameters;
    EXPECT_EQ(p.at(0).type, ValueType::point3);
    EXPECT_EQ(p.at(1).type, ValueType::vector3);
    EXPECT_EQ(p.at(2).type, ValueType::normal);
    EXPECT_EQ(messages.warnings().size(), 3u);
}

TEST(PbrtParameters, LenientTakesColorForRgb) {
    Messages messages;
    messages.lenient = true;
    SceneDescription scene = read_pbrt_string(in_world("Shape \"sphere\" \"color v\" [1 2 3]"), {}, messages);
    EXPECT_EQ(scene.world.shapes.at(0).node.parameters.at(0).type, ValueType::rgb);
    EXPECT_EQ(joined(messages.list()),
              "<string>:2:16: warning: parameter type \"color\" is an older pbrt's name; pbrt-v4 "
              "calls it \"rgb\"; using \"rgb\" instead");
}

} // namespace
} // namespace alhazen
