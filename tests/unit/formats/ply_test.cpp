#include "formats/ply.h"

#include <bit>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "base/file.h"

namespace alhazen {
namespace {

std::string header(const std::string& format, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\n" + rest + "end_header\n";
}

/// Appends a value's bytes in either order.
template <class T>
void put(std::string& out, T value, bool big) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof(T));
    out.append(raw, sizeof(T));
}

const std::string square_header = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                                  "element face 2\nproperty list uchar int vertex_indices\n";

std::string binary_square(bool big) {
    std::string ply = header(big ? "binary_big_endian" : "binary_little_endian", square_header);
    for (float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.25f}) put(ply, v, big);
    for (auto face : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        put<std::uint8_t>(ply, 3, big);
        for (int i : face) put(ply, i, big);
    }
    return ply;
}

void expect_square(const MeshData& mesh) {
    EXPECT_EQ(mesh.P, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.25f}}));
    EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_TRUE(mesh.quad_indices.empty());
    EXPECT_TRUE(mesh.N.empty());
    EXPECT_TRUE(mesh.uv.empty());
    EXPECT_TRUE(mesh.face_indices.empty());
}

TEST(Ply, Ascii) {
    expect_square(
        parse_ply(header("ascii", square_header) + "0 0 0\n1 0 0\n1 1 0\n0 1 .25\n3 0 1 2\n3 0 2 3"));
}

TEST(Ply, LinesEndAsTheyLike) {
    std::string text = header("ascii", "comment a b c d e f g h i j k l\nobj_info x\n" + square_header) +
                       "0 0 0 1\t0 0\n\n1 1 0 0 1 2.5e-1 3 0 1 2 3 0 2 3\n";
    std::string dos;
    for (char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
    expect_square(parse_ply(text));
    expect_square(parse_ply(dos));
}

TEST(Ply, BinaryOfBothOrders) {
    expect_square(parse_ply(binary_square(false)));
    expect_square(parse_ply(binary_square(true)));
}

TEST(Ply, NormalsTextureCoordinatesAndWhatIsNotUsed) {
    for (std::string uv : {"u v", "s t", "texture_u texture_v", "texture_s texture_t"}) {
        std::size_t blank = uv.find(' ');
        std::string text =
            header("ascii", "element vertex 3\nproperty uchar red\nproperty float nx\nproperty float ny\n"
                            "property float nz\nproperty list uchar int neighbours\nproperty float x\n"
                            "property float y\nproperty float z\nproperty double " +
                                uv.substr(0, blank) + "\nproperty double " + uv.substr(blank + 1) +
                                "\nelement material 2\nproperty float kd\nproperty list uchar float k\n"
                                "element face 1\nproperty list uchar uint vertex_index\n"
                                "property int face_indices\nelement edge 1\nproperty int a\n") +
            "255 0 0 1 2 7 8 1 2 3 .5 .25\n0 0 1 0 0 4 5 6 0 1\n0 1 0 0 1 7 7 8 9 1 0\n"
            "1 2 .5 .5\n2 0\n3 0 1 2 42\n7\n";
        MeshData mesh = parse_ply(text);
        EXPECT_EQ(mesh.P, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
        EXPECT_EQ(mesh.N, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
        EXPECT_EQ(mesh.uv, (std::vector<Vec2>{{.5f, .25f}, {0, 1}, {1, 0}}));
        EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2}));
        EXPECT_EQ(mesh.face_indices, (std::vector<int>{42}));
    }
}

template <class Position, class Length, class Index>
void expect_types(const std::string& position, const std::string& length, const std::string& index) {
    for (bool big : {false, true}) {
        std::string ply = header(big ? "binary_big_endian" : "binary_little_endian",
                                 "element vertex 3\nproperty " + position + " x\nproperty " + position +
                                     " y\nproperty " + position + " z\nelement face 1\nproperty list " +
                                     length + " " + index + " vertex_indices\n");
        for (int v : {1, 2, 3, 4, 5, 6, 7, 8, 100}) put(ply, static_cast<Position>(v), big);
        put(ply, static_cast<Length>(3), big);
        for (int i : {2, 1, 0}) put(ply, static_cast<Index>(i), big);
        MeshData mesh = parse_ply(ply);
        EXPECT_EQ(mesh.P, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 100}})) << position << big;
        EXPECT_EQ(mesh.indices, (std::vector<int>{2, 1, 0})) << length << ' ' << index << big;
    }
}

TEST(Ply, EveryScalarType) {
    expect_types<std::int8_t, std::int8_t, std::int8_t>("char", "char", "char");
    expect_types<std::uint8_t, std::uint8_t, std::uint8_t>("uint8", "uint8", "uint8");
    expect_types<std::int16_t, std::int16_t, std::int16_t>("short", "int16", "short");
    expect_types<std::uint16_t, std::uint16_t, std::uint16_t>("ushort", "ushort", "uint16");
    expect_types<std::int32_t, std::int32_t, std::int32_t>("int", "int32", "int");
    expect_types<std::uint32_t, std::uint32_t, std::uint32_t>("uint", "uint", "uint32");
    expect_types<float, std::uint8_t, std::int32_t>("float32", "uchar", "int");
    expect_types<double, std::uint8_t, std::int32_t>("double", "uchar", "int32");
    expect_types<double, std::uint8_t, std::int32_t>("float64", "uint8", "int32");
}

