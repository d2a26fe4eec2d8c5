/// Meshes that are wrong, each with the message it must give. None may crash, hang or ask for absurd memory.
#include <cstring>

#include <gtest/gtest.h>

#include "base/hash.h"
#include "formats/ply.h"

namespace alhazen {
namespace {

std::string ply_fault(const std::string& ply) {
    try {
        return parse_ply(ply).first_odd_face;
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string list = "property list uchar int vertex_indices\n";

std::string ascii(const std::string& elements, const std::string& body = "") {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}
std::string triangle(const std::string& body) {
    return ascii("element vertex 3\n" + xyz + "element face 1\n" + list, body);
}
std::string binary(const std::string& elements, const std::string& body,
                   const std::string& order = "little") {
    return "ply\nformat binary_" + order + "_endian 1.0\n" + elements + "end_header\n" + body;
}
template <class T>
std::string bytes(std::initializer_list<T> values) {
    std::string out;
    for (T v : values) {
        char raw[sizeof(T)];
        std::memcpy(raw, &v, sizeof(T));
        out.append(raw, sizeof(T));
    }
    return out;
}

TEST(MalformedPly, Headers) {
    std::string format = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(ply_fault(""), "line 1: not a PLY file; expected \"ply\"");
    EXPECT_EQ(ply_fault("solid\n"), "line 1: not a PLY file; expected \"ply\"");
    EXPECT_EQ(ply_fault(std::string(100000, '\0')), "line 1: not a PLY file; expected \"ply\"");
    EXPECT_EQ(ply_fault("ply\n"), "line 1: expected \"format\"");
    EXPECT_EQ(ply_fault("ply\nelement vertex 3\n"), "line 2: expected \"format\"");
    EXPECT_EQ(ply_fault("ply\nformat\n"), "line 2: expected \"format\", an encoding and a version");
    EXPECT_EQ(ply_fault("ply\nformat text 1.0\n"),
              "line 2: unknown format \"text\"; expected ascii, binary_little_endian or binary_big_endian");
    EXPECT_EQ(ply_fault("ply\nformat ascii 2.0\n"), "line 2: unknown format version \"2.0\"; expected 1.0");
    EXPECT_EQ(ply_fault(format + "element vertex 3\n"), "line 3: the header has no \"end_header\"");
    EXPECT_EQ(ply_fault(format + "element vertex\n"), "line 3: expected \"element\", a name and a count");
    EXPECT_EQ(ply_fault(format + "element vertex -3\n"),
              "line 3: bad count \"-3\" of element \"vertex\"; expected a whole number, not negative");
    EXPECT_EQ(ply_fault(format + "element vertex 99999999999999999999\n"),
              "line 3: bad count \"99999999999999999999\" of element \"vertex\"; expected a whole number, "
              "not negative");
    EXPECT_EQ(ply_fault(format + "element face 1\nelement face 1\n"),
              "line 4: element \"face\" is declared twice");
    EXPECT_EQ(ply_fault(format + "property float x\n"), "line 3: a property before any element");
    EXPECT_EQ(ply_fault(format + "element a 1\nproperty half x\n"), "line 4: unknown property type \"half\"");
    EXPECT_EQ(ply_fault(format + "element a 1\nproperty float\n"),
              "line 4: expected \"property\", a type and a name");
    EXPECT_EQ(ply_fault(format + "element a 1\nproperty list float int x\n"),
              "line 4: a list whose length is not of a whole-number type");
    EXPECT_EQ(ply_fault(format + "elemnt a 1\n"), "line 3: unknown word \"elemnt\" in the header");
}

TEST(MalformedPly, Contents) {
    EXPECT_EQ(ply_fault(ascii("")), "the file has no vertices");
    EXPECT_EQ(ply_fault(ascii("element vertex 0\n" + xyz + "element face 1\n" + list)),
              "the file has no vertices");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\n" + xyz)), "the file has no faces");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\n" + xyz + "element face 0\n" + list)),
              "the file has no faces");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\nproperty float x\nelement face 1\n" + list)),
              "the vertices have no x, y and z");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\nelement face 1\n" + list)),
              "the vertices have no x, y and z");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\n" + xyz + "element face 1\nproperty int a\n")),
              "the faces have no list vertex_indices");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\n" + xyz + "element face 1\nproperty int vertex_indices\n")),
              "the faces have no list vertex_indices");
    EXPECT_EQ(ply_fault(ascii("element vertex 3\n" + xyz +
                              "element face 1\nproperty list uchar float vertex_indices\n")),
              "the faces' vertex_indices are not of a whole-number type");
}

