/// Texels in tiles: the same bits as in memory, within the limit, whatever threads do.
#include "textures/tile_cache.h"

#include <numeric>

#include "base/hash.h"
#include "base/threads.h"
#include "tests/unit/textures/support.h"
#include "textures/image_cache.h"

namespace alhazen {
namespace {

using testing::HasSubstr;

// What one thread keeps at most: 64 tiles, of the largest texels there are.
constexpr std::size_t held_by_thread = 64 * 32 * 32 * 16;

Image noise(int width, int height, std::vector<std::string> channels = {"R", "G", "B"}) {
    Image image(width, height, std::move(channels));
    Rng rng(static_cast<std::uint64_t>(width));
    for (float& v : image.values()) v = rng.uniform();
    return image;
}

TexelPlace any_place(Rng& rng, TexelFilter filter) {
    TexelPlace at;
    at.st = {3 * rng.uniform() - 1, 3 * rng.uniform() - 1};
    const float size = 0.2f * sqr(rng.uniform());
    at.a = {size * rng.uniform(), size * rng.uniform()};
    at.b = {size * rng.uniform(), size * rng.uniform()};
    at.filter = filter;
    return at;
}

constexpr std::array filters{TexelFilter::point, TexelFilter::bilinear, TexelFilter::trilinear,
                             TexelFilter::ewa};

class TileCacheTest : public TextureTest {
  protected:
    void expect_same_bits(const std::string& file, WrapMode wrap) {
        const ImageSource source{folder() / file, Encoding{}, wrap};
        const Wavelengths lambda = Wavelengths::sample_visible(0.3f);
        ImageCache whole, tiled;
        tiled.limit_memory(1);
        for (SpectrumRole role : {SpectrumRole::albedo, SpectrumRole::illuminant})
            for (ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
                auto a = whole.colors(source, {0.7f, true}, role, mode);
                auto b = tiled.colors(source, {0.7f, true}, role, mode);
                Rng rng(5);
                for (int i = 0; i < 400; ++i) {
                    const TexelPlace at = any_place(rng, filters[static_cast<std::size_t>(i % 4)]);
                    const Spectrum x = a->lookup(at, lambda), y = b->lookup(at, lambda);
                    for (int k = 0; k < 4; ++k) ASSERT_EQ(x[k], y[k]) << file << ' ' << i;
                }
            }
        auto a = whole.numbers(source);
        auto b = tiled.numbers(source);
        Rng rng(6);
        for (int i = 0; i < 400; ++i) {
            const TexelPlace at = any_place(rng, filters[static_cast<std::size_t>(i % 4)]);
            ASSERT_EQ(a->lookup(at), b->lookup(at)) << file << ' ' << i;
        }
    }
};

TEST_F(TileCacheTest, GivesTheBitsOfTexelsInMemory) {
    save("odd.exr", noise(211, 97));
    save("tall.png", noise(1, 130));
    save("square.exr", noise(64, 64));
    save("grey.exr", noise(100, 33, {"Y"}));
    save("glassy.exr", noise(45, 70, {"R", "G", "B", "A"}));
    for (const char* file : {"odd.exr", "tall.png", "square.exr", "grey.exr", "glassy.exr"})
        for (WrapMode wrap : {WrapMode::repeat, WrapMode::clamp, WrapMode::black})
            expect_same_bits(file, wrap);
    expect_same_bits("square.exr", WrapMode::octahedral_sphere);
}

TEST_F(TileCacheTest, KeepsTheLimitAndDropsWhatWasNotAskedForLately) {
    save("large.exr", noise(640, 640));
    constexpr std::size_t limit = 2 << 20;
    ImageCache cache;
    cache.limit_memory(limit);
    auto texels = cache.colors({folder() / "large.exr", Encoding{}, WrapMode::repeat}, {},
                               SpectrumRole::albedo, ColorMode::rgb);
    EXPECT_EQ(cache.memory().tiles_made, 0u) << "none is looked up yet";
    Rng rng(1);
    TexelPlace at;
    for (int i = 0; i < 20000; ++i) {
        at.st = {rng.uniform(), rng.uniform()};
        texels->lookup(at, Wavelengths::rgb());
    }
    const TextureMemory memory = cache.memory();
    EXPECT_EQ(memory.limit_bytes, limit);
    EXPECT_LE(memory.peak_bytes, limit);
    EXPECT_GT(memory.peak_bytes, limit / 2);
    EXPECT_GT(memory.tiles_dropped, 100u);
    EXPECT_GE(memory.file_bytes, 640u * 640 * sizeof(Vec3));
    cache.clear();
    EXPECT_LE(cache.bytes(), limit) << "images are forgotten";
}

TEST_F(TileCacheTest, ALimitThatIsLargeEnoughDropsNothing) {
    save("small.exr", noise(100, 100));
    ImageCache cache;
    cache.limit_memory(1 << 20);
    auto texels = cache.numbers({folder() / "small.exr", Encoding{}, WrapMode::repeat});
    Rng rng(1);
    for (int i = 0; i < 5000; ++i) texels->lookup(any_place(rng, TexelFilter::bilinear));
    EXPECT_GT(cache.memory().tiles_made, 15u);
    EXPECT_LE(cache.memory().tiles_made, 16u + 4 + 1 + 1 + 1 + 1 + 1) << "each level's tiles, once";
    EXPECT_EQ(cache.memory().tiles_dropped, 0u);
}

TEST_F(TileCacheTest, ThreadsThatTakeEachOthersTilesSeeTheSameBits) {
    save("large.exr", noise(512, 300));
    const ImageSource source{folder() / "large.exr", Encoding{}, WrapMode::repeat};
    ImageCache whole, tiled;
    tiled.limit_memory(100 << 10);
    auto a = whole.numbers(source);
    std::shared_ptr<const FloatTexels> b;
    constexpr int threads = 4;
    std::atomic<int> different = 0;
    with_threads(threads, [&] {
        b = tiled.numbers(source);
        parallel_for(64, 1, [&](std::size_t run) {
            Rng rng(run);
            for (int i = 0; i < 500; ++i) {
                const TexelPlace at = any_place(rng, filters[static_cast<std::size_t>(i % 4)]);
                different += a->lookup(at) != b->lookup(at);
            }
        });
    });
    EXPECT_EQ(different, 0);
    EXPECT_GT(tiled.memory().tiles_dropped, 0u);
    EXPECT_LE(tiled.memory().peak_bytes, (100 << 10) + threads * held_by_thread);
    EXPECT_NO_THROW(tiled.throw_if_failed());
}

TEST_F(TileCacheTest, WhatCannotBeReadIsToldAfterwards) {
    TileCache cache(1 << 20);
    cache.file().reserve(100);
    EXPECT_NO_THROW(cache.throw_if_failed());
    const std::byte* tile = cache.recent().tile(80, 40);
    EXPECT_EQ(tile[39], std::byte{0});
    try {
        cache.throw_if_failed();
        FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr("temporary file: it ends too early"));
    }
}

TEST_F(TileCacheTest, CorruptFilesAreErrorsOfTheirTextures) {
    save("good.png", noise(80, 80));
    std::filesystem::resize_file(folder() / "good.png", 500);
    textures.limit_memory(1 << 20);
    build({texture_node("imagemap", {make_string("filename", "good.png")}, true)});
    ASSERT_EQ(messages.error_count(), 1u);
    EXPECT_THAT(messages.list()[0].text, HasSubstr("good.png\": "));
}

} // namespace
} // namespace alhazen
