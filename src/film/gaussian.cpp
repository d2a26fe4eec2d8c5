/// The Gaussian filter: a bell lowered so that it meets 0 at the radius. No ringing, a little blur; the
/// default.
#include "film/filter_table.h"
#include "math/special.h"

namespace alhazen {

namespace {

struct GaussianFilter final : SeparableFilter<GaussianFilter> {
    float sigma = 0.5f;

    GaussianFilter() : SeparableFilter(1.5f) {}
    static void describe(Fields<GaussianFilter>& f) {
        f.about("A bell curve, lowered so that it reaches 0 at the radius. The default.");
        describe_radius(f);
        f.field("sigma", &GaussianFilter::sigma, "standard deviation").in(1e-3, 64).unit("pixels");
        f.example("soft", {make_float("xradius", 3), make_float("yradius", 3), make_float("sigma", 1)});
    }
    float curve(float x, float r) const {
        return std::max(0.0f, gaussian(x, 0, sigma) - gaussian(r, 0, sigma));
    }
};

} // namespace

Kind<Filter> gaussian_filter() {
    return make_kind<Filter, GaussianFilter>("gaussian");
}

} // namespace alhazen
