#include "base/transform.h"

namespace alhazen {

Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
    Matrix4 r;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k) sum += a.m[i][k] * b.m[k][j];
            r.m[i][j] = sum;
        }
    return r;
}

Matrix4 Matrix4::transposed() const {
    Matrix4 r;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) r.m[i][j] = m[j][i];
    return r;
}

bool Matrix4::is_finite() const {
    for (const auto& row : m)
        for (double v : row)
            if (!std::isfinite(v)) return false;
    return true;
}

double Matrix4::determinant3() const {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

// Gauss-Jordan elimination with partial pivoting.
std::optional<Matrix4> Matrix4::inverse() const {
    if (!is_finite()) return std::nullopt;
    auto a = m;
    Matrix4 result;
    auto& b = result.m;
    for (std::size_t col = 0; col < 4; ++col) {
        std::size_t pivot = col;
        for (std::size_t row = col + 1; row < 4; ++row)
            if (std::abs(a[row][col]) > std::abs(a[pivot][col])) pivot = row;
        if (a[pivot][col] == 0) return std::nullopt;
        std::swap(a[col], a[pivot]);
        std::swap(b[col], b[pivot]);
        double scale = 1 / a[col][col];
        for (std::size_t j = 0; j < 4; ++j) {
            a[col][j] *= scale;
            b[col][j] *= scale;
        }
        for (std::size_t row = 0; row < 4; ++row) {
            double factor = a[row][col];
            if (row == col || factor == 0) continue;
            for (std::size_t j = 0; j < 4; ++j) {
                a[row][j] -= factor * a[col][j];
                b[row][j] -= factor * b[col][j];
            }
        }
    }
    if (!result.is_finite()) return std::nullopt;
    return result;
}

Matrix4 Matrix4::translate(Vec3d v) {
    Matrix4 r;
    r.m[0][3] = v.x;
    r.m[1][3] = v.y;
    r.m[2][3] = v.z;
    return r;
}

Matrix4 Matrix4::scale(Vec3d v) {
    Matrix4 r;
    r.m[0][0] = v.x;
    r.m[1][1] = v.y;
    r.m[2][2] = v.z;
    return r;
}

Matrix4 Matrix4::rotate(double degrees, Vec3d axis) {
    Vec3d a = normalize(axis);
    double theta = degrees * (3.14159265358979323846 / 180);
    double s = std::sin(theta), c = std::cos(theta), k = 1 - c;
    Matrix4 r;
    r.m = {{{a.x * a.x * k + c, a.x * a.y * k - a.z * s, a.x * a.z * k + a.y * s, 0},
            {a.x * a.y * k + a.z * s, a.y * a.y * k + c, a.y * a.z * k - a.x * s, 0},
            {a.x * a.z * k - a.y * s, a.y * a.z * k + a.x * s, a.z * a.z * k + c, 0},
            {0, 0, 0, 1}}};
    return r;
}

std::optional<Matrix4> Matrix4::look_at(Vec3d eye, Vec3d target, Vec3d up) {
    if (!(length(target - eye) > 0) || !(length(up) > 0)) return std::nullopt;
    Vec3d z = normalize(target - eye);
    Vec3d right = cross(normalize(up), z);
    if (!(length(right) > 0)) return std::nullopt;
    Vec3d x = normalize(right);
    Vec3d y = cross(z, x);
    Matrix4 r;
    r.m = {{{x.x, x.y, x.z, -dot(x, eye)},
            {y.x, y.y, y.z, -dot(y, eye)},
            {z.x, z.y, z.z, -dot(z, eye)},
            {0, 0, 0, 1}}};
    return r;
}

Transform::Transform(const Matrix4& m) {
    auto inverse = m.inverse();
    if (!inverse) return;
    exact_ = m;
    exact_inverse_ = *inverse;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            m_[i][j] = static_cast<float>(m.m[i][j]);
            inv_[i][j] = static_cast<float>(inverse->m[i][j]);
        }
}

Transform Transform::inverse() const {
    Transform r = *this;
    std::swap(r.m_, r.inv_);
    std::swap(r.exact_, r.exact_inverse_);
    return r;
}

Transform operator*(const Transform& a, const Transform& b) {
    return Transform(a.exact_ * b.exact_);
}

Bounds3 Transform::bounds(const Bounds3& b) const {
    Bounds3 r;
    if (b.empty()) return r;
    for (int i = 0; i < 8; ++i) {
        Vec3 p = b.corner(i);
        Vec3 q = point(p), e = point_error(p, Vec3{});
        r.extend(q - e);
        r.extend(q + e);
    }
    return r;
}

// Pharr, Jakob and Humphreys 2023, section 6.8.5: each row is three products and three sums, plus the
// rounding of the matrix itself to float.
Vec3 Transform::point_error(Vec3 p, Vec3 error) const {
    Vec3 r;
    for (int i = 0; i < 3; ++i) {
        const auto& row = m_[static_cast<std::size_t>(i)];
        float carried = std::abs(row[0]) * error.x + std::abs(row[1]) * error.y + std::abs(row[2]) * error.z;
        float magnitude =
            std::abs(row[0] * p.x) + std::abs(row[1] * p.y) + std::abs(row[2] * p.z) + std::abs(row[3]);
        r[i] = (gamma_bound(4) + 1) * carried + gamma_bound(4) * magnitude;
    }
    return r;
}

} // namespace alhazen
