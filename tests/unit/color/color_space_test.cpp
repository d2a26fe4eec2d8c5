#include "color/color_space.h"

#include <gtest/gtest.h>

namespace alhazen {
namespace {

void expect_near(Vec3d a, Vec3d b, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

TEST(Matrix3, InverseAndProduct) {
    Matrix3 m{{{{2, 1, 0}, {-1, 3, 4}, {0.5, 0, 1}}}};
    Matrix3 identity = m * m.inverse();
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(identity.m[i][j], i == j, 1e-14);
    }
    EXPECT_EQ(m * Vec3d(1, 2, 3), Vec3d(4, 17, 3.5));
    Matrix3 singular{{{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}}};
    EXPECT_EQ(singular.inverse(), Matrix3{});
}

TEST(ColorSpace, AreFoundByName) {
    for (const std::string& name : color_space_names()) {
        const RgbColorSpace* space = find_color_space(name);
        ASSERT_NE(space, nullptr);
        EXPECT_EQ(space->name, name);
    }
    EXPECT_EQ(find_color_space("sRGB"), &srgb_space());
    EXPECT_EQ(find_color_space("DCI-P3")->name, "dci-p3");
    EXPECT_EQ(find_color_space("adobe"), nullptr);
    EXPECT_EQ(color_space_names().size(), 4u);
}

// IEC 61966-2-1 gives this matrix, for a white of (0.3127, 0.3290).
TEST(ColorSpace, SrgbMatrixIsTheStandards) {
    const double standard[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            EXPECT_NEAR(srgb_space().xyz_from_rgb.m[i][j], standard[i][j], 3e-4);
    }
    EXPECT_NEAR(srgb_space().white.x, 0.3127, 1e-4);
    EXPECT_NEAR(srgb_space().white.y, 0.3290, 1e-4);
}

TEST(ColorSpace, WhiteAndPrimariesMapToTheirChromaticity) {
    for (const std::string& name : color_space_names()) {
        const RgbColorSpace& s = *find_color_space(name);
        Vec3d white = s.xyz_from_rgb * Vec3d(1, 1, 1);
        EXPECT_NEAR(white.y, 1, 1e-12);
        expect_near(white, cie_integrals(*s.illuminant) / cie_integrals(*s.illuminant).y, 1e-12);
        Vec2d red = chromaticity(s.xyz_from_rgb * Vec3d(1, 0, 0));
        EXPECT_NEAR(red.x, s.red.x, 1e-12);
        EXPECT_NEAR(red.y, s.red.y, 1e-12);
        Vec2d blue = chromaticity(s.xyz_from_rgb * Vec3d(0, 0, 1));
        EXPECT_NEAR(blue.x, s.blue.x, 1e-12);
        EXPECT_NEAR(blue.y, s.blue.y, 1e-12);
    }
}

TEST(ColorSpace, ConversionsComeBack) {
    Vec3d color(0.2, 0.7, 0.4);
    for (const std::string& from : color_space_names()) {
        for (const std::string& to : color_space_names()) {
            const RgbColorSpace &a = *find_color_space(from), &b = *find_color_space(to);
            expect_near(convert_rgb(b, a) * (convert_rgb(a, b) * color), color, 1e-12);
            expect_near(a.rgb_from_xyz * (a.xyz_from_rgb * color), color, 1e-12);
        }
    }
    EXPECT_EQ(convert_rgb(srgb_space(), srgb_space()), Matrix3{});
    // Spaces of the same white share it.
    expect_near(convert_rgb(srgb_space(), *find_color_space("rec2020")) * Vec3d(1, 1, 1), {1, 1, 1}, 1e-12);
}

TEST(ColorSpace, AdaptationMovesWhiteToWhite) {
    Vec2d a(0.44757, 0.40745), d65(0.31272, 0.32903);
    expect_near(adapt_white(a, d65) * xyz_from_chromaticity(a), xyz_from_chromaticity(d65), 1e-12);
    expect_near(adapt_white(a, a) * Vec3d(0.3, 0.2, 0.1), {0.3, 0.2, 0.1}, 1e-12);
}

// Lindbloom's published Bradford matrix from D50 (0.96422, 1, 0.82521) to D65 (0.95047, 1, 1.08883).
TEST(ColorSpace, AdaptationIsBradfords) {
    Matrix3 m = adapt_white(chromaticity({0.96422, 1, 0.82521}), chromaticity({0.95047, 1, 1.08883}));
    const double published[3][3] = {{0.9555766, -0.0230393, 0.0631636},
                                    {-0.0282895, 1.0099416, 0.0210077},
                                    {0.0122982, -0.0204830, 1.3299098}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(m.m[i][j], published[i][j], 1e-5);
    }
}

} // namespace
} // namespace alhazen
