#include "image/image_colors.h"

#include <gtest/gtest.h>

#include "image/codec.h"

namespace alhazen {
namespace {

Image green() {
    Image image = Image::rgb_image(2, 1);
    image.set_rgb(0, 0, {0.2f, 0.7f, 0.1f});
    image.set_rgb(1, 0, {1, 1, 1});
    return image;
}

TEST(ImageColors, AnExrFileSaysItsColorSpace) {
    for (const std::string& name : color_space_names()) {
        WriteOptions options;
        options.depth = FloatDepth::single;
        options.metadata["color_space"] = name;
        Image read = decode_image(encode_image(".exr", green(), options), ".exr");
        EXPECT_EQ(color_space_of(read).name, name);
        EXPECT_EQ(read.rgb(0, 0), green().rgb(0, 0));
        // The chromaticities alone tell it too, as other programs write them.
        read.info.metadata.clear();
        Image anonymous = in_srgb(read);
        EXPECT_EQ(&color_space_of(anonymous), &srgb_space());
    }
}

TEST(ImageColors, ConversionKeepsTheColour) {
    Image image = green();
    image.info.metadata["color_space"] = "aces2065-1";
    const Vec3 xyz = find_color_space("aces2065-1")->to_xyz(image.rgb(0, 0));
    const Vec3 converted = srgb_space().to_xyz(in_srgb(image).rgb(0, 0));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(converted[i], xyz[i], 1e-5f);
}

} // namespace
} // namespace alhazen
