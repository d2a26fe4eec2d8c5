/// The Lanczos filter: the ideal low-pass filter, sin(x) / x, faded out by a window (Duchon 1979).
#include "film/filter_table.h"
#include "math/special.h"

namespace alhazen {

namespace {

struct SincFilter final : SeparableFilter<SincFilter> {
    float tau = 3;

    SincFilter() : SeparableFilter(4) {}
    static void describe(Fields<SincFilter>& f) {
        f.about("sin(x) / x in a Lanczos window: the sharpest, and rings along strong edges.");
        describe_radius(f);
        f.field("tau", &SincFilter::tau, "width of the window's main lobe, in lobes of the sinc")
            .in(1e-2, 64);
        f.example("narrow", {make_float("xradius", 2), make_float("yradius", 2), make_float("tau", 2)});
    }
    float curve(float x, float r) const { return windowed_sinc(x, r, tau); }
};

} // namespace

Kind<Filter> sinc_filter() {
    return make_kind<Filter, SincFilter>("sinc");
}

} // namespace alhazen
