/// What every shape promises, for each example of each registered kind at several places and scales.

#include <gtest/gtest.h>

#include <map>

#include "shapes/triangle_mesh.h"
#include "tests/conformance/shape_cases.h"
#include "tests/conformance/shape_distance.h"
#include "tests/support/area_density.h"
#include "tests/support/chi_square.h"
#include "tests/support/effort.h"

namespace alhazen {
namespace {

using namespace shape_cases;
using testing_support::chi_square_p_value;
using testing_support::fewer_if_sanitized;
using testing_support::sidak_level;

// False alarms of each statistical test below, over all cases and fixed seeds together.
constexpr double family_level = 1e-4;

TEST(Shapes, EachKindHasExamples) {
    for (const auto& kind : shape_kinds().all()) EXPECT_FALSE(kind.doc().examples.empty()) << kind.name;
}

TEST(Shapes, HitsLieOnTheSurfaceAndWithinTheBounds) {
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(1);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            Ray ray = random_line(c.ball, rng);
            for (const Hit& hit : all_hits(*c.shape, ray)) {
                ++hits;
                double bound = static_cast<double>(dot(abs(hit.ng), hit.p_error)) * (1 + 1e-5);
                ASSERT_LE(distance_to_surface(c, hit), bound);
                // Along the ray, as far as floats tell.
                Vec3d along = Vec3d(hit.p) - Vec3d(ray.o);
                double off = length(cross(along, Vec3d(ray.d)));
                double far = static_cast<double>(length(ray.o) + c.size());
                ASSERT_LT(off, 1e-5 * far);
                Bounds3 box = c.shape->bounds(hit.primitive);
                box.lo = box.lo - hit.p_error;
                box.hi = box.hi + hit.p_error;
                ASSERT_TRUE(box.contains(hit.p));
                ASSERT_NEAR(length(hit.ng), 1, 1e-6);
                ASSERT_NEAR(length(hit.ns), 1, 1e-6);
                ASSERT_GE(dot(hit.ng, hit.ns), 0);
                ASSERT_NEAR(dot(hit.wo, ray.d), -1, 1e-6);
                auto cone = c.shape->normals(hit.primitive);
                ASSERT_GE(dot(cone.axis, hit.ng), cone.cosine - 1e-5f);
                ASSERT_GT(hit.t, 0);
            }
        }
        EXPECT_GT(hits, 80);
    }
}

TEST(Shapes, PlainSurfacesAreTheSameButForParameters) {
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(17);
        for (int n = 0; n < 200; ++n) {
            Ray ray = random_line(c.ball, rng);
            for (std::uint32_t i = 0; i < c.shape->primitive_count(); ++i) {
                Intersection met;
                if (!c.shape->intersect(ray, i, met)) continue;
                Hit all = c.shape->surface(ray, i, met), plain = c.shape->plain_surface(ray, i, met);
                ASSERT_TRUE(all.p == plain.p && all.p_error == plain.p_error && all.wo == plain.wo);
                ASSERT_TRUE(all.ng == plain.ng && all.ns == plain.ns);
                ASSERT_TRUE(all.t == plain.t && all.time == plain.time && all.primitive == plain.primitive);
            }
        }
    }
}

TEST(Shapes, NothingIsHitBeforeTheStartOrBehindTheEnd) {
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(2);
        for (int i = 0; i < 300; ++i) {
            Ray ray = random_line(c.ball, rng);
            auto hit = nearest_hit(*c.shape, ray);
            if (!hit) continue;
            Intersection met;
            ray.tmax = hit->t;
            ASSERT_FALSE(c.shape->intersect(ray, hit->primitive, met));
            ASSERT_EQ(met.t, infinity);
            ray.tmax = next_up(hit->t);
            ASSERT_TRUE(c.shape->intersect(ray, hit->primitive, met));
            ASSERT_EQ(met.t, hit->t);
        }
    }
}

TEST(Shapes, SpawnedRaysDoNotMeetTheSurfaceTheyLeave) {
    for (const ShapeCase& c : all_cases()) {
        if (c.kind == "curve") continue; // winds back to itself; see its own tests
        SCOPED_TRACE(c.name);
        Rng rng(3);
        for (int i = 0; i < 1000; ++i)
            for (const Hit& hit : all_hits(*c.shape, random_line(c.ball, rng))) {
                Vec3 d = random_direction(rng);
                // Many graze.
                if (i % 2) d = normalize(d - hit.ng * (dot(d, hit.ng) * (1 - 1e-4f)));
                Ray ray = hit.spawn(d);
                Intersection met;
                if (!c.shape->intersect(ray, hit.primitive, met)) continue;
                ASSERT_NE(c.kind, "trianglemesh");
                ASSERT_NE(c.kind, "disk");
                // Inside a curved surface the next hit is a chord away: at least 2 R cos for the smallest
                // radius of curvature R, and that is above 0.05 sizes in these examples.
                float chord = length(c.shape->surface(ray, hit.primitive, met).p - hit.p);
                ASSERT_GT(chord, 0.05f * c.size() * abs_dot(d, hit.ng));
            }
    }
}

