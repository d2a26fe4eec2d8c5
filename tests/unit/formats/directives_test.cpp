#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parse.h"

namespace alhazen {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// Where the shapes' origins and axes go: one sphere after the directives.
const ShapeNode first_shape(const std::string& text) {
    return parse_scene(in_world(text + "\nShape \"sphere\"")).world.shapes.at(0);
}
Vec3 moved(const std::string& text, Vec3 p) {
    Motion m = first_shape(text).world_from_object;
    EXPECT_FALSE(m.is_animated());
    return Transform(m.start).point(p);
}
void expect_near(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-6);
    EXPECT_NEAR(a.y, b.y, 1e-6);
    EXPECT_NEAR(a.z, b.z, 1e-6);
}

// One test a directive.

TEST(PbrtDirective, Accelerator) {
    SceneDescription scene = parse_scene("Accelerator \"kdtree\" \"integer maxprims\" 2 WorldBegin");
    EXPECT_EQ(scene.accelerator.type, "kdtree");
    EXPECT_EQ(scene.accelerator.find("maxprims")->count(), 1u);
    EXPECT_EQ(scene.accelerator.place.text(), "<string>:1:1");
}

TEST(PbrtDirective, ActiveTransform) {
    Motion m =
        first_shape("ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 2 0 0 "
                    "ActiveTransform All Scale 2 2 2")
            .world_from_object;
    EXPECT_EQ(m.start, Matrix4::translate({1, 0, 0}) * Matrix4::scale({2, 2, 2}));
    EXPECT_EQ(m.end, Matrix4::translate({2, 0, 0}) * Matrix4::scale({2, 2, 2}));
    EXPECT_TRUE(m.is_animated());
    EXPECT_EQ(errors_of("ActiveTransform None WorldBegin"),
              "<string>:1:1: error: ActiveTransform None; expected All, StartTime or EndTime");
}

TEST(PbrtDirective, AreaLightSource) {
    SceneDescription scene =
        parse_scene(in_world("Shape \"sphere\" AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 2 3] "
                             "Shape \"sphere\" Shape \"disk\" AttributeEnd Shape \"sphere\""));
    ASSERT_THAT(scene.area_lights, SizeIs(1));
    EXPECT_EQ(scene.area_lights[0].type, "diffuse");
    std::vector<int> of_shapes;
    for (const ShapeNode& s : scene.world.shapes) of_shapes.push_back(s.area_light);
    EXPECT_THAT(of_shapes, ElementsAre(-1, 0, 0, -1));
}

TEST(PbrtDirective, Attribute) {
    SceneDescription scene = parse_scene(
        in_world("Attribute \"shape\" \"float radius\" 2 \"float zmin\" 0 \"bool x\" true\n"
                 "ColorSpace \"rec2020\" Attribute \"shape\" \"rgb radius\" [3 3 3]\n"
                 "ColorSpace \"srgb\" Shape \"sphere\" \"float zmin\" 1\n"
                 "Attribute \"light\" \"float scale\" 2 LightSource \"point\" AreaLightSource \"diffuse\"\n"
                 "Attribute \"material\" \"float roughness\" 2 Material \"conductor\"\n"
                 "Attribute \"material\" \"string type\" \"dielectric\" MakeNamedMaterial \"m\"\n"
                 "Attribute \"medium\" \"string type\" \"homogeneous\" MakeNamedMedium \"n\"\n"
                 "Attribute \"texture\" \"float scale\" 3 Texture \"t\" \"float\" \"constant\""));
    const Node& sphere = scene.world.shapes.at(0).node;
    ASSERT_THAT(sphere.parameters, SizeIs(3));
    EXPECT_EQ(std::get<std::vector<float>>(sphere.find("zmin")->values), std::vector<float>{1})
        << "its own wins";
    EXPECT_FALSE(sphere.find("zmin")->may_be_unused);
    EXPECT_EQ(sphere.find("radius")->type, ValueType::rgb) << "the later Attribute wins";
    EXPECT_EQ(sphere.find("radius")->color_space, "rec2020") << "the color space where it is written";
    EXPECT_TRUE(sphere.find("radius")->may_be_unused);
    EXPECT_TRUE(scene.lights.at(0).node.find("scale"));
    EXPECT_TRUE(scene.area_lights.at(0).find("scale"));
    EXPECT_TRUE(scene.materials.at(0).find("roughness"));
    EXPECT_EQ(scene.materials.at(1).type, "dielectric");
    EXPECT_EQ(scene.media.at(0).node.type, "homogeneous");
    EXPECT_TRUE(scene.textures.at(0).node.find("scale"));
    EXPECT_EQ(errors_of("Attribute \"lights\" WorldBegin"),
              "<string>:1:1: error: unknown Attribute target \"lights\"; expected \"shape\", \"light\", "
              "\"material\", "
              "\"medium\" or \"texture\"");
}

