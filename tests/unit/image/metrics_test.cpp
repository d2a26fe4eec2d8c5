#include "image/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "color/tone.h"
#include "tests/unit/image/test_images.h"

namespace alhazen {
namespace {

/// The images' values are what a display gets: the metrics undo this.
Image decoded(Image image) {
    for (float& v : image.values()) v = srgb_decode(v);
    return image;
}

struct Pair {
    const char* name;
    Image test, reference;
    double flip_67, flip_30, flip_at, ssim, psnr;
};

/// Numbers of the reference implementations, on the same 64 x 48 images made with numpy in single precision:
/// flip-evaluator 1.7 (evaluate(reference, test, "LDR"), its default of 67.02 pixels per degree, {"ppd": 30},
/// and the error map's value at x = 20, y = 12), scikit-image 0.26 (structural_similarity of the weighted sum
/// .2126 R + .7152 G + .0722 B with gaussian_weights, sigma 1.5, use_sample_covariance off, data_range 1),
/// and numpy for PSNR.
std::vector<Pair> pairs() {
    Image ramp = gradient(64, 48);
    Image box = ramp;
    for (int y = 12; y < 30; ++y)
        for (int x = 20; x < 44; ++x) box.set_rgb(x, y, {0.8f, 0.3f, 0.1f});
    Image pattern =
        rgb_of(64, 48, [](int x, int y, int c) { return ((x * 7 + y * 13 + c * 31) % 64) / 63.0; });
    Image dim = ramp;
    for (float& v : dim.values()) v = v * 0.875f + 0.0625f;
    return {{"box", box, ramp, 0.13681155, 0.12471431, 0.61711425, 0.8653685847, 18.85154163},
            {"noise", noise(64, 48), pattern, 0.36781964, 0.58230358, 0.3624533, 0.2685966948, 9.918689475},
            {"dim", dim, ramp, 0.20858932, 0.19808185, 0.1398249, 0.9925173434, 29.46998319}};
}

TEST(Flip, AgreesWithTheReferenceImplementation) {
    for (const Pair& p : pairs()) {
        SCOPED_TRACE(p.name);
        Image a = decoded(p.test), b = decoded(p.reference);
        MetricResult result = flip(a, b);
        EXPECT_NEAR(result.value, p.flip_67, 5e-5);
        EXPECT_NEAR(result.error.at(20, 12), p.flip_at, 2e-4);
        EXPECT_NEAR(flip(a, b, {30}).value, p.flip_30, 5e-5);
    }
}

TEST(Flip, BlackAgainstWhite) {
    Image black = Image::rgb_image(40, 30), white = black;
    for (float& v : white.values()) v = 1;
    // flip-evaluator 1.7 gives 0.967365.
    EXPECT_NEAR(flip(white, black).value, 0.967365, 5e-5);
}

TEST(Ssim, AgreesWithScikitImage) {
    for (const Pair& p : pairs()) {
        SCOPED_TRACE(p.name);
        EXPECT_NEAR(ssim(decoded(p.test), decoded(p.reference)).value, p.ssim, 2e-5);
    }
}

TEST(Psnr, AgreesWithItsDefinition) {
    for (const Pair& p : pairs()) {
        SCOPED_TRACE(p.name);
        EXPECT_NEAR(psnr(decoded(p.test), decoded(p.reference)).value, p.psnr, 1e-4);
    }
}

TEST(Metrics, EqualImages) {
    Image image = noise(31, 17);
    for (Metric m : {Metric::mse, Metric::relmse, Metric::flip}) {
        EXPECT_EQ(compute_metric(m, image, image).value, 0);
        EXPECT_FALSE(larger_is_better(m));
    }
    EXPECT_NEAR(ssim(image, image).value, 1, 1e-9);
    EXPECT_EQ(psnr(image, image).value, std::numeric_limits<double>::infinity());
    Image tiny = noise(2, 2);
    EXPECT_NEAR(ssim(tiny, tiny).value, 1, 1e-9);
    EXPECT_EQ(flip(tiny, tiny).value, 0);
}

TEST(Metrics, SymmetricExceptRelMse) {
    Image a = noise(31, 17), b = gradient(31, 17);
    for (Metric m : {Metric::mse, Metric::psnr, Metric::ssim, Metric::flip})
        EXPECT_NEAR(compute_metric(m, a, b).value, compute_metric(m, b, a).value, 1e-7);
    // relMSE divides by the reference.
    EXPECT_NE(relmse(a, b).value, relmse(b, a).value);
}

TEST(Metrics, KnownSmallValues) {
    Image a = Image::rgb_image(1, 1), b = a;
    a.set_rgb(0, 0, {1, 2, 3});
    b.set_rgb(0, 0, {1, 1, 1});
    EXPECT_NEAR(mse(a, b).value, (0 + 1 + 4) / 3.0, 1e-9);
    EXPECT_NEAR(relmse(a, b).value, (0 + 1 + 4) / 1.01 / 3, 1e-9);
    EXPECT_NEAR(mse(a, b).error.at(0, 0), 5 / 3.0, 1e-6);
}

TEST(RelMse, LeavesOutTheLargestThousandth) {
    // 40 x 25 pixels are 3000 terms: the three largest go. Four are fireflies, so one stays.
    Image b = Image::rgb_image(40, 25), a = b;
    for (int i = 0; i < 4; ++i) a.at(i, 0, 0) = 10;
    RelMseResult r = relmse(a, b);
    EXPECT_NEAR(r.untrimmed, 4 * 100 / 0.01 / 3000, 1e-6);
    EXPECT_NEAR(r.value, 100 / 0.01 / 2997, 1e-6);
    EXPECT_NEAR(compute_metric(Metric::relmse, a, b).value, r.value, 0);
}

TEST(Metrics, GreyComparesWithColor) {
    Image grey = Image::grey_image(12, 12), color = Image::rgb_image(12, 12);
    for (float& v : grey.values()) v = 0.25f;
    for (float& v : color.values()) v = 0.25f;
    EXPECT_EQ(mse(grey, color).value, 0);
    EXPECT_EQ(flip(grey, color).value, 0);
}

TEST(Metrics, NotFinitePixels) {
    Image a = gradient(16, 16), b = a;
    a.at(3, 3, 1) = std::numeric_limits<float>::quiet_NaN();
    // A picture that holds NaN is like no other, however it would be shown.
    for (const std::string& name : metric_names()) {
        EXPECT_TRUE(std::isnan(compute_metric(*parse_metric(name), a, b).value)) << name;
        EXPECT_TRUE(std::isnan(compute_metric(*parse_metric(name), b, a).value)) << name;
    }
    // What is infinitely bright is shown white.
    a.at(3, 3, 1) = std::numeric_limits<float>::infinity();
    b.at(3, 3, 1) = 1;
    for (Metric m : {Metric::ssim, Metric::flip})
        EXPECT_EQ(compute_metric(m, a, b).value, compute_metric(m, b, b).value);
}

TEST(Metrics, Errors) {
    Image a = gradient(4, 3), b = gradient(3, 4);
    for (const std::string& name : metric_names())
        EXPECT_ERROR(compute_metric(*parse_metric(name), a, b),
                     "images of different size: 4 x 3 and 3 x 4 pixels");
    EXPECT_ERROR(mse(Image{}, Image{}), "cannot compare images without pixels");
    EXPECT_EQ(parse_metric("rmse"), std::nullopt);
    EXPECT_EQ(parse_metric("flip"), Metric::flip);
}

TEST(HeatMap, MagmaFromDarkToBright) {
    // The first and the last colour of the published table.
    EXPECT_NEAR(magma_srgb(0).z, 0.0139, 1e-4);
    EXPECT_NEAR(magma_srgb(1).y, 0.9914, 1e-4);
    EXPECT_EQ(magma_srgb(-1), magma_srgb(0));
    EXPECT_EQ(magma_srgb(5), magma_srgb(1));
    Image error = Image::grey_image(2, 1);
    error.at(1, 0) = 0.5f;
    Image map = heat_map(error, 2);
    EXPECT_NEAR(srgb_encode(map.rgb(1, 0).x), magma_srgb(1).x, 1e-5);
    EXPECT_NEAR(srgb_encode(map.rgb(0, 0).z), magma_srgb(0).z, 1e-5);
}

} // namespace
} // namespace alhazen
