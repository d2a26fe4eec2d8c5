/// Mitchell and Netravali's filter (1988): a cubic that goes slightly negative, which keeps edges crisp.
#include "film/filter_table.h"
#include "math/special.h"

namespace alhazen {

namespace {

struct MitchellFilter final : SeparableFilter<MitchellFilter> {
    float b = 1 / 3.0f, c = 1 / 3.0f;

    MitchellFilter() : SeparableFilter(2) {}
    static void describe(Fields<MitchellFilter>& f) {
        f.about("A cubic with slightly negative lobes: sharper than a bell, with a faint ring along strong "
                "edges. "
                "Best with 2 C + B = 1.");
        describe_radius(f);
        f.field("B", &MitchellFilter::b, "blur").in(-2, 2).otherwise("1/3");
        f.field("C", &MitchellFilter::c, "ringing").in(-2, 2).otherwise("1/3");
        f.example("catmull_rom", {make_float("B", 0), make_float("C", 0.5f)});
    }
    float curve(float x, float r) const { return mitchell(2 * x / r, b, c); }
};

} // namespace

Kind<Filter> mitchell_filter() {
    return make_kind<Filter, MitchellFilter>("mitchell");
}

} // namespace alhazen
