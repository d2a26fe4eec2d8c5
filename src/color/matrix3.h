/// 3 x 3 matrices of doubles, for conversions between colour spaces.
#pragma once

#include <array>

#include "base/vec.h"

namespace alhazen {

/// Row-major; colours are columns.
struct Matrix3 {
    std::array<std::array<double, 3>, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    static Matrix3 diagonal(Vec3d d);
    static Matrix3 from_columns(Vec3d a, Vec3d b, Vec3d c);
    /// The inverse; the identity for a singular matrix.
    Matrix3 inverse() const;
    bool operator==(const Matrix3&) const = default;
    friend Matrix3 operator*(const Matrix3& a, const Matrix3& b);
    friend Vec3d operator*(const Matrix3& a, Vec3d v) { return {a.row(0, v), a.row(1, v), a.row(2, v)}; }
    friend Vec3 operator*(const Matrix3& a, Vec3 v) { return Vec3(a * Vec3d(v)); }

  private:
    constexpr double row(std::size_t i, Vec3d v) const {
        return m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
    }
};

} // namespace alhazen