TEST(Shapes, RaysThatAreNotRaysHitNothing) {
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity};
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        for (std::uint32_t k = 0; k < c.shape->primitive_count(); ++k)
            for (float v : bad)
                for (int axis = 0; axis < 3; ++axis) {
                    Ray ray{c.ball.center - Vec3{0, 0, 3 * c.size()}, {0, 0, 1}};
                    Intersection met;
                    Ray from = ray, along = ray;
                    from.o[axis] = v;
                    along.d[axis] = v;
                    EXPECT_FALSE(c.shape->intersect(from, k, met));
                    EXPECT_FALSE(c.shape->intersect(along, k, met));
                    ray.tmax = bad[0];
                    EXPECT_FALSE(c.shape->intersect(ray, k, met));
                    ray = {ray.o, {0, 0, 0}};
                    EXPECT_FALSE(c.shape->intersect(ray, k, met));
                }
    }
}

// Between two hits the nearest axis changes.
bool seam_between(const ShapeCase& c, const Hit& a, const Hit& b) {
    auto axis = [&](const Hit& hit) {
        Vec3d n(c.world_from_object.inverse_normal(hit.ng));
        return max_dimension(abs(n)) * 2 + (n[max_dimension(abs(n))] < 0);
    };
    // A grid's surface is bent where cells meet.
    return axis(a) != axis(b) || (c.kind == "sdfgrid" && dot(a.ng, b.ng) < 0.9999f);
}

// From p a small step along dpdu and down onto the surface again must change u alone, by the step.
void expect_derivatives(const ShapeCase& c, const Hit& hit) {
    float reach = 2e-3f * c.size();
    for (int which = 0; which < 2; ++which) {
        Vec3 tangent = which ? hit.dpdv : hit.dpdu;
        float step = reach / length(tangent);
        Ray down{hit.p + tangent * step + hit.ng * (10 * reach), -hit.ng, 20 * reach};
        Intersection met;
        if (!c.shape->intersect(down, hit.primitive, met)) continue;
        Hit moved = c.shape->surface(down, hit.primitive, met);
        if (is_projected(c) && seam_between(c, hit, moved)) continue;
        // Floats: p's rounding moves the parameters by about p_error / |tangent|.
        float shortest = std::min(length(hit.dpdu), length(hit.dpdv));
        float tolerance = 0.05f * step + 4 * length(hit.p_error) / shortest + 2e-6f;
        float du = moved.uv.x - hit.uv.x, dv = moved.uv.y - hit.uv.y;
        ASSERT_NEAR(which ? dv : du, step, tolerance);
        ASSERT_NEAR(which ? du : dv, 0, tolerance);
    }
}

TEST(Shapes, TangentsAreTheDerivativesByTheParameters) {
    for (const ShapeCase& c : all_cases()) {
        SCOPED_TRACE(c.name);
        Rng rng(4);
        for (int i = 0; i < 500; ++i)
            for (const Hit& hit : all_hits(*c.shape, random_line(c.ball, rng))) {
                ASSERT_GT(length(cross(hit.dpdu, hit.dpdv)), 0);
                // With vertex normals they are tangents of the shading surface.
                const TriangleMesh* mesh = c.shape->triangles();
                if (c.node.find("N") || (mesh && !mesh->N.empty())) {
                    ASSERT_NEAR(dot(normalize(hit.dpdu), hit.ns), 0, 1e-5);
                    continue;
                }
                // Away from seams and poles, where a step of this size is not small.
                float least = std::min(length(hit.dpdu), length(hit.dpdv));
                bool at_seam = std::min(hit.uv.x, 1 - hit.uv.x) < 0.02f;
                if (least < 0.3f * c.size() || (at_seam && !c.shape->triangles())) continue;
                expect_derivatives(c, hit);
            }
    }
}

