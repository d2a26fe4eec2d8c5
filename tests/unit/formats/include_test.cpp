#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/file.h"
#include "parse.h"

namespace alhazen {
namespace {

using testing::SizeIs;

/// A folder of its own for each test.
class PbrtFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("alhazen_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_ / "sub");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { write_file(folder_ / name, text); }
    void write_compressed(const std::string& name, const std::string& text) {
        gzFile out = gzopen((folder_ / name).c_str(), "wb");
        gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
        gzclose(out);
    }
    SceneDescription read(const std::string& name) {
        Messages messages;
        return read_scene(folder_ / name, messages);
    }
    /// The errors, with the folder's name taken out.
    std::string fault(const std::string& name) {
        std::string text;
        try {
            read(name);
        } catch (const SceneError& error) {
            text = error.what();
        }
        std::string prefix = folder_.string() + "/";
        for (std::size_t at; (at = text.find(prefix)) != std::string::npos;) text.erase(at, prefix.size());
        return text;
    }

    std::filesystem::path folder_;
};

TEST_F(PbrtFiles, IncludesAreRelativeToTheMainFile) {
    write("a.pbrt", "WorldBegin Include \"sub/b.pbrt\" Shape \"sphere\"");
    write("sub/b.pbrt", "Translate 1 0 0 Include \"sub/c.pbrt\"");
    write("sub/c.pbrt", "Translate 1 0 0");
    SceneDescription scene = read("a.pbrt");
    EXPECT_EQ(scene.world.shapes.at(0).world_from_object.start, Matrix4::translate({2, 0, 0}))
        << "an Include shares the state";
    EXPECT_EQ(scene.base_folder, folder_);
    EXPECT_EQ(scene.file, folder_ / "a.pbrt");
}

TEST_F(PbrtFiles, CompressedFilesAreRead) {
    write_compressed("a.pbrt.gz", "WorldBegin Include \"b.pbrt.gz\" Import \"c.pbrt\"");
    write_compressed("b.pbrt.gz", "Shape \"sphere\"");
    write_compressed("c.pbrt", "Shape \"disk\"");
    EXPECT_THAT(read("a.pbrt.gz").world.shapes, SizeIs(2));
}

TEST_F(PbrtFiles, ImportsHaveAStateOfTheirOwn) {
    write("a.pbrt", "WorldBegin Translate 1 0 0 CoordinateSystem \"here\" Import \"b.pbrt\" Shape \"sphere\" "
                    "NamedMaterial \"m\" "
                    "Shape \"disk\" ObjectInstance \"o\"");
    write("b.pbrt", "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" Translate 1 0 0 Material "
                    "\"conductor\" Shape \"sphere\" "
                    "CoordSysTransform \"here\" Shape \"sphere\" ObjectBegin \"o\" Shape \"disk\" ObjectEnd");
    SceneDescription scene = read("a.pbrt");
    ASSERT_THAT(scene.world.shapes, SizeIs(4));
    EXPECT_EQ(scene.world.shapes[0].world_from_object.start, Matrix4::translate({2, 0, 0}));
    EXPECT_EQ(scene.world.shapes[0].material, 1);
    EXPECT_EQ(scene.world.shapes[1].world_from_object.start, Matrix4::translate({1, 0, 0}));
    EXPECT_EQ(scene.world.shapes[2].world_from_object.start, Matrix4::translate({1, 0, 0}));
    EXPECT_EQ(scene.world.shapes[2].material, -1);
    EXPECT_EQ(scene.world.shapes[3].material_name, "m");
}

TEST_F(PbrtFiles, ImportsInAnObjectAreOfTheObject) {
    write("a.pbrt", "WorldBegin ObjectBegin \"o\" AttributeBegin Import \"b.pbrt\" AttributeEnd Shape "
                    "\"sphere\" ObjectEnd "
                    "ObjectInstance \"o\"");
    write("b.pbrt", "Shape \"disk\"");
    SceneDescription scene = read("a.pbrt");
    EXPECT_THAT(scene.world.shapes, SizeIs(0));
    EXPECT_THAT(scene.objects.at(0).shapes, SizeIs(2));
}

TEST_F(PbrtFiles, BlocksEndInTheirImport) {
    write("a.pbrt", "WorldBegin AttributeBegin Import \"b.pbrt\" AttributeEnd");
    write("b.pbrt", "AttributeEnd");
    EXPECT_EQ(fault("a.pbrt"), "b.pbrt:1:1: error: AttributeEnd without an AttributeBegin");
    write("b.pbrt", "\n AttributeBegin");
    EXPECT_EQ(fault("a.pbrt"), "b.pbrt:2:2: error: AttributeBegin without AttributeEnd");
    write("a.pbrt", "WorldBegin ObjectBegin \"o\" Import \"b.pbrt\" ObjectEnd");
    write("b.pbrt", "ObjectEnd");
    EXPECT_EQ(
        fault("a.pbrt"),
        "b.pbrt:1:1: error: ObjectEnd in an imported file; expected it in the file that has the ObjectBegin");
    write("a.pbrt", "Import \"b.pbrt\" WorldBegin");
    EXPECT_EQ(fault("a.pbrt"), "a.pbrt:1:1: error: Import before WorldBegin; expected it after");
}

TEST_F(PbrtFiles, AnIncludeMayCloseABlockOfItsIncluder) {
    write("a.pbrt", "WorldBegin AttributeBegin Include \"b.pbrt\"");
    write("b.pbrt", "AttributeEnd");
    EXPECT_EQ(fault("a.pbrt"), "");
}

TEST_F(PbrtFiles, FilesThatIncludeThemselves) {
    write("a.pbrt", "WorldBegin\nInclude \"a.pbrt\"");
    EXPECT_EQ(fault("a.pbrt"), "a.pbrt:2:1: error: \"a.pbrt\" includes itself");
    write("a.pbrt", "WorldBegin\nInclude \"sub/b.pbrt\"");
    write("sub/b.pbrt", "Import \"./sub/../a.pbrt\"");
    EXPECT_EQ(fault("a.pbrt"), "sub/b.pbrt:1:1: error: \"./sub/../a.pbrt\" includes itself");
}

TEST_F(PbrtFiles, IncludesGoSixtyFourDeep) {
    auto name = [](int i) { return "f" + std::to_string(i) + ".pbrt"; };
    for (int i = 1; i < 65; ++i) write(name(i), "Include \"" + name(i + 1) + "\"");
    write(name(0), "WorldBegin Include \"" + name(1) + "\"");
    write(name(64), "Shape \"sphere\"");
    EXPECT_EQ(fault(name(0)), "");
    write(name(64), "Include \"f65.pbrt\"");
    write(name(65), "Shape \"sphere\"");
    EXPECT_EQ(fault(name(0)), "f64.pbrt:1:1: error: files included more than 64 deep");
}

TEST_F(PbrtFiles, WhatCannotBeRead) {
    write("a.pbrt", "WorldBegin\n  Include \"none.pbrt\"\nInclude \"sub\" Include 5");
    EXPECT_EQ(fault("a.pbrt"), "a.pbrt:2:3: error: cannot read \"none.pbrt\": no such file\n"
                               "a.pbrt:3:1: error: cannot read \"sub\": is a directory, not a file\n"
                               "a.pbrt:3:23: error: expected a file name in quotes, found 5");
    EXPECT_EQ(fault("none.pbrt"), "none.pbrt: error: cannot read the scene: no such file");
    EXPECT_EQ(fault("sub"),
              "sub: error: a file name without a suffix; expected a scene in one of: .pbrt (pbrt-v4)");
    EXPECT_EQ(fault("a.blend"),
              "a.blend: error: unknown scene format \".blend\"; expected a scene in one of: .pbrt (pbrt-v4)");
    write("cut.pbrt.gz", std::string("\x1f\x8b\x08\x00\x00", 5));
    EXPECT_EQ(fault("cut.pbrt.gz"), "cut.pbrt.gz: error: cannot read the scene: truncated gzip data");
}

TEST_F(PbrtFiles, ErrorsAfterAnIncludeStillNameTheRightFile) {
    write("a.pbrt", "WorldBegin Include \"b.pbrt\"\nFoo");
    write("b.pbrt", "\nBar");
    EXPECT_EQ(fault("a.pbrt"),
              "b.pbrt:2:1: error: unknown directive Bar\na.pbrt:2:1: error: unknown directive Foo");
}

} // namespace
} // namespace alhazen
