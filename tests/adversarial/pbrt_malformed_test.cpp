/// Scene texts that are wrong, each with the message it must give. None may crash, hang or be accepted.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/hash.h"
#include "formats/format.h"
#include "render/world.h"

namespace alhazen {
namespace {

struct Malformed {
    std::string text;
    std::string message; ///< all of it, the file's name left out
};

std::string errors_of(std::string_view text) {
    Messages messages;
    try {
        read_pbrt_string(text, "/nonexistent", messages);
    } catch (const SceneError& error) {
        std::string all = error.what();
        for (std::size_t at; (at = all.find("<string>:")) != std::string::npos;) all.erase(at, 9);
        return all;
    }
    return "";
}

void expect_all(const std::vector<Malformed>& cases) {
    for (const Malformed& c : cases) EXPECT_EQ(errors_of(c.text), c.message) << c.text;
}

TEST(MalformedPbrt, Characters) {
    expect_all({
        {"WorldBegin \"", "1:12: error: unterminated string \"; expected a closing quote on the same line"},
        {"WorldBegin Shape \"sph\nere\" Shape \"disk\"",
         "1:18: error: unterminated string \"sph; expected a closing quote on the same line"},
        {std::string("WorldBegin \0 \0", 14), "1:12: error: stray character \\x00"},
        {std::string("WorldBegin Shape \"a\0b\"", 22), "1:18: error: a string with a zero byte in it"},
        {"WorldBegin Shape \"a\\qb\"",
         "1:18: error: unknown escape \\q in a string; known: \\b \\f \\n \\r \\t \\\\ \\' \\\""},
        {"WorldBegin \x01", "1:12: error: stray character \\x01"},
        {std::string("\xff\xfeW\0o\0", 6), "1:1: error: the file is in UTF-16; expected ASCII or UTF-8\n"
                                           "1:1: error: the file ends before WorldBegin"},
        {"WorldBegin \xc3\xa9t\xc3\xa9", "1:12: error: unknown directive \xc3\xa9t\xc3\xa9"},
        {"WorldBegin " + std::string(5000, 'x'),
         "1:12: error: unknown directive " + std::string(60, 'x') + "..."},
    });
}

TEST(MalformedPbrt, Directives) {
    expect_all({
        {"", "1:1: error: the file ends before WorldBegin"},
        {"# nothing\n", "2:1: error: the file ends before WorldBegin"},
        {"WorldBegin Sahpe \"sphere\"", "1:12: error: unknown directive Sahpe (did you mean Shape?)"},
        {"WorldBegin shape \"sphere\"", "1:12: error: unknown directive shape (did you mean Shape?)"},
        {"WorldBegin [ 1 2 ]", "1:12: error: expected a directive, found \"[\""},
        {"WorldBegin ]", "1:12: error: expected a directive, found \"]\""},
        {"WorldBegin \"sphere\"", "1:12: error: expected a directive, found the string \"sphere\""},
        {"WorldBegin 1 2 3", "1:12: error: expected a directive, found 1"},
        {"WorldBegin Shape", "1:17: error: expected a type in quotes, found the end of the file"},
        {"WorldBegin Shape sphere", "1:18: error: expected a type in quotes, found sphere"},
        {"WorldBegin Shape [ \"sphere\" ]", "1:18: error: expected a type in quotes, found \"[\""},
        {"WorldBegin Texture \"t\"",
         "1:23: error: expected \"float\" or \"spectrum\" in quotes, found the end of the file"},
        {"WorldBegin Texture \"t\" \"float\" Shape \"sphere\"",
         "1:32: error: expected a type in quotes, found Shape"},
        {"WorldBegin NamedMaterial 5", "1:26: error: expected a name in quotes, found 5"},
        {"WorldBegin MediumInterface",
         "1:27: error: expected a medium's name in quotes, found the end of the file"},
        {"WorldBegin Translate 1 2",
         "1:25: error: Translate needs 3 numbers; found the end of the file after 2"},
        {"WorldBegin Translate [1 2 3]", "1:22: error: Translate needs 3 numbers; found \"[\" after 0"},
        {"WorldBegin Scale 1 1e999 1", "1:20: error: 1e999 is too large for a 64-bit float"},
        {"WorldBegin Scale 1 nan 1", "1:20: error: \"nan\" is not a number"},
        {"WorldBegin Scale 1e300 1 1 Scale 1e300 1 1",
         "1:28: error: Scale 1e+300 1 1 gives a transformation that cannot be inverted"},
        {"WorldBegin Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0]",
         "1:52: error: Transform needs 16 numbers; found \"]\" after 15"},
        {"WorldBegin Include", "1:19: error: expected a file name in quotes, found the end of the file"},
        {"WorldBegin Include \"x.pbrt\"", "1:12: error: cannot read \"x.pbrt\": no such file"},
        {"WorldBegin Include \"/dev/zero\"",
         "1:12: error: cannot read \"/dev/zero\": is a device, not a file"},
        {"Option \"seed\" [1 2] WorldBegin", "1:18: error: expected \"]\" after one value, found 2"},
    });
}

TEST(MalformedPbrt, Order) {
    expect_all({
        {"Shape \"sphere\" WorldBegin", "1:1: error: Shape before WorldBegin; expected it after"},
        {"LightSource \"point\" WorldBegin", "1:1: error: LightSource before WorldBegin; expected it after"},
        {"AttributeBegin AttributeEnd WorldBegin",
         "1:1: error: AttributeBegin before WorldBegin; expected it after\n"
         "1:16: error: AttributeEnd before WorldBegin; expected it after"},
        {"WorldBegin Camera \"perspective\"", "1:12: error: Camera after WorldBegin; expected it before"},
        {"WorldBegin Film \"rgb\"", "1:12: error: Film after WorldBegin; expected it before"},
        {"WorldBegin TransformTimes 0 1", "1:12: error: TransformTimes after WorldBegin; expected it before"},
        {"WorldBegin\nWorldBegin", "2:1: error: WorldBegin after WorldBegin; expected it before"},
        {"WorldBegin AttributeEnd", "1:12: error: AttributeEnd without an AttributeBegin"},
        {"WorldBegin ObjectEnd", "1:12: error: ObjectEnd without an ObjectBegin"},
        {"WorldBegin\n AttributeBegin", "2:2: error: AttributeBegin without AttributeEnd"},
        {"WorldBegin\n TransformBegin",
         "2:2: warning: TransformBegin and TransformEnd are deprecated and act as AttributeBegin and "
         "AttributeEnd: other "
         "attributes are restored too\n2:2: error: TransformBegin without TransformEnd"},
        {"WorldBegin\n ObjectBegin \"o\"", "2:2: error: ObjectBegin without ObjectEnd"},
        {"WorldBegin ObjectBegin \"o\"\nAttributeEnd",
         "2:1: error: AttributeEnd while the ObjectBegin of 1:12 is open"},
        {"WorldBegin AttributeBegin\nObjectEnd",
         "2:1: error: ObjectEnd while the AttributeBegin of 1:12 is open"},
        {"WorldBegin ObjectBegin \"a\"\nObjectBegin \"b\" ObjectEnd ObjectEnd",
         "2:1: error: ObjectBegin inside the object \"a\"; expected its ObjectEnd first (an ObjectInstance "
         "may be inside)"},
    });
}

TEST(MalformedPbrt, Names) {
    expect_all({
        {"WorldBegin ObjectInstance \"a\"", "1:12: error: no object \"a\""},
        {"WorldBegin ObjectBegin \"tree\" ObjectEnd ObjectInstance \"tre\"",
         "1:41: error: no object \"tre\" (did you mean \"tree\"?)"},
        {"WorldBegin ObjectBegin \"a\" ObjectEnd ObjectBegin \"a\" ObjectEnd",
         "1:38: error: object \"a\" is defined twice"},
        {"WorldBegin ObjectBegin \"a\"\nObjectInstance \"a\" ObjectEnd",
         "2:1: error: object \"a\" contains itself: \"a\" > \"a\""},
        {"WorldBegin ObjectBegin \"c\" ObjectInstance \"a\" ObjectEnd\nObjectBegin \"a\"\nObjectInstance "
         "\"b\" ObjectEnd\n"
         "ObjectBegin \"b\" ObjectInstance \"a\" ObjectEnd",
         "3:1: error: object \"a\" contains itself: \"a\" > \"b\" > \"a\""},
        {"WorldBegin NamedMaterial \"m\" Shape \"sphere\"", "1:12: error: no material \"m\""},
        {"WorldBegin MakeNamedMaterial \"m\"", "1:12: error: material \"m\" has no \"string type\""},
        {"WorldBegin MakeNamedMaterial \"m\" \"float type\" 1",
         "1:12: error: material \"m\" has no \"string type\""},
        {"WorldBegin MakeNamedMaterial \"m\" \"string type\" \"diffuse\" MakeNamedMaterial \"m\" \"string "
         "type\" \"diffuse\"",
         "1:58: error: material \"m\" is defined twice"},
        {"MakeNamedMedium \"m\" \"string type\" \"a\" MakeNamedMedium \"m\" \"string type\" \"a\" WorldBegin",
         "1:39: error: medium \"m\" is defined twice"},
        {"MediumInterface \"\" \"fog\" Camera \"perspective\" WorldBegin", "1:1: error: no medium \"fog\""},
        {"WorldBegin Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"scale\"",
         "1:43: error: float texture \"t\" is defined twice"},
        {"Camera \"spherical\" \"integer name\" 1 WorldBegin",
         "1:20: error: a camera's \"name\" is one string"},
    });
}

TEST(MalformedPbrt, GoesOnAtTheNextDirective) {
    EXPECT_EQ(
        errors_of("Flim \"rgb\" \"integer xresolution\" 5\nWorldBegin\nShape \"sphere\" \"float radius\" x\n"
                  "Translate 1 1 Shape \"sphere\" \"foo bar\" [ 1 2 ]\nAttributeEnd"),
        "1:1: error: unknown directive Flim (did you mean Film?)\n"
        "3:31: error: expected a number for \"float radius\", found x\n"
        "4:15: error: Translate needs 3 numbers; found Shape after 2\n"
        "4:30: error: unknown parameter type \"foo\"; known: bool, integer, float, point2, vector2, point3, "
        "vector3, "
        "normal, rgb, blackbody, spectrum, string, texture\n"
        "5:1: error: AttributeEnd without an AttributeBegin");
}

// Small files that would be large if everything that is named twice were there twice.
TEST(MalformedPbrt, SharedPartsAreNotFollowedAgainAndAgain) {
    std::string materials = "WorldBegin\nMakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
    std::string bodies = "WorldBegin\nSdf \"s0\" \"sphere\"\n", textures = "WorldBegin\n";
    textures += "Texture \"t0\" \"spectrum\" \"constant\"\n";
    for (int i = 1; i < 60; ++i) {
        materials += fmt::format("MakeNamedMaterial \"m{0}\" \"string type\" \"mix\" \"string materials\" "
                                 "[ \"m{1}\" \"m{1}\" ]\n",
                                 i, i - 1);
        bodies += fmt::format("Sdf \"s{0}\" \"union\" \"string children\" [ \"s{1}\" \"s{1}\" ]\n", i, i - 1);
        textures += fmt::format("Texture \"t{0}\" \"spectrum\" \"mix\" \"texture tex1\" \"t{1}\" "
                                "\"texture tex2\" \"t{1}\"\n",
                                i, i - 1);
    }
    auto errors = [](const std::string& text) {
        Messages messages;
        try {
            build_world(read_pbrt_string(text, "/nonexistent", messages), {}, messages);
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(errors(materials + "NamedMaterial \"m59\"\nShape \"sphere\"\n"), "");
    EXPECT_THAT(errors(bodies + "Shape \"sdf\" \"string field\" \"s59\"\n"),
                ::testing::HasSubstr("is made of more than 1000000 sdfs"));
    EXPECT_THAT(errors(textures), ::testing::HasSubstr("is made of more than 1000000 textures"));
}

TEST(MalformedPbrt, StopsAfterTwentyErrors) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 1000; ++i) text += "Foo Identity\n";
    Messages messages;
    try {
        read_pbrt_string(text, {}, messages);
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_EQ(error.messages().size(), Messages::max_errors);
    }
}

TEST(MalformedPbrt, DeepNestingEndsInAMessage) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 20000; ++i) text += "AttributeBegin ";
    EXPECT_EQ(errors_of(text), "2:150001: error: blocks nested more than 10000 deep");
}

