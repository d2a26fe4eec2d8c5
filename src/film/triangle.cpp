/// The triangle filter: falls linearly from the pixel's centre to 0 at the radius, across and down.
#include "film/filter.h"
#include "math/warp.h"

namespace alhazen {

namespace {

struct TriangleFilter final : Filter {
    float xradius = 2, yradius = 2;

    static void describe(Fields<TriangleFilter>& f) {
        f.about("Falls linearly from the pixel's centre; soft, never negative.");
        f.field("xradius", &TriangleFilter::xradius, "where it reaches 0, across")
            .in(1e-3, 64)
            .unit("pixels");
        f.field("yradius", &TriangleFilter::yradius, "where it reaches 0, down").in(1e-3, 64).unit("pixels");
        f.example("tight", {make_float("xradius", 1), make_float("yradius", 1)});
    }
    float eval(Vec2 p) const override {
        return std::max(0.0f, xradius - std::abs(p.x)) * std::max(0.0f, yradius - std::abs(p.y));
    }
    Vec2 radius() const override { return {xradius, yradius}; }
    float integral() const override { return sqr(xradius) * sqr(yradius); }
    FilterSample sample(Vec2 u) const override {
        return {{sample_tent(u.x, xradius), sample_tent(u.y, yradius)}};
    }
};

} // namespace

Kind<Filter> triangle_filter() {
    return make_kind<Filter, TriangleFilter>("triangle");
}

} // namespace alhazen
