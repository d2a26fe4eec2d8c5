/// Operators that deform space around the z axis (Barr 1984): twist and bend. Each divides its child's field
/// by the most that the deformation stretches lengths within the cylinder that holds the child.
#include "sdf/placed_sdf.h"
#include "sdf/region.h"

namespace alhazen {

namespace {

template <class T>
struct Deformation : SdfOf<T> {
    SdfChild child;
    float angle = 90;

    void finish(const Node& node, BuildContext& context) {
        if (!require_bounded(child, node, context)) return;
        rate_ = static_cast<double>(angle) * (3.14159265358979323846 / 180);
        Box box = child->bounds();
        // A little more, so that the field is positive on the border.
        radius_ = box.radius_about_z() * (1 + 1e-6);
        stretch_ = static_cast<T*>(this)->most_stretch(std::abs(rate_) * radius_);
    }
    template <class S>
    S at(TVec3<S> p) const {
        return continue_beyond_cylinder(p, radius_, [&](TVec3<S> q) {
            S turn = static_cast<const T*>(this)->turn(q) * S(-rate_), c = cosine(turn), s = sine(turn);
            return child->value(TVec3<S>{q.x * c - q.y * s, q.x * s + q.y * c, q.z}) / S(stretch_);
        });
    }
    Box bounds() const override {
        Box box = child->bounds();
        box.lo.x = box.lo.y = -radius_;
        box.hi.x = box.hi.y = radius_;
        return box;
    }
    double noise() const override { return child->noise() / stretch_; }

  protected:
    template <class F>
    static void describe_common(F& f) {
        f.field("child", &T::child, "name of an sdf that was defined before").required();
        f.field("angle", &T::angle, "by which it turns a unit of length").unit("degrees");
    }

  private:
    double rate_ = 0, radius_ = 1, stretch_ = 1;
};

struct TwistSdf final : Deformation<TwistSdf> {
    static void describe(Fields<TwistSdf>& f) {
        f.about("Twists a body around the z axis: each height is turned in proportion to z.");
        describe_common(f);
        f.example("screw", {make_string("child", "small box"), make_float("angle", 60)});
    }
    template <class S>
    S turn(TVec3<S> p) const {
        return p.z;
    }
    // Along the cylinder of that radius the deformation is a shear by k: the larger singular value of
    // [1 k; 0 1].
    static double most_stretch(double k) { return 0.5 * (k + std::sqrt(k * k + 4)); }
};

struct BendSdf final : Deformation<BendSdf> {
    static void describe(Fields<BendSdf>& f) {
        f.about(
            "Bends a body in the xy plane: each point is turned around the z axis in proportion to its x. A "
            "bar along x becomes an arc.");
        describe_common(f);
        f.example("banana", {make_string("child", "small box"), make_float("angle", 40)});
    }
    template <class S>
    S turn(TVec3<S> p) const {
        return p.x;
    }
    // The derivative is a rotation of I + k u e_x^T with |u| <= 1.
    static double most_stretch(double k) { return 1 + k; }
};

} // namespace

Kind<Sdf> twist_sdf() {
    return make_kind<Sdf, TwistSdf>("twist");
}
Kind<Sdf> bend_sdf() {
    return make_kind<Sdf, BendSdf>("bend");
}

} // namespace alhazen