TEST(PbrtDirective, AttributeBeginAndEndKeepEveryAttribute) {
    SceneDescription scene = parse_scene(
        in_world("AttributeBegin Translate 1 2 3 ReverseOrientation Material \"conductor\" AreaLightSource "
                 "\"diffuse\" "
                 "MediumInterface \"m\" \"m\" ColorSpace \"rec2020\" Attribute \"shape\" \"float radius\" 3 "
                 "AttributeEnd\n"
                 "Shape \"sphere\" \"rgb x\" [1 1 1] MakeNamedMedium \"m\" \"string type\" \"homogeneous\""));
    const ShapeNode& shape = scene.world.shapes.at(0);
    EXPECT_EQ(shape.world_from_object, Motion{});
    EXPECT_FALSE(shape.reverse_orientation);
    EXPECT_EQ(shape.material, -1);
    EXPECT_EQ(shape.material_name, "");
    EXPECT_EQ(shape.area_light, -1);
    EXPECT_EQ(shape.inside_medium, "");
    ASSERT_THAT(shape.node.parameters, SizeIs(1));
    EXPECT_EQ(shape.node.parameters[0].color_space, "srgb");
}

TEST(PbrtDirective, Camera) {
    SceneDescription scene = parse_scene(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\"\nTranslate 0 0 "
        "5 "
        "Camera \"perspective\" \"float fov\" 30\nWorldBegin CoordSysTransform \"camera\" Shape \"sphere\"");
    ASSERT_THAT(scene.cameras, SizeIs(1));
    EXPECT_EQ(scene.cameras[0].node.type, "perspective");
    EXPECT_EQ(scene.cameras[0].world_from_camera.start, Matrix4::translate({0, 0, -5}));
    EXPECT_EQ(scene.cameras[0].medium, "fog");
    EXPECT_EQ(scene.world.shapes.at(0).world_from_object.start, Matrix4::translate({0, 0, -5}));
}

TEST(PbrtDirective, SeveralCameras) {
    SceneDescription scene =
        parse_scene("Camera \"perspective\" \"string name\" \"front\" Translate 1 0 0 Camera "
                    "\"orthographic\" \"string name\" \"side\" WorldBegin");
    ASSERT_THAT(scene.cameras, SizeIs(2));
    EXPECT_EQ(scene.cameras[0].node.name, "front");
    EXPECT_EQ(scene.cameras[1].node.name, "side");
    EXPECT_TRUE(scene.cameras[1].node.find("name")) << "cameras declare it";
    EXPECT_THAT(parse_scene("Camera \"perspective\" Camera \"spherical\" WorldBegin").cameras, SizeIs(1))
        << "without names the last counts, as in pbrt";
    EXPECT_EQ(errors_of("Camera \"spherical\" \"string name\" \"a\" Camera \"spherical\" \"string name\" "
                        "\"a\" WorldBegin"),
              "<string>:1:38: error: two cameras named \"a\"; the first is at <string>:1:1");
}

TEST(PbrtDirective, ColorSpace) {
    for (std::string name : {"srgb", "dci-p3", "rec2020", "aces2065-1"}) {
        ShapeNode s = parse_scene(in_world("ColorSpace \"" + name + "\" Shape \"x\" \"rgb a\" [1 1 1]"))
                          .world.shapes.at(0);
        EXPECT_EQ(s.node.parameters.at(0).color_space, name);
    }
    EXPECT_EQ(errors_of("ColorSpace \"sRGB\" WorldBegin"), "");
    EXPECT_EQ(errors_of("ColorSpace \"rec202\" WorldBegin"),
              "<string>:1:1: error: unknown color space \"rec202\" (did you mean \"rec2020\"?)");
}