TEST(MalformedPbrt, DeepObjectsEndInAMessage) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 3000; ++i) {
        std::string n = std::to_string(i);
        text += "ObjectBegin \"" + n + "\" ObjectInstance \"" + std::to_string(i + 1) + "\" ObjectEnd\n";
    }
    text += "ObjectBegin \"3000\" ObjectEnd";
    EXPECT_EQ(errors_of(text), "2938:1: error: object \"2936\" holds objects nested more than 64 deep");
}

TEST(MalformedPbrt, ManyParametersEndInAMessage) {
    std::string text = "WorldBegin Shape \"sphere\"\n";
    for (int i = 0; i < 1001; ++i) text += "\"float p" + std::to_string(i) + "\" 1\n";
    EXPECT_EQ(errors_of(text), "1002:1: error: more than 1000 parameters in one directive");
}

const std::string small_scene = R"(# a scene with a little of everything
Option "seed" 3
LookAt 3 4 1.5  .5 .5 0  0 0 1
Camera "perspective" "float fov" [ 45 ] "string name" "main"
Film "rgb" "integer xresolution" 40 "integer yresolution" [ 30 ] "string filename" "a\\b.exr"
Sampler "halton" "integer pixelsamples" 16
WorldBegin
LightSource "infinite" "rgb L" [ .4 .45 .5 ]
Texture "t" "spectrum" "checkerboard" "float uscale" 8 "rgb tex1" [ .1 .1 .1 ]
MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "t"
MakeNamedMedium "fog" "string type" "homogeneous" "spectrum sigma_a" [ 400 1 700 2 ]
AttributeBegin
  ActiveTransform EndTime Translate 0 0 1 ActiveTransform All
  AreaLightSource "diffuse" "blackbody L" 6500 "bool twosided" true
  MediumInterface "fog" ""
  NamedMaterial "m"
  Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ] "integer indices" [ 0 1 2 ]
