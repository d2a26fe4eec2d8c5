#include "base/moving_transform.h"

namespace alhazen {

namespace {

using Rows = std::array<std::array<double, 4>, 4>;

Matrix4 linear_part(const Matrix4& matrix) {
    Matrix4 r = matrix;
    for (std::size_t i = 0; i < 3; ++i) r.m[i][3] = 0;
    return r;
}

template <class F>
Matrix4 combine(const Matrix4& a, const Matrix4& b, F f) {
    Matrix4 r;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) r.m[i][j] = f(a.m[i][j], b.m[i][j]);
    return r;
}

double norm(const Matrix4& a) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum += a.m[i][j] * a.m[i][j];
    return std::sqrt(sum);
}

/// The rotation nearest to the matrix, by averaging with the inverse's transpose (Higham 1986).
std::optional<Matrix4> nearest_rotation(Matrix4 r) {
    for (int i = 0; i < 100; ++i) {
        const auto inverse = r.inverse();
        if (!inverse) return std::nullopt;
        const Matrix4 next =
            combine(r, inverse->transposed(), [](double a, double b) { return (a + b) / 2; });
        const double change = norm(combine(next, r, [](double a, double b) { return a - b; }));
        r = next;
        if (change < 1e-14 * norm(r)) break;
    }
    return r;
}

/// Of a rotation matrix (Shepperd 1978): by the largest component, so that nothing cancels.
Quaternion quaternion_of(const Rows& m) {
    const double trace = m[0][0] + m[1][1] + m[2][2];
    if (trace > 0) {
        const double s = 2 * std::sqrt(trace + 1);
        return {(m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4};
    }
    const std::size_t i = m[0][0] > m[1][1] ? (m[0][0] > m[2][2] ? 0 : 2) : (m[1][1] > m[2][2] ? 1 : 2);
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * std::sqrt(std::max(0.0, 1 + m[i][i] - m[j][j] - m[k][k]));
    double v[3];
    v[i] = s / 4;
    v[j] = (m[j][i] + m[i][j]) / s;
    v[k] = (m[k][i] + m[i][k]) / s;
    return {v[0], v[1], v[2], (m[k][j] - m[j][k]) / s};
}

Matrix4 matrix_of(const Quaternion& q) {
    Matrix4 r;
    r.m = {{{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w), 2 * (q.x * q.z + q.y * q.w), 0},
            {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w), 0},
            {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y), 0},
            {0, 0, 0, 1}}};
    return r;
}

double dot(const Quaternion& a, const Quaternion& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

Quaternion weighted(const Quaternion& a, double wa, const Quaternion& b, double wb) {
    return {a.x * wa + b.x * wb, a.y * wa + b.y * wb, a.z * wa + b.z * wb, a.w * wa + b.w * wb};
}

/// At even speed along the great circle; angle is that between the two.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double angle, double t) {
    const double s = std::sin(angle);
    Quaternion q = s < 1e-9 ? weighted(a, 1 - t, b, t)
                            : weighted(a, std::sin((1 - t) * angle) / s, b, std::sin(t * angle) / s);
    const double l = std::sqrt(dot(q, q));
    return {q.x / l, q.y / l, q.z / l, q.w / l};
}

} // namespace

std::optional<MovingTransform::Parts> MovingTransform::take_apart(const Matrix4& matrix) {
    const auto& m = matrix.m;
    if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1 || !matrix.inverse())
        return std::nullopt;
    Parts parts;
    parts.translation = {m[0][3], m[1][3], m[2][3]};
    const Matrix4 linear = linear_part(matrix);
    auto rotation = nearest_rotation(linear);
    if (!rotation) return std::nullopt;
    // What mirrors is a rotation of what is turned inside out.
    if (linear.determinant3() < 0)
        rotation = combine(*rotation, *rotation, [](double a, double) { return -a; });
    parts.rotation = quaternion_of(rotation->m);
    parts.stretch = rotation->transposed() * linear;
    return parts;
}

std::optional<MovingTransform> MovingTransform::make(const Matrix4& start, const Matrix4& end,
                                                     float start_time, float end_time) {
    const auto a = take_apart(start), b = take_apart(end);
    if (!(start_time < end_time) || !a || !b || (start.determinant3() < 0) != (end.determinant3() < 0))
        return std::nullopt;
    MovingTransform r;
    r.start_ = *a;
    r.end_ = *b;
    // A quaternion and its negative are the same rotation.
    if (dot(a->rotation, b->rotation) < 0) r.end_.rotation = weighted(b->rotation, -1, b->rotation, 0);
    r.angle_ = std::acos(std::clamp(dot(r.start_.rotation, r.end_.rotation), -1.0, 1.0));
    r.start_time_ = static_cast<double>(start_time);
    r.end_time_ = static_cast<double>(end_time);
    return r;
}

Transform MovingTransform::at(float time) const {
    const double passed = static_cast<double>(time) - start_time_;
    return at_fraction(std::clamp(passed / (end_time_ - start_time_), 0.0, 1.0));
}

Transform MovingTransform::at_fraction(double t) const {
    const Matrix4 rotation = matrix_of(slerp(start_.rotation, end_.rotation, angle_, t));
    const Matrix4 stretch =
        combine(start_.stretch, end_.stretch, [t](double a, double b) { return a * (1 - t) + b * t; });
    const Vec3d move = start_.translation * (1 - t) + end_.translation * t;
    return Transform(Matrix4::translate(move) * rotation * stretch);
}

// The boxes at some times, and around them what the way between two of these may deviate from a straight
// line: a function whose second derivative is at most c stays within c h^2 / 8 of its chord over h (which,
// moving evenly, is within the two boxes' common one).
Bounds3 MovingTransform::bounds(const Bounds3& box) const {
    Bounds3 all;
    if (box.empty()) return all;
    constexpr int steps = 32;
    for (int i = 0; i <= steps; ++i) all.extend(at_fraction(static_cast<double>(i) / steps).bounds(box));
    double farthest = 0;
    for (int i = 0; i < 8; ++i) farthest = std::max(farthest, length(Vec3d(box.corner(i))));
    // Quaternions turn by half of the angle.
    const double turn = 2 * angle_, stretch = std::max(norm(start_.stretch), norm(end_.stretch));
    const double stretch_change =
        norm(combine(start_.stretch, end_.stretch, [](double a, double b) { return a - b; }));
    const double bend = (turn * turn * stretch + 2 * turn * stretch_change) * farthest;
    const Vec3 pad(static_cast<float>(bend / (8.0 * steps * steps) * (1 + 1e-6)));
    return {all.lo - pad, all.hi + pad};
}

bool MovingTransform::is_rigid() const {
    auto keeps_lengths = [](const Matrix4& stretch) {
        const Matrix4 square = stretch * stretch;
        return norm(combine(square, Matrix4{}, [](double a, double b) { return a - b; })) < 1e-5;
    };
    return keeps_lengths(start_.stretch) && keeps_lengths(end_.stretch) &&
           norm(combine(start_.stretch, end_.stretch, [](double a, double b) { return a - b; })) < 1e-5;
}

} // namespace alhazen
