/// The fields that volumes are sampled in: dense and sparse.
#include <gtest/gtest.h>

#include "base/hash.h"
#include "media/sampled_grid.h"
#include "media/sparse_field.h"

namespace alhazen {
namespace {

constexpr auto itself = [](float v) { return v; };

TEST(SampledGrid, GivesSamplesAtCellCentresAndFadesOutBeyond) {
    const SampledGrid<float> grid({2, 1, 1}, {3, 5});
    EXPECT_FLOAT_EQ(grid.lookup({0.25f, 0.5f, 0.5f}), 3);
    EXPECT_FLOAT_EQ(grid.lookup({0.75f, 0.5f, 0.5f}), 5);
    EXPECT_FLOAT_EQ(grid.lookup({0.5f, 0.5f, 0.5f}), 4);
    EXPECT_FLOAT_EQ(grid.lookup({0, 0.5f, 0.5f}), 1.5f);
    EXPECT_FLOAT_EQ(grid.lookup({0.25f, 0, 0}), 0.75f);
    EXPECT_EQ(grid.lookup({-0.3f, 0.5f, 0.5f}), 0);
    EXPECT_EQ(grid.lookup({0.5f, 7, 0.5f}), 0);
}

TEST(SampledGrid, LargestBoundsEveryLookup) {
    Rng rng(3);
    std::vector<float> values(5 * 4 * 3);
    for (float& v : values) v = rng.uniform();
    const SampledGrid<float> grid({5, 4, 3}, values);
    for (int k = 0; k < 3000; ++k) {
        Bounds3 part;
        for (int i = 0; i < 2; ++i) part.extend(Vec3(rng.uniform(), rng.uniform(), rng.uniform()));
        const float bound = grid.largest(part, itself);
        const Vec3 p = part.lo + part.diagonal() * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
        ASSERT_LE(grid.lookup(p), bound * (1 + 1e-6f));
    }
    EXPECT_EQ(grid.largest({{0, 0, 0}, {1, 1, 1}}, itself), *std::max_element(values.begin(), values.end()));
}

// A dense block of samples, of which some bricks are left out.
struct Block {
    GridData data;
    float value(Vec3i p) const {
        for (const GridBrick& b : data.bricks)
            if (brick_origin(p.x) == b.origin.x && brick_origin(p.y) == b.origin.y &&
                brick_origin(p.z) == b.origin.z)
                return b.values[GridBrick::at(p.x - b.origin.x, p.y - b.origin.y, p.z - b.origin.z)];
        return 0;
    }
};

Block random_block() {
    Block block;
    block.data.is_level_set = false;
    block.data.lo = {-8, 0, 8};
    block.data.hi = {15, 7, 23};
    Rng rng(4);
    for (int z = 8; z < 24; z += 8)
        for (int x = -8; x < 16; x += 8) {
            if (x == 0 && z == 8) continue;
            GridBrick& b = block.data.bricks.emplace_back();
            b.origin = {x, 0, z};
            for (float& v : b.values) v = rng.uniform();
        }
    return block;
}

TEST(SparseField, InterpolatesLikeTheFormula) {
    const Block block = random_block();
    const SparseField field(block.data);
    Rng rng(5);
    for (int k = 0; k < 5000; ++k) {
        const Vec3 p{rng.uniform() * 28 - 10, rng.uniform() * 11 - 2, rng.uniform() * 20 + 6};
        const Vec3i lo{static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                       static_cast<int>(std::floor(p.z))};
        float expected = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3i c{lo.x + (i & 1), lo.y + (i >> 1 & 1), lo.z + (i >> 2)};
            float weight = 1;
            for (int a = 0; a < 3; ++a) weight *= 1 - std::abs(p[a] - static_cast<float>(c[a]));
            expected += weight * block.value(c);
        }
        ASSERT_NEAR(field.lookup(p), expected, 1e-5f);
        const Bounds3 around{p - Vec3(rng.uniform() * 3), p + Vec3(rng.uniform() * 9)};
        ASSERT_GE(field.largest(around) * (1 + 1e-6f), field.lookup(p));
    }
}

TEST(SparseField, IsNothingWithoutSamples) {
    EXPECT_TRUE(SparseField().empty());
}

} // namespace
} // namespace alhazen
