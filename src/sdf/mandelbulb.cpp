/// The Mandelbulb (White and Nylander 2009): the Mandelbrot set's iteration z^n + c on points of space, a
/// power being n-fold angles from and around the polar axis.
#include "sdf/region.h"
#include "sdf/sdf.h"

namespace alhazen {

namespace {

template <class S>
struct Complex {
    S re, im;
    friend Complex operator*(Complex a, Complex b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
};

template <class S>
Complex<S> power_of(Complex<S> base, int exponent) {
    Complex<S> result{S(1.0), S(0.0)};
    for (; exponent > 0; exponent /= 2, base = base * base)
        if (exponent % 2) result = result * base;
    return result;
}

/// Points that escape beyond this distance after some iterations are outside.
constexpr double escape = 2;

struct MandelbulbSdf final : SdfOf<MandelbulbSdf> {
    int power = 8, iterations = 8;

    static void describe(Fields<MandelbulbSdf>& f) {
        f.about("The Mandelbulb, a fractal a little larger than the unit ball: the points whose orbit stays "
                "within distance 2 for that many iterations. Its field is no distance, but a ball around the "
                "point of which it is proved that the surface does not enter it; it may jump by factors, so "
                "operators that blend or deform fields do better without it.");
        f.field("power", &MandelbulbSdf::power, "of the iteration z^power + c").in(2, 16);
        f.field("iterations", &MandelbulbSdf::iterations, "how often it is repeated").in(1, 16);
        f.example("bulb", {make_integer("iterations", 5)});
    }
    void finish(const Node&, BuildContext&) { radius_ = std::pow(2.0, 1.0 / (power - 1)); }

    template <class S>
    S at(TVec3<S> p) const {
        return continue_beyond_ball(p, 1.25 * radius_, [&](TVec3<S> q) {
            double value = proved_radius(values_of(q));
            if constexpr (std::is_same_v<S, double>) return value;
            return with_gradient(value, outward(values_of(q)), q);
        });
    }
    // From there on orbits grow with every step; the rest is for those that are still within the escape
    // distance after the last.
    Box bounds() const override { return Box::around(Vec3d(1.25 * radius_)); }
    bool is_lipschitz() const override { return false; }

  private:
    template <class S>
    TVec3<S> next(TVec3<S> z, TVec3<S> c) const {
        S rho = norm(z.x, z.y);
        Complex<S> polar = power_of<S>({z.z, rho}, power), around{S(0.0), S(0.0)};
        if (value_of(rho) > 0) around = power_of<S>({z.x / rho, z.y / rho}, power);
        return {polar.im * around.re + c.x, polar.im * around.im + c.y, polar.re + c.z};
    }

    // The power's Lipschitz constant on the ball of radius e around z: n |z|^(n-1) away from the pole and
    // along meridians, |sin n theta / sin theta| <= min(n, 1 / sin theta) times that around the axis.
    double most_growth(Vec3d z, double e) const {
        double r = length(z) + e, rho = std::hypot(z.x, z.y) - e, n = power;
        double around = rho > 0 ? std::min(n, r / rho) : n;
        return n * std::pow(r, n - 1) * around;
    }

    // Whether all points within rho of c are on the side that c is on: their orbits are followed in balls.
    bool is_proved(Vec3d c, double rho, bool is_outside) const {
        Vec3d z = c;
        double e = rho;
        for (int i = 0;; ++i) {
            double r = length(z);
            if (is_outside && r - e > escape) return true;
            if (!is_outside && r + e > escape) return false;
            if (i == iterations) return !is_outside;
            if (!(e < escape)) return false;
            e = most_growth(z, e) * e + rho;
            z = next(z, c);
        }
    }

    double proved_radius(Vec3d c) const {
        Vec3d z = c;
        double growth = 1, r = length(z);
        int i = 0;
        for (; i < iterations && r <= escape; ++i) {
            growth = growth * power * std::pow(r, power - 1) + 1;
            z = next(z, c);
            r = length(z);
        }
        bool is_outside = r > escape;
        // The usual estimate |z| log |z| / |z'| (Hart, Sandin and Kauffman 1989) is a good first guess.
        double rho = is_outside ? r * std::log(r) / growth : (escape - r) / growth;
        for (int k = 0; k < 40 && !is_proved(c, rho, is_outside); ++k) rho *= 0.5;
        rho = std::max(rho, 1e-13);
        return is_outside ? rho : -rho;
    }

    // Along which the orbit grows.
    Vec3d outward(Vec3d p) const {
        TVec3<Dual> c = dual_point(p), z = c;
        for (int i = 0; i < iterations && norm(z).v <= escape; ++i) z = next(z, c);
        Vec3d g = norm(z).d;
        double l = length(g);
        return l > 0 && std::isfinite(l) ? g * (1 / l) : normalize(p);
    }

    double radius_ = 2;
};

} // namespace

Kind<Sdf> mandelbulb_sdf() {
    return make_kind<Sdf, MandelbulbSdf>("mandelbulb");
}

} // namespace alhazen
