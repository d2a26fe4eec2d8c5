/// The box filter: the plain mean over a rectangle around the pixel's centre.
#include "film/filter.h"

namespace alhazen {

namespace {

struct BoxFilter final : Filter {
    float xradius = 0.5f, yradius = 0.5f;

    static void describe(Fields<BoxFilter>& f) {
        f.about("The mean over a rectangle; with the default radii, over the pixel's own square.");
        f.field("xradius", &BoxFilter::xradius, "half of the width").in(1e-3, 64).unit("pixels");
        f.field("yradius", &BoxFilter::yradius, "half of the height").in(1e-3, 64).unit("pixels");
        f.example("wide", {make_float("xradius", 2), make_float("yradius", 1)});
    }
    float eval(Vec2 p) const override {
        return std::abs(p.x) <= xradius && std::abs(p.y) <= yradius ? 1.0f : 0.0f;
    }
    Vec2 radius() const override { return {xradius, yradius}; }
    float integral() const override { return 4 * xradius * yradius; }
    FilterSample sample(Vec2 u) const override {
        return {{(2 * u.x - 1) * xradius, (2 * u.y - 1) * yradius}};
    }
};

} // namespace

Kind<Filter> box_filter() {
    return make_kind<Filter, BoxFilter>("box");
}

} // namespace alhazen
