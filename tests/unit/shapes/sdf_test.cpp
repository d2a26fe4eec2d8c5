/// Shape "sdf" against closed forms in double precision, and what it says about fields it cannot show.

#include "tests/support/sdf_world.h"
#include "tests/unit/shapes/support.h"

namespace alhazen {
namespace {

using namespace shape_test;
using ::testing::HasSubstr;
using testing_support::make_sdfs;
using testing_support::sdf_node;

std::unique_ptr<Shape> make_sdf(const SdfSet& set, const std::string& field, Messages& messages) {
    Node node;
    node.type = "sdf";
    node.parameters = {make_string("field", field)};
    BuildContext context{.messages = messages};
    context.sdfs = &set;
    return shape_kinds().make(node, context, "");
}

using Polynomial = std::vector<double>; ///< coefficients, constant first

double value_at(const Polynomial& p, double t) {
    double v = 0;
    for (std::size_t i = p.size(); i-- > 0;) v = v * t + p[i];
    return v;
}

// All simple roots between lo and hi: between the roots of the derivative there is one where the sign
// changes.
std::vector<double> roots_of(const Polynomial& p, double lo, double hi) {
    std::vector<double> ends{lo}, roots;
    if (p.size() > 2) {
        Polynomial derivative;
        for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<double>(i) * p[i]);
        for (double t : roots_of(derivative, lo, hi)) ends.push_back(t);
    }
    ends.push_back(hi);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        double a = ends[i], b = ends[i + 1];
        if ((value_at(p, a) > 0) == (value_at(p, b) > 0)) continue;
        for (int k = 0; k < 200; ++k) {
            double m = 0.5 * (a + b);
            ((value_at(p, m) > 0) == (value_at(p, a) > 0) ? a : b) = m;
        }
        roots.push_back(0.5 * (a + b));
    }
    return roots;
}

// The float 0.3 is not 0.3.
constexpr double major = 1, minor = static_cast<double>(0.3f);

// (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2) along o + t d.
Polynomial torus_along(Vec3d o, Vec3d d) {
    double a = dot(d, d), b = 2 * dot(o, d), c = dot(o, o) + major * major - minor * minor;
    double k = 4 * major * major;
    return {c * c - k * (o.x * o.x + o.y * o.y), 2 * b * c - 2 * k * (o.x * d.x + o.y * d.y),
            b * b + 2 * a * c - k * (d.x * d.x + d.y * d.y), 2 * a * b, a * a};
}

std::vector<double> box_roots(Vec3d o, Vec3d d, Vec3d half) {
    double in = -1e30, out = 1e30;
    for (int i = 0; i < 3; ++i) {
        double a = (-half[i] - o[i]) / d[i], b = (half[i] - o[i]) / d[i];
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
    }
    if (in >= out) return {};
    return {in, out};
}

template <class Roots>
void expect_hits(const Shape& shape, const Roots& roots) {
    Rng rng(1);
    int hits = 0, grazing = 0;
    for (int i = 0; i < 20000; ++i) {
        auto number = [&] { return 2 * rng.uniform() - 1; };
        Vec3 o{4 * number(), 4 * number(), 4 * number()};
        Vec3 d = Vec3{1.2f * number(), 1.2f * number(), 0.5f * number()} - o;
        if (i % 3 == 0) o = {1.2f * number(), 1.2f * number(), 0.4f * number()}; // some start inside
        std::vector<double> all = roots(Vec3d(o), Vec3d(d));
        std::erase_if(all, [](double t) { return t <= 0; });
        Intersection met;
        bool found = shape.intersect({o, d}, 0, met);
        if (found != !all.empty()) {
            ++grazing;
            continue;
        }
        if (!found) continue;
        ++hits;
        double along = static_cast<double>(length(d)) * std::abs(static_cast<double>(met.t) - all.front());
        // Where two roots nearly meet, the polynomial's own are worth half of their digits.
        if (along > 1e-6 * (1 + all.front() * static_cast<double>(length(d)))) ++grazing;
        Hit hit = shape.surface({o, d}, 0, met);
        ASSERT_GT(length(hit.ng), 0.999f);
    }
    EXPECT_GT(hits, 5000);
    EXPECT_LE(grazing, 4);
}

TEST(SdfShape, MeetsATorusWhereItsQuarticDoes) {
    SdfSet set = make_sdfs({sdf_node("ring", "torus", {make_float("tube", 0.3f)})});
    Messages messages;
    auto shape = make_sdf(set, "ring", messages);
    expect_hits(*shape, [](Vec3d o, Vec3d d) { return roots_of(torus_along(o, d), 0, 50); });
}

TEST(SdfShape, MeetsABoxWhereItsSlabsDo) {
    SdfSet set = make_sdfs({sdf_node("brick", "box", {make_point3("size", {2, 1, 0.5f})})});
    Messages messages;
    auto shape = make_sdf(set, "brick", messages);
    expect_hits(*shape, [](Vec3d o, Vec3d d) { return box_roots(o, d, {1, 0.5, 0.25}); });
}

TEST(SdfShape, MeetsASphereWhereTheSphereIsMet) {
    SdfSet set = make_sdfs({sdf_node("ball", "sphere", {})});
    Messages messages;
    auto shape = make_sdf(set, "ball", messages);
    expect_hits(*shape, [](Vec3d o, Vec3d d) {
        return roots_of({dot(o, o) - 1, 2 * dot(o, d), dot(d, d)}, 0, 50);
    });
}

TEST(SdfShape, AreasAreThoseOfTheBodies) {
    SdfSet set =
        make_sdfs({sdf_node("ball", "sphere", {}), sdf_node("ring", "torus", {make_float("tube", 0.5f)}),
                   sdf_node("brick", "box", {make_point3("size", {2, 1, 1})})});
    Messages messages;
    EXPECT_NEAR(make_sdf(set, "ball", messages)->area(0), 4 * pi, 0.01);
    EXPECT_NEAR(make_sdf(set, "ring", messages)->area(0), 2 * pi * pi, 0.03);
    EXPECT_NEAR(make_sdf(set, "brick", messages)->area(0), 10, 0.1); // its edges are cut a little
}

TEST(SdfShape, SaysWhatCannotBeShown) {
    SdfSet set = make_sdfs({sdf_node("ground", "plane", {}), sdf_node("ball", "sphere", {})});
    for (auto [field, text] : {std::pair{"ground", "does not end"}, {"bal", "did you mean \"ball\""}}) {
        Messages messages;
        EXPECT_EQ(make_sdf(set, field, messages), nullptr);
        ASSERT_EQ(messages.error_count(), 1u);
        EXPECT_THAT(messages.list().front().text, HasSubstr(text));
    }
    EXPECT_THAT(errors_of("sdf", {}), HasSubstr("field"));
}

} // namespace
} // namespace alhazen
