/// Operators that move a body's surface: offset and shell.
#include "sdf/placed_sdf.h"

namespace alhazen {

namespace {

struct OffsetSdf final : SdfOf<OffsetSdf> {
    SdfChild child;
    float distance = 0.1f;

    static void describe(Fields<OffsetSdf>& f) {
        f.about("A body with its surface moved outward: larger, and with its edges rounded.");
        f.field("child", &OffsetSdf::child, "name of an sdf that was defined before").required();
        f.field("distance", &OffsetSdf::distance, "by how much; inward when negative");
        f.example("padded", {make_string("child", "small box"), make_float("distance", 0.2f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return child->value(p) - S(static_cast<double>(distance));
    }
    Box bounds() const override {
        return child->bounds().grown(std::max(0.0, static_cast<double>(distance)));
    }
    double noise() const override { return child->noise(); }
};

struct ShellSdf final : SdfOf<ShellSdf> {
    SdfChild child;
    float thickness = 0.1f;

    static void describe(Fields<ShellSdf>& f) {
        f.about("A wall along a body's surface, half of it outside.");
        f.field("child", &ShellSdf::child, "name of an sdf that was defined before").required();
        f.field("thickness", &ShellSdf::thickness, "of the wall").above(0);
        f.example("hollow", {make_string("child", "sphere"), make_float("thickness", 0.25f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        return absolute(child->value(p)) - S(0.5 * static_cast<double>(thickness));
    }
    Box bounds() const override { return child->bounds().grown(0.5 * static_cast<double>(thickness)); }
    double noise() const override { return child->noise(); }
};

} // namespace

Kind<Sdf> offset_sdf() {
    return make_kind<Sdf, OffsetSdf>("offset");
}
Kind<Sdf> shell_sdf() {
    return make_kind<Sdf, ShellSdf>("shell");
}

} // namespace alhazen