// Cauchy and Crofton: a random line through a ball of radius R crosses a surface of area A A / (2 pi R^2)
// times in the mean.
TEST(Shapes, AreaIsWhatRandomLinesMeasure) {
    constexpr int lines = fewer_if_sanitized(20000);
    // 4.5 standard deviations over 133 cases: false alarm 1e-3 for normal errors.
    for (const ShapeCase& c : all_cases()) {
        if (!c.shape->can_be_light()) continue;
        SCOPED_TRACE(c.name);
        Rng rng(5);
        double sum = 0, squares = 0, area = 0;
        for (int i = 0; i < lines; ++i) {
            auto n = static_cast<double>(all_hits(*c.shape, random_line(c.ball, rng)).size());
            sum += n;
            squares += n * n;
        }
        for (std::uint32_t i = 0; i < c.shape->primitive_count(); ++i)
            area += static_cast<double>(c.shape->area(i));
        double mean = sum / lines, deviation = std::sqrt((squares / lines - mean * mean) / lines);
        double unit = 2 * 3.14159265358979 * static_cast<double>(c.size()) * static_cast<double>(c.size());
        EXPECT_NEAR(area / unit, mean, 4.5 * deviation);
    }
}

// Where random lines cross a surface is uniform over its area: an independent source of points to compare
// with.
TEST(Shapes, SamplesAreUniformOverTheArea) {
    constexpr int cells = 6, lines = fewer_if_sanitized(15000);
    const auto& cases = all_cases();
    double level = sidak_level(family_level, static_cast<int>(cases.size()));
    for (const ShapeCase& c : cases) {
        if (!c.shape->can_be_light()) continue;
        SCOPED_TRACE(c.name);
        Rng rng(6);
        auto cell_of = [&](std::uint32_t primitive, Vec2 uv) {
            // Some examples have parameters up to 2.
            auto bin = [](float x) { return std::clamp(static_cast<int>(x * cells), 0, 2 * cells - 1); };
            return (static_cast<int>(primitive) * 2 * cells + bin(uv.x)) * 2 * cells + bin(uv.y);
        };
        std::map<int, std::array<double, 2>> counts;
        std::array<double, 2> total{};
        for (int i = 0; i < lines; ++i)
            for (const Hit& hit : all_hits(*c.shape, random_line(c.ball, rng))) {
                ++counts[cell_of(hit.primitive, hit.uv)][0];
                ++total[0];
            }
        std::vector<double> up_to;
        for (std::uint32_t i = 0; i < c.shape->primitive_count(); ++i)
            up_to.push_back((i ? up_to.back() : 0) + static_cast<double>(c.shape->area(i)));
        for (int i = 0; i < lines; ++i) {
            double pick = static_cast<double>(rng.uniform()) * up_to.back();
            auto k = static_cast<std::uint32_t>(std::upper_bound(up_to.begin(), up_to.end(), pick) -
                                                up_to.begin());
            k = std::min(k, c.shape->primitive_count() - 1);
            ShapeSample s = c.shape->sample(k, {rng.uniform(), rng.uniform()});
            ASSERT_NEAR(s.pdf * c.shape->area(k), 1, 1e-5);
            ++counts[cell_of(k, s.uv)][1];
            ++total[1];
        }
        // Two samples against each other; rare cells are pooled.
        double statistic = 0, ratio = std::sqrt(total[1] / total[0]);
        std::array<double, 2> pool{};
        int used = 0;
        auto add = [&](std::array<double, 2> n) {
            double d = ratio * n[0] - n[1] / ratio;
            statistic += d * d / (n[0] + n[1]);
            ++used;
        };
        for (const auto& [cell, n] : counts) {
            if (n[0] + n[1] >= 20) {
                add(n);
            } else {
                pool[0] += n[0];
                pool[1] += n[1];
            }
        }
        if (pool[0] + pool[1] >= 20) add(pool);
        EXPECT_GT(chi_square_p_value(statistic, used - 1), level) << statistic << " in " << used;
    }
}