TEST(PbrtDirective, TransformAndConcatTransformAreColumnAfterColumn) {
    std::string shift = "[1 0 0 0  0 1 0 0  0 0 1 0  1 2 3 1]";
    expect_near(moved("Scale 5 5 5 Transform " + shift, {1, 0, 0}), {2, 2, 3});
    expect_near(moved("Scale 5 5 5 ConcatTransform " + shift, {1, 0, 0}), {10, 10, 15});
    EXPECT_EQ(errors_of("Transform [1 0 0 0] WorldBegin"),
              "<string>:1:19: error: Transform needs 16 numbers; found \"]\" after 4");
    EXPECT_EQ(errors_of("ConcatTransform 1 WorldBegin"),
              "<string>:1:17: error: ConcatTransform needs 16 numbers in brackets; found 1");
    EXPECT_EQ(errors_of("Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 2] WorldBegin"),
              "<string>:1:44: error: Transform needs 16 numbers in brackets; found 2 after 16");
    EXPECT_EQ(errors_of("Transform [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0] WorldBegin"),
              "<string>:1:1: error: Transform gives a transformation that cannot be inverted");
}

TEST(PbrtDirective, CoordinateSystemAndCoordSysTransform) {
    expect_near(moved("Translate 1 0 0 CoordinateSystem \"a\" Identity CoordSysTransform \"a\"", {0, 0, 0}),
                {1, 0, 0});
    expect_near(moved("Translate 1 0 0 CoordSysTransform \"world\"", {0, 0, 0}), {0, 0, 0});
    EXPECT_EQ(warnings_of(in_world("CoordSysTransform \"wrld\"")),
              "<string>:2:1: warning: no coordinate system \"wrld\"; the transformation stays as it is (did "
              "you mean "
              "\"world\"?)");
}

TEST(PbrtDirective, Film) {
    SceneDescription scene =
        parse_scene("Film \"gbuffer\" Film \"rgb\" \"integer xresolution\" 7 WorldBegin");
    EXPECT_EQ(scene.film.type, "rgb");
    EXPECT_TRUE(scene.film.find("xresolution"));
}

TEST(PbrtDirective, Identity) {
    expect_near(moved("Translate 1 2 3 Identity", {1, 1, 1}), {1, 1, 1});
}

TEST(PbrtDirective, Integrator) {
    EXPECT_EQ(parse_scene("Integrator \"path\" WorldBegin").integrator.type, "path");
    EXPECT_EQ(parse_scene("WorldBegin").integrator.type, "") << "the default is the renderer's business";
}

TEST(PbrtDirective, LightSource) {
    SceneDescription scene = parse_scene(in_world("Translate 1 2 3 LightSource \"point\" \"rgb I\" [1 1 1]"));
    ASSERT_THAT(scene.lights, SizeIs(1));
    EXPECT_EQ(scene.lights[0].node.type, "point");
    EXPECT_EQ(scene.lights[0].world_from_light.start, Matrix4::translate({1, 2, 3}));
}

