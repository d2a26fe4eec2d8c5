#include <gtest/gtest.h>

#include "base/arena.h"
#include "base/file.h"
#include "base/frame.h"
#include "base/hash.h"
#include "base/messages.h"
#include "base/transform.h"

namespace alhazen {
namespace {

Vec3 random_vector(Rng& rng) {
    return {rng.uniform() * 2 - 1, rng.uniform() * 2 - 1, rng.uniform() * 2 - 1};
}

TEST(Frame, IsOrthonormalAndRightHanded) {
    Rng rng(1);
    for (int i = 0; i < 1000; ++i) {
        Vec3 n = normalize(random_vector(rng));
        for (Frame f : {Frame::from_z(n), Frame::from_z_and_tangent(n, random_vector(rng))}) {
            EXPECT_NEAR(dot(f.x, f.y), 0, 1e-5f);
            EXPECT_NEAR(dot(f.x, f.z), 0, 1e-5f);
            EXPECT_NEAR(length(f.x), 1, 1e-5f);
            EXPECT_NEAR(length(cross(f.x, f.y) - n), 0, 1e-5f);
            Vec3 v = random_vector(rng);
            EXPECT_NEAR(length(f.to_world(f.to_local(v)) - v), 0, 1e-5f);
        }
    }
}

TEST(Frame, TangentAlongTheNormalStillGivesAFrame) {
    Frame f = Frame::from_z_and_tangent({0, 0, 1}, {0, 0, 3});
    EXPECT_NEAR(length(f.x), 1, 1e-6f);
    EXPECT_NEAR(f.x.z, 0, 1e-6f);
}

TEST(Transform, InverseUndoesAndNormalsStayPerpendicular) {
    Transform t(Matrix4::translate({1, 2, 3}) * Matrix4::rotate(40, {1, 2, -1}) *
                Matrix4::scale({2, 3, -.5}));
    EXPECT_TRUE(t.swaps_handedness());
    Rng rng(2);
    for (int i = 0; i < 100; ++i) {
        Vec3 p = random_vector(rng), v = random_vector(rng), w = random_vector(rng);
        EXPECT_NEAR(length(t.inverse_point(t.point(p)) - p), 0, 1e-5f);
        EXPECT_NEAR(length(t.inverse().point(t.point(p)) - p), 0, 1e-5f);
        Vec3 n = cross(v, w);
        EXPECT_NEAR(dot(t.normal(n), t.vector(v)), 0, 1e-4f);
    }
}

TEST(Transform, SingularMatrixHasNoInverse) {
    EXPECT_FALSE(Matrix4::scale({1, 0, 1}).inverse());
    EXPECT_FALSE(Matrix4::scale({1, std::nan(""), 1}).inverse());
}

TEST(Transform, LookAtPutsTargetOnZ) {
    auto m = Matrix4::look_at({1, 2, 3}, {4, -1, 7}, {0, 1, 0});
    ASSERT_TRUE(m);
    Vec3d target = Transform(*m).point(Vec3d{4, -1, 7});
    EXPECT_NEAR(target.x, 0, 1e-12);
    EXPECT_NEAR(target.y, 0, 1e-12);
    EXPECT_NEAR(target.z, std::sqrt(34.0), 1e-12);
    EXPECT_GT(Transform(*m).vector(Vec3d{0, 1, 0}).y, 0);
    EXPECT_FALSE(Matrix4::look_at({1, 2, 3}, {1, 2, 3}, {0, 1, 0}));
    EXPECT_FALSE(Matrix4::look_at({0, 0, 0}, {0, 1, 0}, {0, 2, 0}));
}

TEST(Transform, PointErrorBoundsTheError) {
    Rng rng(3);
    Transform t(Matrix4::translate({1e3, -2e4, .5}) * Matrix4::rotate(77, {.3, 1, -1}) *
                Matrix4::scale({13, .7, 101}));
    for (int i = 0; i < 1000; ++i) {
        Vec3 p = random_vector(rng) * 1000.0f;
        Vec3d exact = t.point(Vec3d(p));
        Vec3 got = t.point(p), bound = t.point_error(p, {});
        for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(got[c] - exact[c]), bound[c] * 1.001);
    }
}

TEST(Ray, OffsetOriginLeavesTheSurfaceOnTheRightSide) {
    Vec3 p{1e6f, 1, 1e-6f}, error{.5f, 1e-6f, 1e-12f}, n = normalize(Vec3{1, 1, 1});
    Vec3 out = offset_origin(p, error, n, {0, 1, 0});
    Vec3 in = offset_origin(p, error, n, {0, -1, 0});
    EXPECT_GT(dot(out - p, n), 0);
    EXPECT_LT(dot(in - p, n), 0);
}

TEST(Arena, ReusesItsBlocksAndKeepsAlignment) {
    Arena arena(256);
    void* first = arena.allocate(100);
    arena.allocate(1000);
    void* aligned = arena.allocate(8, 64);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % 64, 0u);
    arena.reset();
    EXPECT_EQ(arena.allocate(100), first);
    auto mark = arena.mark();
    int* a = arena.make<int>(1);
    arena.rewind(mark);
    EXPECT_EQ(arena.make<int>(2), a);
}

TEST(Messages, NearestNameForgivesTyposAndNothingElse) {
    std::vector<std::string> names{"diffuse", "dielectric", "conductor"};
    EXPECT_EQ(nearest_name("difuse", names), "diffuse");
    EXPECT_EQ(nearest_name("Dielectirc", names), "dielectric");
    EXPECT_EQ(nearest_name("velvet", names), "");
    EXPECT_EQ(did_you_mean("velvet", names), "; known: diffuse, dielectric, conductor");
}