TEST(Shapes, SampledPointsAreWhatARayTowardsThemHits) {
    constexpr int points = fewer_if_sanitized(400);
    for (const ShapeCase& c : all_cases()) {
        if (!c.shape->can_be_light()) continue;
        SCOPED_TRACE(c.name);
        Rng rng(7);
        int compared = 0;
        for (int i = 0; i < points; ++i) {
            std::uint32_t k = rng.below(c.shape->primitive_count());
            float distance = i % 2 ? 1.5f : 20.0f;
            Vec3 from = c.ball.center + random_direction(rng) * (distance * c.size());
            auto s = c.shape->sample_from(k, from, {rng.uniform(), rng.uniform()});
            ASSERT_TRUE(s);
            ASSERT_NEAR(length(s->ng), 1, 1e-6);
            Vec3 wi = normalize(s->p - from);
            Ray ray{from, wi};
            Intersection met;
            for (int n = 0; n < 3 && c.shape->intersect(ray, k, met); ++n) {
                Hit hit = c.shape->surface(ray, k, met);
                ray = hit.spawn(wi);
                met = {};
                if (length(hit.p - s->p) > 1e-3f * c.size()) continue;
                ++compared;
                // A grid's surface has edges where cells meet.
                if (c.kind == "sdfgrid" && dot(hit.ng, s->ng) < 0.9999f) continue;
                float pdf = c.shape->pdf_from(k, from, hit, wi);
                if (c.example == "ball") { // its cone's density knows no edge
                    ASSERT_NEAR(pdf / s->pdf, 1, 1e-5);
                } else {
                    // No example is curved more than a ball of 0.05 sizes. (Triangles are flat, and most
                    // are sampled by their solid angle: all the less may differ.)
                    ASSERT_TRUE(testing_support::same_density(
                        {s->p, s->p_error, s->pdf}, {hit.p, hit.p_error, pdf}, from, c.shape->area(k),
                        20 / static_cast<double>(c.size())));
                }
                if (abs_dot(wi, s->ng) < 0.05f) continue;
                ASSERT_GT(dot(hit.ng, s->ng), 0.999f);
                ASSERT_NEAR(hit.uv.y, s->uv.y, 5e-3);
            }
        }
        EXPECT_GT(compared, points / 2);
    }
}

// Next to the surface nearly all of the solid angle comes from very few samples.
bool is_near(const ShapeCase& c, std::uint32_t primitive, Vec3 from) {
    Rng rng(9);
    for (int i = 0; i < 300; ++i)
        if (length(c.shape->sample(primitive, {rng.uniform(), rng.uniform()}).p - from) < 0.15f * c.size())
            return true;
    return false;
}

// The mean of 1 / pdf over samples is the solid angle that can be sampled; directions uniform in a cone
// around the shape measure the same by counting hits. Whole spheres sample what is seen from outside, other
// shapes all of the surface, in front and behind.
TEST(Shapes, SampledSolidAngleIsWhatUniformDirectionsMeasure) {
    constexpr int samples = fewer_if_sanitized(6000);
    for (const ShapeCase& c : all_cases()) {
        if (!c.shape->can_be_light()) continue;
        SCOPED_TRACE(c.name);
        Rng rng(8);
        for (float distance : {0.3f, 2.0f, 30.0f}) {
            Vec3 from = c.ball.center + normalize(Vec3{0.5f, 0.6f, 0.62f}) * (distance * c.size());
            bool outside = distance > 1;
            bool front_only =
                c.example == "ball" && length(c.world_from_object.inverse_point(Vec3d(from))) > 1;
            std::uint32_t k = c.shape->primitive_count() - 1;
            if (is_near(c, k, from)) continue;
            double sum = 0, squares = 0;
            for (int i = 0; i < samples; ++i) {
                auto s = c.shape->sample_from(k, from, {rng.uniform(), rng.uniform()});
                double w = s ? 1 / static_cast<double>(s->pdf) : 0;
                sum += w;
                squares += w * w;
            }
            double mean = sum / samples, variance = (squares / samples - mean * mean) / samples;
            // Directions around the box; all directions from inside.
            double cos_max = outside ? std::sqrt(1 - 1 / static_cast<double>(distance * distance)) : -1;
            double cone = 2 * 3.14159265358979 * (1 - cos_max), hits = 0, hit_squares = 0;
            Frame frame = Frame::from_z(normalize(c.ball.center - from));
            for (int i = 0; i < samples; ++i) {
                auto z = static_cast<float>(1 - static_cast<double>(rng.uniform()) * (1 - cos_max));
                float r = safe_sqrt(1 - z * z), phi = 2 * pi * rng.uniform();
                Ray ray{from, frame.to_world({r * std::cos(phi), r * std::sin(phi), z})};
                Intersection met;
                double n = 0;
                for (; n < 3 && c.shape->intersect(ray, k, met); ++n) {
                    ray = c.shape->surface(ray, k, met).spawn(ray.d);
                    met = {};
                }
                if (front_only) n = std::min(n, 1.0);
                hits += n;
                hit_squares += n * n;
            }
            if (hits < 5) continue; // too small from there to tell
            double expected = cone * hits / samples;
            double p = hits / samples;
            double spread = cone * cone * (hit_squares / samples - p * p) / samples;
            // 5 standard deviations, and 1e-3 for the flat cone's own float directions.
            EXPECT_NEAR(mean, expected, 5 * std::sqrt(variance + spread) + 1e-3 * expected)
                << "from " << distance;
        }
    }
}

} // namespace
} // namespace alhazen