AttributeEnd
ObjectBegin "o" Rotate 30 0 0 1 Shape "sphere" "float radius" 2 ObjectEnd
Attribute "shape" "float alpha" .5
Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1 ] ObjectInstance "o"
)";

std::string mutated(std::string text, Rng& rng) {
    const std::string_view pieces[] = {"\"", "[",    "]",     "#",          "\n", "\\",
                                       "-",  "1e99", "Shape", "WorldBegin", " "};
    for (std::uint32_t n = 1 + rng.below(4); n > 0; --n) {
        std::size_t at = rng.below(static_cast<std::uint32_t>(text.size() + 1));
        std::size_t length = rng.below(20);
        switch (rng.below(5)) {
        case 0:
            text.erase(std::min(at, text.size()), length);
            break;
        case 1:
            text.insert(at, 1, static_cast<char>(rng.below(256)));
            break;
        case 2:
            text.insert(at, pieces[rng.below(std::size(pieces))]);
            break;
        case 3:
            text.insert(at, text.substr(rng.below(static_cast<std::uint32_t>(text.size())), 3 * length));
            break;
        default:
            text.resize(rng.below(8) == 0 ? at : text.size());
            break;
        }
    }
    return text;
}

TEST(MalformedPbrt, MutatedScenesAreReadOrRefused) {
    ASSERT_EQ(errors_of(small_scene), "");
    Rng rng(1);
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = mutated(small_scene, rng);
        Messages messages;
        messages.lenient = i % 2 == 0;
        try {
            read_pbrt_string(text, "/nonexistent", messages);
        } catch (const SceneError& error) {
            ++refused;
            EXPECT_FALSE(error.messages().empty());
        }
    }
    EXPECT_GT(refused, 1000) << "the mutations are too tame";
}

} // namespace
} // namespace alhazen