TEST(MalformedPly, AsciiBodies) {
    std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
    ASSERT_EQ(ply_fault(triangle(corners + "3 0 1 2\n")), "");
    EXPECT_EQ(ply_fault(triangle("")),
              "line 10: element \"vertex\" is declared 3 times; the file has room for 0 at most");
    EXPECT_EQ(ply_fault(triangle("0.000 0.000 0.0\n1.0 0\n")), "line 12: the file ends in vertex 1");
    EXPECT_EQ(ply_fault(triangle(corners)),
              "line 12: element \"face\" is declared 1 times; the file has room for 0 at most");
    EXPECT_EQ(ply_fault(triangle(corners + "3 0 1000")), "line 13: the file ends in face 0");
    EXPECT_EQ(ply_fault(triangle("0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n")),
              "line 10: expected a number in vertex 0, found \"zero\"");
    EXPECT_EQ(ply_fault(triangle("0 0 1,5\n1 0 0\n0 1 0\n3 0 1 2\n")),
              "line 10: expected a number in vertex 0, found \"1,5\"");
    EXPECT_EQ(ply_fault(triangle("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
              "vertex 1: the position is not finite");
    EXPECT_EQ(ply_fault(triangle("0 0 0\n1 0 0\n0 -inf 0\n3 0 1 2\n")),
              "vertex 2: the position is not finite");
    EXPECT_EQ(ply_fault(triangle("0 0 0\n1e99 0 0\n0 1 0\n3 0 1 2\n")),
              "vertex 1: the position is not finite");
    EXPECT_EQ(ply_fault(triangle(corners + "3 0 1 3\n")),
              "triangle 0: vertex index 3 is out of range; there are 3 vertices");
    EXPECT_EQ(ply_fault(triangle(corners + "3 0 -1 2\n")),
              "triangle 0: vertex index -1 is out of range; there are 3 vertices");
    EXPECT_EQ(ply_fault(triangle(corners + "4 0 1 2 7\n")),
              "quadrilateral 0: vertex index 7 is out of range; there are 3 vertices");
    EXPECT_EQ(ply_fault(triangle(corners + "3 0 1 5000000000\n")),
              "line 13: face 0: 5000000000 is out of range");
    EXPECT_EQ(ply_fault(triangle(corners + "2 0 1 2\n")), "line 13: face 0 has 2 vertices; expected 3 or 4");
    EXPECT_EQ(ply_fault(triangle(corners + "5 0 1 2 0 1\n")),
              "line 13: face 0 has 5 vertices; expected 3 or 4");
    EXPECT_EQ(ply_fault(triangle(corners + "-3 0 1 2\n")), "line 13: face 0 has a list of length -3");
    EXPECT_EQ(ply_fault(triangle(corners + "3 0 1.5 2\n")),
              "line 13: expected a whole number in face 0, found \"1.5\"");
}

TEST(MalformedPly, BinaryBodies) {
    std::string elements = "element vertex 3\n" + xyz + "element face 1\n" + list;
    std::string corners = bytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    std::string face = "\x03" + bytes<int>({0, 1, 2});
    std::size_t head = binary(elements, "").size();
    auto byte = [](std::size_t n) { return "byte " + std::to_string(n); };
    ASSERT_EQ(ply_fault(binary(elements, corners + face)), "");
    for (std::size_t n = 0; n < corners.size() + face.size(); ++n) {
        std::string cut = binary(elements, (corners + face).substr(0, n));
        if (n < corners.size())
            EXPECT_EQ(ply_fault(cut), byte(head) +
                                          ": element \"vertex\" is declared 3 times; the file has room for " +
                                          std::to_string(n / 12) + " at most");
        else
            EXPECT_EQ(ply_fault(cut),
                      byte(head + 36) +
                          ": element \"face\" is declared 1 times; the file has room for 0 at most");
    }
    EXPECT_EQ(ply_fault(binary(elements, corners + "\x03" + bytes<int>({0, 1, 3}))),
              "triangle 0: vertex index 3 is out of range; there are 3 vertices");
    EXPECT_EQ(ply_fault(binary(elements, corners + "\x04" + bytes<int>({0, 1, 2}))),
              byte(head + 49) + ": the file ends in face 0");
    EXPECT_EQ(ply_fault(binary(elements, corners + "\xff" + bytes<int>({0, 1, 2}))),
              byte(head + 49) + ": the file ends in face 0");
    EXPECT_EQ(ply_fault(binary("element vertex 3\n" + xyz +
                                   "element face 1\nproperty list char int vertex_indices\n",
                               corners + "\xff" + bytes<int>({0, 1, 2}))),
              byte(head - 1 + 37) + ": face 0 has a list of length -1");
    EXPECT_EQ(ply_fault(binary("element vertex 3\n" + xyz +
                                   "element face 1\nproperty list uchar uint vertex_indices\n",
                               corners + "\x04" + bytes<unsigned>({0, 1, 2, 4000000000u}))),
              byte(head + 1 + 53) + ": face 0: 4000000000 is out of range");
    float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(ply_fault(binary(elements, bytes<float>({0, 0, 0, 1, 0, 0, 0, nan, 0}) + face)),
              "vertex 2: the position is not finite");
    std::string normals = "element vertex 3\n" + xyz +
                          "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n" + list;
    EXPECT_EQ(ply_fault(binary(
                  normals, bytes<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, nan, 0, 1, 0, 0, 0, 1}) + face)),
              "vertex 1: the normal is not finite");
    std::string doubles =
        "element vertex 1\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n" + list;
    EXPECT_EQ(ply_fault(binary(doubles, bytes<double>({0, 1e300, 0}) + "\x03" + bytes<int>({0, 0, 0}))),
              "vertex 0: the position is not finite");
}