TEST(Messages, StopsAfterTwentyErrors) {
    Messages messages;
    for (std::size_t i = 1; i < Messages::max_errors; ++i) messages.add_error({}, "bad");
    EXPECT_THROW(messages.add_error({}, "one too many"), SceneError);
}

TEST(Messages, LenientTurnsUnsupportedIntoAWarning) {
    Messages messages;
    messages.lenient = true;
    messages.add_unsupported(Place::of_file("a.pbrt"), "unknown film \"image\"", "\"rgb\"");
    messages.add_unsupported({}, "unknown shape \"blob\"", Remedy::leave_out());
    messages.add_unsupported({}, "unknown parameter \"x\"", Remedy::ignore());
    EXPECT_EQ(messages.error_count(), 0u);
    auto list = messages.list();
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ(list[0].full_text(), "a.pbrt: warning: unknown film \"image\"; using \"rgb\" instead");
    EXPECT_EQ(list[1].full_text(), "warning: unknown shape \"blob\"; leaving it out");
    EXPECT_EQ(list[2].full_text(), "warning: unknown parameter \"x\"; ignoring it");
}

TEST(Messages, SaysWhatLenientWouldDo) {
    Messages messages;
    messages.add_unsupported({}, "a", Remedy::use("b", ", or so"));
    messages.add_unsupported({}, "a", Remedy::leave_out());
    messages.add_unsupported({}, "a", Remedy::ignore());
    auto list = messages.list();
    EXPECT_EQ(list.at(0).text, "a; --lenient would use b instead, or so");
    EXPECT_EQ(list.at(1).text, "a; --lenient would leave it out");
    EXPECT_EQ(list.at(2).text, "a; --lenient would ignore it");
}

Place place_at(const std::string& file, std::uint32_t line, std::uint32_t column) {
    Place place = Place::of_file(file);
    place.line = line;
    place.column = column;
    return place;
}

TEST(Messages, AreInTheOrderOfTheirPlaces) {
    Messages messages;
    messages.add_error(place_at("b", 9, 1), "3");
    messages.add_error(place_at("a", 4, 1), "5");
    messages.add_warning(place_at("b", 2, 7), "2");
    messages.add_error(place_at("b", 2, 3), "1");
    messages.add_error(place_at("b", 9, 1), "4");
    try {
        messages.throw_if_errors();
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "b:2:3: error: 1\nb:2:7: warning: 2\nb:9:1: error: 3\nb:9:1: error: 4\n"
                                   "a:4:1: error: 5");
        std::string texts;
        for (const Message& m : messages.list()) texts += m.text;
        EXPECT_EQ(texts, "12345");
    }
}

TEST(Messages, WarningsOfOneTextAreCounted) {
    Messages messages;
    for (std::uint32_t line : {7u, 3u, 5u}) messages.add_warning(place_at("a", line, 1), "unknown hair");
    messages.add_warning(place_at("a", 4, 1), "unknown skin");
    auto list = messages.warnings();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].full_text(), "a:3:1: warning: unknown hair (and 2 more like this)");
    EXPECT_EQ(list[1].full_text(), "a:4:1: warning: unknown skin");
}

TEST(Messages, Ordinals) {
    EXPECT_EQ(ordinal(1), "1st");
    EXPECT_EQ(ordinal(2), "2nd");
    EXPECT_EQ(ordinal(3), "3rd");
    EXPECT_EQ(ordinal(4), "4th");
    for (std::size_t n : {11u, 12u, 13u, 111u}) EXPECT_EQ(ordinal(n), std::to_string(n) + "th");
    EXPECT_EQ(ordinal(1022), "1022nd");
}

TEST(File, SpellingsOfAPathAreOne) {
    const auto folder = std::filesystem::temp_directory_path() / "alhazen-real-path-test";
    std::filesystem::create_directories(folder / "inner");
    write_file(folder / "a.txt", "hello");
    std::filesystem::create_symlink(folder / "a.txt", folder / "link.txt");
    const auto real = real_path(folder / "a.txt");
    EXPECT_TRUE(real.is_absolute());
    EXPECT_EQ(real_path(folder / "inner" / ".." / "." / "a.txt"), real);
    EXPECT_EQ(real_path(folder / "link.txt"), real);
    EXPECT_NE(real_path(folder / "none.txt"), real);
    EXPECT_EQ(real_path(folder / "inner" / ".." / "none.txt"), real_path(folder / "none.txt"));
    // A link in a circle leads nowhere.
    std::filesystem::create_symlink(folder / "circle", folder / "circle");
    EXPECT_EQ(real_path(folder / "circle"), folder / "circle");
    std::filesystem::remove_all(folder);
}

TEST(File, WritesAtomicallyAndReadsBack) {
    auto folder = std::filesystem::temp_directory_path() / "alhazen-file-test";
    std::filesystem::create_directories(folder);
    write_file(folder / "a.txt", "hello");
    EXPECT_EQ(read_file(folder / "a.txt"), "hello");
    EXPECT_THROW(read_file(folder), std::runtime_error);
    EXPECT_THROW(read_file(folder / "none"), std::runtime_error);
    EXPECT_THROW(write_atomically(folder / "a.txt", [](const auto&) { throw std::runtime_error("no"); }),
                 std::runtime_error);
    EXPECT_EQ(read_file(folder / "a.txt"), "hello");
    std::filesystem::remove_all(folder);
}

TEST(Rng, BelowIsUnbiased) {
    Rng rng(4);
    int counts[7] = {};
    for (int i = 0; i < 70000; ++i) ++counts[rng.below(7)];
    double chi2 = 0;
    for (int c : counts) chi2 += (c - 10000.0) * (c - 10000.0) / 10000.0;
    EXPECT_LT(chi2, 27.9); // 6 degrees of freedom: false alarm 1e-4
}

} // namespace
} // namespace alhazen
