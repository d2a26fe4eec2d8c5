#include "sdf/voxel_field.h"

namespace alhazen {

namespace {

double value_at(const Cubic& c, double s) {
    return ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
}

double slope_at(const Cubic& c, double s) {
    return (3 * c[3] * s + 2 * c[2]) * s + c[1];
}

// The zero between a, where sign * c is not negative, and b, where it is; c has no turn between.
double bracketed_zero(const Cubic& c, double a, double b, double sign) {
    double s = 0.5 * (a + b);
    for (int i = 0; i < 100 && b - a > 1e-15 * (std::abs(a) + std::abs(b)); ++i) {
        double f = sign * value_at(c, s);
        if (f == 0) return s;
        (f > 0 ? a : b) = s;
        double next = s - f / (sign * slope_at(c, s));
        if (std::abs(next - s) <= 1e-16 * std::abs(s)) return s;
        s = next > a && next < b ? next : 0.5 * (a + b);
    }
    return s;
}

// Where the derivative is zero, in ascending order.
int turns_of(const Cubic& c, std::array<double, 2>& turns) {
    double a = 3 * c[3], h = c[2], k = c[1], discriminant = h * h - a * k;
    if (!(discriminant > 0)) return 0;
    double q = h < 0 ? -h + std::sqrt(discriminant) : -h - std::sqrt(discriminant);
    int n = 0;
    if (a != 0 && std::isfinite(q / a)) turns[static_cast<std::size_t>(n++)] = q / a;
    if (q != 0 && std::isfinite(k / q)) turns[static_cast<std::size_t>(n++)] = k / q;
    if (n == 2 && turns[1] < turns[0]) std::swap(turns[0], turns[1]);
    return n;
}

} // namespace

std::optional<double> first_sign_change(const Cubic& c, double end, double sign) {
    std::array<double, 2> turns{};
    int n = turns_of(c, turns);
    double from = 0;
    for (int i = 0; i <= n; ++i) {
        double to = i < n ? std::min(turns[static_cast<std::size_t>(i)], end) : end;
        if (!(to > from)) continue;
        if (sign * value_at(c, to) < 0) return bracketed_zero(c, from, to, sign);
        from = to;
    }
    return std::nullopt;
}

} // namespace alhazen