TEST(MalformedPly, CountsThatLieAskForNoMemory) {
    // Each would be tens of gigabytes.
    std::string big = "element vertex 2000000000\n" + xyz + "element face 1\n" + list;
    std::string head = std::to_string(binary(big, "").size());
    EXPECT_EQ(ply_fault(binary(big, std::string(120, '\0'))),
              "byte " + head +
                  ": element \"vertex\" is declared 2000000000 times; the file has room for 10 at most");
    std::string faces = "element vertex 1\n" + xyz + "element face 18446744073709551615\n" + list;
    head = std::to_string(binary(faces, "").size() + 12);
    EXPECT_EQ(
        ply_fault(binary(faces, std::string(12 + 26, '\0'))),
        "byte " + head +
            ": element \"face\" is declared 18446744073709551615 times; the file has room for 2 at most");
    std::string other = "element junk 18446744073709551615\nproperty uchar a\n" + big;
    head = std::to_string(binary(other, "").size());
    EXPECT_EQ(
        ply_fault(binary(other, "xyz")),
        "byte " + head +
            ": element \"junk\" is declared 18446744073709551615 times; the file has room for 3 at most");
    // An element without properties takes no room, and no time.
    std::string empty =
        "element junk 18446744073709551615\nelement vertex 3\n" + xyz + "element face 1\n" + list;
    EXPECT_EQ(ply_fault(ascii(empty, "0 0 0 1 0 0 0 1 0 3 0 1 2")), "");
    std::string lists =
        "element junk 1\nproperty list uint uchar a\nelement vertex 3\n" + xyz + "element face 1\n" + list;
    EXPECT_EQ(ply_fault(binary(lists, "\xff\xff\xff\xff    ")),
              "byte " + std::to_string(binary(lists, "").size() + 8) + ": the file ends in junk 0");
}

TEST(MalformedPly, MutatedMeshesAreReadOrRefused) {
    std::string elements = "comment c\nelement vertex 4\n" + xyz + "property uchar r\nelement face 3\n" +
                           list + "property int face_indices\n";
    std::string body;
    for (float v : {0.f, 1.f, 2.f, 3.f}) body += bytes<float>({v, v * v, 1}) + "r";
    for (int i = 0; i < 2; ++i) body += "\x03" + bytes<int>({i, 1, 2, i});
    body += "\x04" + bytes<int>({0, 1, 2, 3, 2});
    std::string text = ascii(elements, "0 0 0 1 1 0 0 1 1 1 0 1 0 1 0 1 3 0 1 2 7 3 1 2 3 8 4 0 1 2 3 9\n");
    const std::string originals[] = {binary(elements, body), binary(elements, body, "big"), text};
    ASSERT_EQ(ply_fault(originals[0]), "");
    ASSERT_EQ(ply_fault(originals[2]), "");
    Rng rng(2);
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string ply = originals[i % 3];
        for (std::uint32_t n = 1 + rng.below(3); n > 0; --n) {
            std::size_t at = rng.below(static_cast<std::uint32_t>(ply.size()));
            switch (rng.below(4)) {
            case 0:
                ply[at] = static_cast<char>(rng.below(256));
                break;
            case 1:
                ply.erase(at, rng.below(6));
                break;
            case 2:
                ply.insert(at, 1, static_cast<char>('0' + rng.below(10)));
                break;
            default:
                ply.resize(std::max<std::size_t>(1, rng.below(4) == 0 ? at : ply.size()));
                break;
            }
        }
        refused += ply_fault(ply) != "";
    }
    EXPECT_GT(refused, 1000) << "the mutations are too tame";
}

} // namespace
} // namespace alhazen
