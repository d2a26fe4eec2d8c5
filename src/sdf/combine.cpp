/// Several bodies as one: union, intersection, difference, with sharp or rounded seams.
#include "sdf/placed_sdf.h"

namespace alhazen {

namespace {

/// The smaller of two fields; within k of each other they are blended by a parabola (Perlin and Hoffert 1989;
/// Quilez' polynomial form), which takes a quarter of k away where they are equal. A blend of two gradients
/// is no longer than the longer of them.
template <class S>
S smooth_min(S a, S b, double k) {
    S least = std::min(a, b);
    if (k <= 0) return least;
    S h = S(k) - absolute(a - b);
    return h > S(0.0) ? least - h * h * S(0.25 / k) : least;
}

template <class T>
struct Combination : SdfOf<T> {
    SdfChildren children;
    float smooth = 0;

    double noise() const override { return children.noise(); }

  protected:
    template <class F>
    static void describe_common(F& f) {
        f.field("children", &T::children, "names of sdfs that were defined before").required();
        f.field("smooth", &T::smooth,
                "width of the seam: fields that differ by less are blended; 0 keeps edges sharp")
            .at_least(0);
    }
    double seam() const { return static_cast<double>(smooth); }
    /// By how much blending may move the surface.
    double reach() const { return 0.25 * seam() * static_cast<double>(children.list.size() - 1); }
};

struct UnionSdf final : Combination<UnionSdf> {
    static void describe(Fields<UnionSdf>& f) {
        f.about("All that is in any of its children.");
        describe_common(f);
        f.example("snowman", {make_array<std::string>("children", ValueType::string, {"sphere", "small box"}),
                              make_float("smooth", 0.3f)});
    }
    // A child whose box is too far away cannot matter.
    template <class S>
    S at(TVec3<S> p) const {
        S least = children.list.front()->value(p);
        Vec3d q = values_of(p);
        for (std::size_t i = 1; i < children.list.size(); ++i) {
            const PlacedSdf& child = *children.list[i];
            double away = child.bounds().distance(q);
            if (away == 0 || away < value_of(least) + seam())
                least = smooth_min(least, child.value(p), seam());
        }
        return least;
    }
    Box bounds() const override {
        Box box = children.list.front()->bounds();
        for (const auto& child : children.list) box = box.united(child->bounds());
        return box.grown(reach());
    }
};

struct IntersectionSdf final : Combination<IntersectionSdf> {
    static void describe(Fields<IntersectionSdf>& f) {
        f.about("What is in all of its children.");
        describe_common(f);
        f.example("lens", {make_array<std::string>("children", ValueType::string, {"sphere", "small box"})});
    }
    template <class S>
    S at(TVec3<S> p) const {
        S least = -children.list.front()->value(p);
        for (std::size_t i = 1; i < children.list.size(); ++i)
            least = smooth_min(least, -children.list[i]->value(p), seam());
        return -least;
    }
    Box bounds() const override {
        Box box = children.list.front()->bounds();
        for (const auto& child : children.list) box = box.intersected(child->bounds());
        return box;
    }
};

struct DifferenceSdf final : Combination<DifferenceSdf> {
    static void describe(Fields<DifferenceSdf>& f) {
        f.about("Its first child without the others.");
        describe_common(f);
        f.example("bowl", {make_array<std::string>("children", ValueType::string, {"sphere", "small box"}),
                           make_float("smooth", 0.1f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        S least = -children.list.front()->value(p);
        Vec3d q = values_of(p);
        for (std::size_t i = 1; i < children.list.size(); ++i) {
            const PlacedSdf& child = *children.list[i];
            double away = child.bounds().distance(q);
            if (away == 0 || away < value_of(least) + seam())
                least = smooth_min(least, child.value(p), seam());
        }
        return -least;
    }
    Box bounds() const override { return children.list.front()->bounds(); }
};

} // namespace

Kind<Sdf> union_sdf() {
    return make_kind<Sdf, UnionSdf>("union");
}
Kind<Sdf> intersection_sdf() {
    return make_kind<Sdf, IntersectionSdf>("intersection");
}
Kind<Sdf> difference_sdf() {
    return make_kind<Sdf, DifferenceSdf>("difference");
}

} // namespace alhazen
