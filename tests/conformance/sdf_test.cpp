/// What every signed distance field promises, for each example of each registered kind, as it is and
/// stretched out of shape.

#include <gtest/gtest.h>

#include "base/hash.h"
#include "sdf/trace.h"
#include "tests/support/sdf_world.h"

namespace alhazen {
namespace {

struct SdfCase {
    std::string name;
    std::unique_ptr<PlacedSdf> field;
    bool is_lipschitz = true;
    Box region; ///< the bounds and something around, or a part of them where they do not end
};

std::vector<SdfCase> make_cases() {
    std::vector<SdfCase> cases;
    Matrix4 stretched = Matrix4::translate({0.3, -0.2, 0.5}) * Matrix4::rotate(35, {1, 3, 2}) *
                        Matrix4::scale({1.5, -0.7, 1.1});
    for (const Kind<Sdf>& kind : sdf_kinds().all())
        for (const Example& example : kind.doc().examples)
            for (const Matrix4& place : {Matrix4{}, stretched}) {
                Node node;
                node.type = kind.name;
                node.parameters = example.parameters;
                Messages messages;
                BuildContext context{.messages = messages};
                context.sdfs = &testing_support::example_sdfs();
                std::shared_ptr<const Sdf> sdf = kind.make(node, context);
                messages.throw_if_errors();
                SdfCase c;
                c.name = kind.name + " \"" + example.name + "\"" + (place == Matrix4{} ? "" : " stretched");
                c.is_lipschitz = sdf->is_lipschitz();
                c.field = std::make_unique<PlacedSdf>(sdf, place);
                c.region = c.field->bounds().intersected(Box::around(Vec3d(2.0)));
                c.region = c.region.grown(0.5 * max_component(c.region.size()));
                cases.push_back(std::move(c));
            }
    return cases;
}

const std::vector<SdfCase>& sdf_cases() {
    static const std::vector<SdfCase> all = make_cases();
    return all;
}

Vec3d random_in(const Box& box, Rng& rng) {
    Vec3d p = box.lo, size = box.size();
    for (int i = 0; i < 3; ++i) p[i] += size[i] * static_cast<double>(rng.uniform());
    return p;
}

Vec3d random_unit(Rng& rng) {
    for (;;) {
        Vec3d v = random_in(Box::around(Vec3d(1.0)), rng);
        double l = length(v);
        if (l > 0.01 && l <= 1) return v * (1 / l);
    }
}

TEST(Sdfs, EachKindHasExamples) {
    for (const auto& kind : sdf_kinds().all()) EXPECT_FALSE(kind.doc().examples.empty()) << kind.name;
}

// The Lipschitz bound, over short and long steps, and where the field is steepest: by its own gradient.
TEST(Sdfs, NoFieldChangesFasterThanDistance) {
    for (const SdfCase& c : sdf_cases()) {
        if (!c.is_lipschitz) continue;
        SCOPED_TRACE(c.name);
        Rng rng(1);
        double size = max_component(c.region.size());
        for (int i = 0; i < 20000; ++i) {
            Vec3d p = random_in(c.region, rng);
            double step = size * std::pow(10.0, -5 * static_cast<double>(rng.uniform()));
            Vec3d q = p + random_unit(rng) * step;
            double slope = std::abs(c.field->value(p) - c.field->value(q)) / step;
            ASSERT_LE(slope, 1 + 1e-9 + 4 * c.field->noise() / step) << p.x << " " << p.y << " " << p.z;
            Dual f = c.field->value(dual_point(p));
            ASSERT_LE(length(f.d), 1 + 1e-6);
        }
    }
}

// What sphere tracing needs of every field: the surface is nowhere nearer than it says.
TEST(Sdfs, NoSurfaceIsNearerThanTheFieldSays) {
    for (const SdfCase& c : sdf_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(5);
        for (int i = 0; i < 5000; ++i) {
            Vec3d p = random_in(c.region, rng);
            double f = c.field->value(p);
            for (int k = 0; k < 4; ++k) {
                double near = (std::abs(f) - 2 * c.field->noise()) *
                              (k ? 0.999999 : std::sqrt(static_cast<double>(rng.uniform())));
                double g = c.field->value(p + random_unit(rng) * near);
                ASSERT_FALSE(f > 0 ? g < -1e-13 : g > 1e-13) << f << " " << g;
            }
        }
    }
}

TEST(Sdfs, GradientsAreTheDerivatives) {
    for (const SdfCase& c : sdf_cases()) {
        if (!c.is_lipschitz) continue;
        SCOPED_TRACE(c.name);
        Rng rng(2);
        double h = 1e-5 * max_component(c.region.size());
        int off = 0;
        for (int i = 0; i < 2000; ++i) {
            Vec3d p = random_in(c.region, rng);
            Dual f = c.field->value(dual_point(p));
            ASSERT_NEAR(f.v, c.field->value(p), 1e-12);
            Vec3d d = random_unit(rng);
            double slope = (c.field->value(p + d * h) - c.field->value(p - d * h)) / (2 * h);
            off += std::abs(slope - dot(f.d, d)) > 1e-3;
        }
        // At edges there is none.
        EXPECT_LE(off, 10);
    }
}

TEST(Sdfs, NothingIsInsideOutOfBounds) {
    for (const SdfCase& c : sdf_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(3);
        int inside = 0;
        for (int i = 0; i < 20000; ++i) {
            Vec3d p = random_in(c.region, rng);
            double f = c.field->value(p);
            ASSERT_GE(f,
                      c.field->bounds().distance(p) > 0 ? c.field->bounds().distance(p) - 1e-12 : -Box::far);
            inside += f < 0;
        }
        EXPECT_GT(inside, 20);
    }
}

// Sphere tracing meets what an independent march in tiny steps meets: no surface is jumped over, none is seen
// that is not there.
TEST(Sdfs, TracedRaysMeetWhatADenseMarchMeets) {
    for (const SdfCase& c : sdf_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(4);
        double size = max_component(c.region.size());
        int hits = 0;
        for (int i = 0; i < 60; ++i) {
            Box target = c.field->bounds().intersected(Box::around(Vec3d(2.0)));
            Vec3d o = random_in(c.region, rng), d = normalize(random_in(target, rng) - o);
            auto field = [&](double s) { return c.field->value(o + d * s); };
            auto met = first_crossing(field, {0, 2 * size, size * 0x1p-20}, size);
            double end = met ? *met - 1e-9 * size : 2 * size;
            // Steps of a 4000th; where the field says that there is room for more, it has been checked above.
            double first = field(0);
            for (double s = 0; s < end; s += size / 4000)
                ASSERT_GT(field(s) * (first >= 0 ? 1 : -1), -1e-13) << i << " at " << s;
            if (!met) continue;
            ++hits;
            ASSERT_NEAR(field(*met), 0, 1e-13 * size + c.field->noise());
            double past = field(*met + 1e-9 * size + 10 * c.field->noise());
            ASSERT_LE(past * (first >= 0 ? 1 : -1), 1e-9 * size);
        }
        EXPECT_GT(hits, 5);
    }
}

} // namespace
} // namespace alhazen