TEST(Ply, FacesBeforeVertices) {
    MeshData mesh =
        parse_ply(header("ascii", "element face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
                                  "property float x\nproperty float y\nproperty float z\n") +
                  "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_EQ(mesh.P.size(), 3u);
    EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2}));
}

std::string mixed_faces(bool binary) {
    std::string rest = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 4\nproperty list uchar int vertex_indices\nproperty int face_indices\n";
    if (!binary)
        return header("ascii", rest) +
               "0 0 0 1 0 0 1 1 0 0 1 0 2 2 2\n3 0 1 2 10\n4 0 1 2 3 11\n3 2 3 4 12\n4 1 2 3 4 13\n";
    std::string ply = header("binary_little_endian", rest);
    for (int i = 0; i < 15; ++i) put(ply, static_cast<float>(i), false);
    auto face = [&](std::initializer_list<int> corners, int number) {
        put(ply, static_cast<std::uint8_t>(corners.size()), false);
        for (int c : corners) put(ply, c, false);
        put(ply, number, false);
    };
    face({0, 1, 2}, 10);
    face({0, 1, 2, 3}, 11);
    face({2, 3, 4}, 12);
    face({1, 2, 3, 4}, 13);
    return ply;
}

TEST(Ply, QuadrilateralsAreKeptInPatchOrder) {
    for (bool binary : {false, true}) {
        MeshData mesh = parse_ply(mixed_faces(binary));
        EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2, 2, 3, 4}));
        EXPECT_EQ(mesh.quad_indices, (std::vector<int>{0, 1, 3, 2, 1, 2, 4, 3}));
        EXPECT_EQ(mesh.face_indices, (std::vector<int>{10, 12, 11, 13}));
    }
}

TEST(Ply, OddFacesAreLeftOutAndCounted) {
    MeshData mesh = parse_ply(
        header("ascii",
               "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 4\nproperty list uchar int vertex_indices\nproperty int face_indices\n") +
        "0 0 0 1 0 0 1 1 0 0 1 0 2 2 2\n3 0 1 2 10\n5 0 1 2 3 4 11\n3 2 3 4 12\n2 0 1 13\n");
    EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2, 2, 3, 4}));
    EXPECT_EQ(mesh.face_indices, (std::vector<int>{10, 12}));
    EXPECT_EQ(mesh.odd_faces, 2u);
    EXPECT_THAT(mesh.first_odd_face, testing::EndsWith("face 1 has 5 vertices; expected 3 or 4"));
    EXPECT_EQ(mesh.first_odd_face.substr(0, 5), "line ");
}

TEST(Ply, SplitsQuadrilaterals) {
    MeshData mesh = parse_ply(mixed_faces(false));
    split_quads(mesh);
    EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2, 2, 3, 4, 0, 1, 2, 0, 2, 3, 1, 2, 3, 1, 3, 4}));
    EXPECT_TRUE(mesh.quad_indices.empty());
    EXPECT_EQ(mesh.face_indices, (std::vector<int>{10, 12, 11, 11, 13, 13}));
}

TEST(Ply, ATriangleRunMayEndInQuadrilaterals) {
    // The short cut for triangles must hand over at the first face that is none.
    std::string ply = header("binary_little_endian", "element vertex 4\nproperty float x\nproperty float y\n"
                                                     "property float z\nelement face 3\n"
                                                     "property list uchar int vertex_indices\n");
    for (int i = 0; i < 12; ++i) put(ply, static_cast<float>(i), false);
    for (std::vector<int> face : {std::vector{0, 1, 2}, {0, 1, 2, 3}, {3, 2, 1}}) {
        put(ply, static_cast<std::uint8_t>(face.size()), false);
        for (int c : face) put(ply, c, false);
    }
    MeshData mesh = parse_ply(ply);
    EXPECT_EQ(mesh.indices, (std::vector<int>{0, 1, 2, 3, 2, 1}));
    EXPECT_EQ(mesh.quad_indices, (std::vector<int>{0, 1, 3, 2}));
}

TEST(Ply, ReadsFilesPlainAndCompressed) {
    std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "alhazen_ply";
    std::filesystem::create_directories(folder);
    std::string ply = binary_square(false);
    write_file(folder / "a.ply", ply);
    expect_square(read_ply(folder / "a.ply"));
    gzFile out = gzopen((folder / "a.ply.gz").c_str(), "wb");
    ASSERT_EQ(gzwrite(out, ply.data(), static_cast<unsigned>(ply.size())), static_cast<int>(ply.size()));
    gzclose(out);
    expect_square(read_ply(folder / "a.ply.gz"));
    MeshReader reader = read_ply;
    EXPECT_THROW(reader(folder / "none.ply"), std::runtime_error);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace alhazen