TEST(PbrtDirective, LookAt) {
    Motion m = parse_scene("LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" WorldBegin")
                   .cameras.at(0)
                   .world_from_camera;
    expect_near(Transform(m.start).point(Vec3{0, 0, 0}), {0, 0, 5});
    expect_near(Transform(m.start).vector(Vec3{0, 0, 1}), {0, 0, -1});
    EXPECT_EQ(errors_of("LookAt 0 0 1 0 0 1 0 1 0 WorldBegin"),
              "<string>:1:1: error: LookAt needs an eye apart from its target and an up vector that is not "
              "along the view");
    EXPECT_EQ(errors_of("LookAt 0 0 1 WorldBegin"),
              "<string>:1:14: error: LookAt needs 9 numbers; found WorldBegin after 3");
}

TEST(PbrtDirective, MaterialMakeNamedMaterialAndNamedMaterial) {
    SceneDescription scene = parse_scene(
        in_world("MakeNamedMaterial \"gold\" \"string type\" \"conductor\" \"float roughness\" .1\n"
                 "Shape \"a\" Material \"diffuse\" Shape \"b\" NamedMaterial \"gold\" Shape \"c\" "
                 "Material \"dielectric\" Shape \"d\""));
    ASSERT_THAT(scene.materials, SizeIs(3));
    EXPECT_EQ(scene.materials[0].name, "gold");
    EXPECT_EQ(scene.materials[0].type, "conductor");
    EXPECT_FALSE(scene.materials[0].find("type"));
    EXPECT_EQ(scene.materials[1].type, "diffuse");
    std::vector<std::pair<int, std::string>> used;
    for (const ShapeNode& s : scene.world.shapes) used.emplace_back(s.material, s.material_name);
    EXPECT_THAT(used, ElementsAre(std::pair(-1, std::string()), std::pair(1, std::string()),
                                  std::pair(-1, std::string("gold")), std::pair(2, std::string())));
}

TEST(PbrtDirective, NamedMaterialsMayBeMadeLater) {
    EXPECT_EQ(
        errors_of(in_world(
            "NamedMaterial \"a\" Shape \"sphere\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\"")),
        "");
    EXPECT_EQ(errors_of(in_world("NamedMaterial \"a\"")), "") << "nothing is made of it";
    EXPECT_EQ(errors_of(in_world("MakeNamedMaterial \"gold\" \"string type\" \"conductor\"\nNamedMaterial "
                                 "\"golf\" Shape \"sphere\"")),
              "<string>:3:1: error: no material \"golf\" (did you mean \"gold\"?)");
}

TEST(PbrtDirective, MakeNamedMediumAndMediumInterface) {
    SceneDescription scene = parse_scene(
        in_world("Translate 1 0 0 MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float scale\" 2\n"
                 "MediumInterface \"fog\" \"\" Shape \"a\" MediumInterface \"fog\" Shape \"b\" LightSource "
                 "\"point\""));
    ASSERT_THAT(scene.media, SizeIs(1));
    EXPECT_EQ(scene.media[0].node.name, "fog");
    EXPECT_EQ(scene.media[0].node.type, "homogeneous");
    EXPECT_EQ(scene.media[0].world_from_texture.start, Matrix4::translate({1, 0, 0}));
    EXPECT_EQ(scene.world.shapes.at(0).inside_medium, "fog");
    EXPECT_EQ(scene.world.shapes.at(0).outside_medium, "");
    EXPECT_EQ(scene.world.shapes.at(1).outside_medium, "fog");
    EXPECT_EQ(scene.lights.at(0).medium, "fog");
    EXPECT_EQ(errors_of(in_world("MediumInterface \"fog\" \"\" Shape \"sphere\"")),
              "<string>:2:1: error: no medium \"fog\"");
    EXPECT_EQ(errors_of("MakeNamedMedium \"a\" WorldBegin"),
              "<string>:1:1: error: medium \"a\" has no \"string type\"");
}

TEST(PbrtDirective, ObjectBeginEndAndInstance) {
    SceneDescription scene =
        parse_scene(in_world("Translate 0 1 0 ObjectBegin \"tree\" Translate 1 0 0 Shape \"a\" ObjectEnd "
                             "Shape \"b\" Scale 2 2 2 ObjectInstance \"tree\""));
    ASSERT_THAT(scene.objects, SizeIs(1));
    EXPECT_EQ(scene.objects[0].name, "tree");
    ASSERT_THAT(scene.objects[0].shapes, SizeIs(1));
    EXPECT_EQ(scene.objects[0].shapes[0].world_from_object.start, Matrix4::translate({1, 1, 0}));
    ASSERT_THAT(scene.world.shapes, SizeIs(1));
    EXPECT_EQ(scene.world.shapes[0].world_from_object.start, Matrix4::translate({0, 1, 0}));
    ASSERT_THAT(scene.world.instances, SizeIs(1));
    EXPECT_EQ(scene.world.instances[0].object, "tree");
    EXPECT_EQ(scene.world.instances[0].world_from_instance.start,
              Matrix4::translate({0, 1, 0}) * Matrix4::scale({2, 2, 2}));
}

TEST(PbrtDirective, ObjectsMayHoldInstances) {
    SceneDescription scene = parse_scene(
        in_world("ObjectBegin \"leaf\" Shape \"disk\" ObjectEnd ObjectBegin \"tree\" Translate 1 0 0 "
                 "ObjectInstance \"leaf\" ObjectInstance \"leaf\" ObjectEnd ObjectInstance \"tree\""));
    ASSERT_THAT(scene.objects, SizeIs(2));
    ASSERT_THAT(scene.objects[1].instances, SizeIs(2));
    EXPECT_EQ(scene.objects[1].instances[0].world_from_instance.start, Matrix4::translate({1, 0, 0}));
    EXPECT_THAT(scene.world.instances, SizeIs(1));
}

TEST(PbrtDirective, Option) {
    SceneDescription scene = parse_scene(
        "Option \"disable-Pixel_Jitter\" true Option \"seed\" 3 Option \"rendercoordsys\" \"world\" "
        "Option \"float displacementedgescale\" .5 Option \"seed\" [4] WorldBegin");
    ASSERT_THAT(scene.options, SizeIs(4));
    EXPECT_EQ(scene.options[0].type, "disablepixeljitter");
    EXPECT_EQ(scene.options[0].find("value")->type, ValueType::boolean);
    EXPECT_EQ(scene.options[1].type, "rendercoordsys");
    EXPECT_EQ(scene.options[2].type, "displacementedgescale");
    EXPECT_EQ(std::get<std::vector<int>>(scene.options[3].find("value")->values), std::vector<int>{4});
    EXPECT_EQ(errors_of("Option \"wavefrnt\" true WorldBegin"),
              "<string>:1:1: error: unknown option \"wavefrnt\" (did you mean \"wavefront\"?)");
    EXPECT_EQ(errors_of("Option \"wavefront\" 1 WorldBegin"),
              "<string>:1:1: error: option \"wavefront\" takes true or false");
    EXPECT_EQ(errors_of("Option \"seed\" 1.5 WorldBegin"),
              "<string>:1:1: error: option \"seed\" takes an integer");
    EXPECT_EQ(errors_of("Option \"rendercoordsys\" \"moon\" WorldBegin"),
              "<string>:1:1: error: option \"rendercoordsys\" is \"moon\"; expected \"camera\", "
              "\"cameraworld\" or \"world\"");
    EXPECT_EQ(errors_of("Option \"seed\" WorldBegin"),
              "<string>:1:15: error: expected a value for the option \"seed\", found WorldBegin");
}

TEST(PbrtDirective, PixelFilter) {
    EXPECT_EQ(parse_scene("PixelFilter \"mitchell\" WorldBegin").filter.type, "mitchell");
}

TEST(PbrtDirective, ReverseOrientation) {
    EXPECT_TRUE(first_shape("ReverseOrientation").reverse_orientation);
    EXPECT_FALSE(first_shape("ReverseOrientation ReverseOrientation").reverse_orientation);
}

TEST(PbrtDirective, Rotate) {
    expect_near(moved("Rotate 90 0 0 2", {1, 0, 0}), {0, 1, 0});
    EXPECT_EQ(errors_of(in_world("Rotate 90 0 0 0")),
              "<string>:2:1: error: Rotate about the axis 0 0 0; expected an axis that is not zero");
}

TEST(PbrtDirective, Sampler) {
    EXPECT_EQ(parse_scene("Sampler \"halton\" \"integer pixelsamples\" 4 WorldBegin").sampler.type, "halton");
}

TEST(PbrtDirective, ScaleAndTranslate) {
    expect_near(moved("Translate 1 2 3 Scale 2 3 4", {1, 1, 1}), {3, 5, 7});
    EXPECT_EQ(errors_of(in_world("Scale 1 0 1")),
              "<string>:2:1: error: Scale 1 0 1 gives a transformation that cannot be inverted");
    EXPECT_EQ(errors_of(in_world("Translate 1 x 1")), "<string>:2:13: error: \"x\" is not a number");
}

TEST(PbrtDirective, Shape) {
    ShapeNode shape = first_shape("");
    EXPECT_EQ(shape.node.type, "sphere");
    EXPECT_EQ(shape.node.place.text(), "<string>:3:1");
}

TEST(PbrtDirective, Texture) {
    SceneDescription scene =
        parse_scene(in_world("Scale 2 2 2 Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 3\n"
                             "Texture \"t\" \"float\" \"constant\""));
    ASSERT_THAT(scene.textures, SizeIs(2)) << "float and spectrum textures have names of their own";
    EXPECT_EQ(scene.textures[0].node.name, "t");
    EXPECT_EQ(scene.textures[0].node.type, "checkerboard");
    EXPECT_TRUE(scene.textures[0].is_spectrum);
    EXPECT_EQ(scene.textures[0].world_from_texture.start, Matrix4::scale({2, 2, 2}));
    EXPECT_FALSE(scene.textures[1].is_spectrum);
    EXPECT_EQ(errors_of(in_world("Texture \"t\" \"int\" \"constant\"")),
              "<string>:2:1: error: texture \"t\" is of type \"int\"; expected \"float\" or \"spectrum\"");
}

TEST(PbrtDirective, TransformBeginAndEnd) {
    SceneDescription scene =
        parse_scene(in_world("TransformBegin Translate 1 0 0 TransformEnd Shape \"sphere\""));
    EXPECT_EQ(scene.world.shapes.at(0).world_from_object, Motion{});
    EXPECT_EQ(
        warnings_of(in_world("TransformBegin TransformEnd TransformBegin TransformEnd")),
        "<string>:2:1: warning: TransformBegin and TransformEnd are deprecated and act as AttributeBegin and "
        "AttributeEnd: other attributes are restored too");
}

TEST(PbrtDirective, TransformTimes) {
    SceneDescription scene = parse_scene("TransformTimes .25 .75 WorldBegin");
    EXPECT_EQ(scene.time_start, .25f);
    EXPECT_EQ(scene.time_end, .75f);
    EXPECT_EQ(errors_of("TransformTimes 1 0 WorldBegin"),
              "<string>:1:1: error: TransformTimes 1 0; expected the start before the end");
    // The same to a float, and beyond it.
    EXPECT_NE(errors_of("TransformTimes 1 1.00000001 WorldBegin"), "");
    EXPECT_NE(errors_of("TransformTimes -1e300 1e300 WorldBegin"), "");
}

TEST(PbrtDirective, WorldBeginResetsTransformationsOnly) {
    SceneDescription scene = parse_scene(
        "ColorSpace \"rec2020\" ActiveTransform StartTime Translate 1 2 3 WorldBegin Translate 1 0 0 "
        "Shape \"sphere\" \"rgb a\" [1 1 1]");
    const ShapeNode& shape = scene.world.shapes.at(0);
    EXPECT_EQ(shape.world_from_object.start, Matrix4::translate({1, 0, 0}));
    EXPECT_FALSE(shape.world_from_object.is_animated());
    EXPECT_EQ(shape.node.parameters.at(0).color_space, "rec2020");
}

TEST(PbrtDirective, OlderNamesAreTold) {
    EXPECT_EQ(errors_of("Film \"image\" WorldBegin"),
              "<string>:1:1: error: film \"image\" is an older pbrt's name; pbrt-v4 calls it \"rgb\"; "
              "--lenient would use "
              "\"rgb\" instead");
    EXPECT_EQ(
        errors_of(in_world("Material \"matte\" \"rgb Kd\" [1 1 1]")),
        "<string>:2:1: error: material \"matte\" is an older pbrt's name; pbrt-v4 calls it \"diffuse\"; with "
        "\"reflectance\" for \"Kd\"; --lenient would use \"diffuse\" instead\n"
        "<string>:2:18: error: parameter \"Kd\" is an older pbrt's name; pbrt-v4 calls it \"reflectance\"; "
        "--lenient would "
        "use \"reflectance\" instead");
    EXPECT_EQ(errors_of(in_world("WorldEnd")), "<string>:2:1: error: directive \"WorldEnd\" is an older "
                                               "pbrt's; pbrt-v4 has nothing of that name: the world ends "
                                               "where the file ends; --lenient would leave it out");
    EXPECT_EQ(errors_of(in_world("LightSource \"infinite\" \"string mapname\" \"a.exr\"")),
              "<string>:2:24: error: parameter \"mapname\" is an older pbrt's name; pbrt-v4 calls it "
              "\"filename\"; --lenient "
              "would use \"filename\" instead");
}

// Files of the old material are none that the one of measurements reads.
TEST(PbrtDirective, AnOldMaterialWithoutSuccessorIsMatte) {
    const std::string text = "Material \"fourier\" \"string bsdffile\" \"paint.bsdf\"";
    const std::string told = "material \"fourier\" is an older pbrt's; pbrt-v4 has nothing of that name: "
                             "\"measured\" reads files of another format; ";
    EXPECT_EQ(errors_of(in_world(text)),
              "<string>:2:1: error: " + told + "--lenient would use \"diffuse\" instead");
    Messages messages;
    messages.lenient = true;
    SceneDescription scene = read_pbrt_string("WorldBegin " + text, {}, messages);
    EXPECT_EQ(scene.materials.at(0).type, "diffuse");
    ASSERT_THAT(messages.warnings(), SizeIs(1));
    EXPECT_THAT(messages.list()[0].text, told + "using \"diffuse\" instead");
}

TEST(PbrtDirective, LenientReadsOlderNames) {
    Messages messages;
    messages.lenient = true;
    SceneDescription scene = read_pbrt_string(
        "Film \"image\" \"float scale\" 2\nWorldBegin Material \"matte\" \"rgb Kd\" [1 1 1] WorldEnd", {},
        messages);
    EXPECT_EQ(scene.film.type, "rgb");
    EXPECT_THAT(scene.film.parameters, IsEmpty()) << "a scale is not an iso";
    EXPECT_EQ(scene.materials.at(0).type, "diffuse");
    EXPECT_TRUE(scene.materials.at(0).find("reflectance"));
    EXPECT_THAT(messages.warnings(), SizeIs(5));
}

} // namespace
} // namespace alhazen
