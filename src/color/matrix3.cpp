#include "color/matrix3.h"

namespace alhazen {

Matrix3 Matrix3::diagonal(Vec3d d) {
    return {{{{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}}};
}

Matrix3 Matrix3::from_columns(Vec3d a, Vec3d b, Vec3d c) {
    return {{{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}}};
}

Matrix3 Matrix3::inverse() const {
    Vec3d a(m[0][0], m[1][0], m[2][0]), b(m[0][1], m[1][1], m[2][1]), c(m[0][2], m[1][2], m[2][2]);
    // The rows of the inverse are the cross products of the columns, over the determinant.
    Vec3d u = cross(b, c), v = cross(c, a), w = cross(a, b);
    double determinant = dot(a, u);
    if (determinant == 0 || !std::isfinite(determinant)) return {};
    u = u / determinant;
    v = v / determinant;
    w = w / determinant;
    return {{{{u.x, u.y, u.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}}}};
}

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    Matrix3 product;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            product.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
    return product;
}

} // namespace alhazen
