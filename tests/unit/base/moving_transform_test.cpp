/// Transformations that change with time.
#include "base/moving_transform.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace alhazen {
namespace {

void expect_near(const Matrix4& a, const Matrix4& b, double tolerance) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(a.m[i][j], b.m[i][j], tolerance) << i << " " << j;
}
Matrix4 random_matrix(Rng& rng, bool mirrors) {
    auto number = [&] { return 2 * static_cast<double>(rng.uniform()) - 1; };
    auto turn = [&] { return Matrix4::rotate(180 * number(), {number(), number(), 1}); };
    return Matrix4::translate({number(), number(), number()}) * turn() *
           Matrix4::scale({mirrors ? -1.5 : 1.5, 1 + 0.5 * number(), 1 + 0.9 * number()}) * turn();
}

TEST(MovingTransform, IsAtTheEndsWhatItWasMadeOf) {
    Rng rng(1);
    for (int i = 0; i < 100; ++i) {
        const Matrix4 a = random_matrix(rng, i % 2), b = random_matrix(rng, i % 2);
        const auto moving = MovingTransform::make(a, b, 1, 3);
        ASSERT_TRUE(moving);
        for (float before : {-1.0f, 1.0f}) expect_near(moving->at(before).matrix(), a, 1e-12);
        for (float after : {3.0f, 7.0f}) expect_near(moving->at(after).matrix(), b, 1e-12);
    }
}

TEST(MovingTransform, TurnsEvenlyAndTheShortWay) {
    const auto moving =
        MovingTransform::make(Matrix4::rotate(170, {0, 0, 1}), Matrix4::rotate(-170, {0, 0, 1}), 0, 1);
    for (int i = 0; i <= 10; ++i)
        expect_near(moving->at(static_cast<float>(i) * 0.1f).matrix(),
                    Matrix4::rotate(170 + 2.0 * i, {0, 0, 1}), 1e-6);
    // Half a turn, and none.
    const auto half = MovingTransform::make({}, Matrix4::rotate(180, {1, 0, 0}), 0, 1);
    EXPECT_NEAR(std::abs(half->at(0.5f).matrix().m[1][2]), 1, 1e-12);
    const auto none =
        MovingTransform::make(Matrix4::rotate(10, {1, 0, 0}), Matrix4::rotate(10, {1, 0, 0}), 0, 1);
    expect_near(none->at(0.3f).matrix(), Matrix4::rotate(10, {1, 0, 0}), 1e-12);
}

TEST(MovingTransform, MovesAndStretchesEvenly) {
    const auto moving =
        MovingTransform::make(Matrix4::translate({1, 2, 3}) * Matrix4::scale({1, 2, -3}),
                              Matrix4::translate({3, 2, 3}) * Matrix4::scale({3, 2, -1}), 0, 1);
    expect_near(moving->at(0.25f).matrix(), Matrix4::translate({1.5, 2, 3}) * Matrix4::scale({1.5, 2, -2.5}),
                1e-12);
}

TEST(MovingTransform, InversesBelongToIt) {
    Rng rng(2);
    for (int i = 0; i < 50; ++i) {
        const auto moving = MovingTransform::make(random_matrix(rng, true), random_matrix(rng, true), 0, 1);
        const Transform t = moving->at(rng.uniform());
        expect_near(t.matrix() * t.inverse_matrix(), {}, 1e-9);
    }
}

TEST(MovingTransform, BoundsHoldAllPlaces) {
    Rng rng(3);
    for (int i = 0; i < 40; ++i) {
        const auto moving = MovingTransform::make(random_matrix(rng, false), random_matrix(rng, false), 0, 1);
        const Bounds3 box{{-1, 2, 0}, {0.5f, 4, 1}};
        const Bounds3 bounds = moving->bounds(box);
        Bounds3 seen;
        for (int k = 0; k < 3000; ++k) {
            const Transform t = moving->at(rng.uniform());
            const Vec3 p = t.point(box.corner(k % 8));
            seen.extend(p);
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], bounds.lo[axis]);
                ASSERT_LE(p[axis], bounds.hi[axis]);
            }
        }
        // And little more.
        EXPECT_LT(length(bounds.diagonal()), 1.05f * length(seen.diagonal()));
    }
    EXPECT_TRUE(MovingTransform::make({}, Matrix4::translate({1, 0, 0}), 0, 1)->bounds({}).empty());
}

TEST(MovingTransform, RefusesWhatHasNoWayBetween) {
    EXPECT_FALSE(MovingTransform::make({}, Matrix4::scale({-1, 1, 1}), 0, 1));
    EXPECT_FALSE(MovingTransform::make(Matrix4::scale({0, 1, 1}), {}, 0, 1));
    EXPECT_FALSE(MovingTransform::make({}, Matrix4::translate({1, 0, 0}), 1, 1));
    Matrix4 projective;
    projective.m[3][2] = 1;
    EXPECT_FALSE(MovingTransform::make({}, projective, 0, 1));
}

TEST(MovingTransform, KnowsRigidOnes) {
    const Matrix4 turned = Matrix4::translate({1, 2, 3}) * Matrix4::rotate(70, {1, 2, 3});
    EXPECT_TRUE(MovingTransform::make(turned, {}, 0, 1)->is_rigid());
    EXPECT_TRUE(MovingTransform::make(turned * Matrix4::scale({-1, 1, 1}), Matrix4::scale({-1, 1, 1}), 0, 1)
                    ->is_rigid());
    EXPECT_FALSE(
        MovingTransform::make(turned * Matrix4::scale({2, 2, 2}), turned * Matrix4::scale({2, 2, 2}), 0, 1)
            ->is_rigid());
    // Mirrored along different axes: on the way it is not.
    EXPECT_FALSE(
        MovingTransform::make(Matrix4::scale({-1, 1, 1}), Matrix4::scale({1, -1, 1}), 0, 1)->is_rigid() &&
        std::abs(MovingTransform::make(Matrix4::scale({-1, 1, 1}), Matrix4::scale({1, -1, 1}), 0, 1)
                     ->at(0.5f)
                     .matrix()
                     .determinant3() +
                 1) > 1e-6);
}

} // namespace
} // namespace alhazen
