/// Fields of bodies that repeat: Menger's sponge and the gyroid.
#include "sdf/sdf.h"

namespace alhazen {

namespace {

struct MengerSpongeSdf final : SdfOf<MengerSpongeSdf> {
    int iterations = 3;

    static void describe(Fields<MengerSpongeSdf>& f) {
        f.about("Menger's sponge: a cube of width 2 around the origin with square holes in its faces, and "
                "smaller ones around those (Menger 1926).");
        f.field("iterations", &MengerSpongeSdf::iterations, "how many sizes of holes").in(0, 8);
        f.example("sponge", {make_integer("iterations", 2)});
    }
    // The cube without ever smaller grids of crosses. Folding space into one cell of a grid is 1-Lipschitz.
    template <class S>
    S at(TVec3<S> p) const {
        TVec3<S> q = absolute(p) - TVec3<S>(S(1.0));
        S d = norm(max(q, TVec3<S>())) + std::min(std::max(q.x, std::max(q.y, q.z)), S(0.0));
        double scale = 1;
        for (int i = 0; i < iterations; ++i) {
            TVec3<S> a;
            for (int k = 0; k < 3; ++k) {
                S x = p[k] * S(scale);
                // From the middle of its cell, in thirds of the cell's half width.
                S from_middle = absolute(x - S(2 * std::floor((value_of(x) + 1) / 2)));
                a[k] = from_middle * S(3.0);
            }
            scale *= 3;
            S cross = std::min(std::max(a.x, a.y), std::min(std::max(a.y, a.z), std::max(a.z, a.x)));
            d = std::max(d, (S(1.0) - cross) / S(scale));
        }
        return d;
    }
    Box bounds() const override { return Box::around(Vec3d(1.0)); }
};

struct GyroidSdf final : SdfOf<GyroidSdf> {
    float period = 1, thickness = 0;

    static void describe(Fields<GyroidSdf>& f) {
        f.about("The gyroid (Schoen 1970), which divides all of space in two equal halves without a plane of "
                "symmetry, in its trigonometric approximation: one half, or a wall along the border. It does "
                "not end; intersect it with something.");
        f.field("period", &GyroidSdf::period, "after which it repeats, along each axis").above(0);
        f.field("thickness", &GyroidSdf::thickness, "of the wall, at least; 0 fills one half of space")
            .at_least(0);
        f.example("half", {make_float("period", 1)});
        f.example("wall", {make_float("period", 1), make_float("thickness", 0.1f)});
    }
    template <class S>
    S at(TVec3<S> p) const {
        double k = 2 * 3.14159265358979323846 / static_cast<double>(period);
        S x = p.x * S(k), y = p.y * S(k), z = p.z * S(k);
        S f = sine(x) * cosine(y) + sine(y) * cosine(z) + sine(z) * cosine(x);
        // Its gradient's length is at most sqrt 3, at the points where the half spaces' handles meet.
        f = f * S(1 / (std::sqrt(3.0) * k));
        return thickness > 0 ? absolute(f) - S(0.5 * static_cast<double>(thickness)) : f;
    }
    Box bounds() const override { return {}; }
};

} // namespace

Kind<Sdf> mengersponge_sdf() {
    return make_kind<Sdf, MengerSpongeSdf>("mengersponge");
}
Kind<Sdf> gyroid_sdf() {
    return make_kind<Sdf, GyroidSdf>("gyroid");
}

} // namespace alhazen
