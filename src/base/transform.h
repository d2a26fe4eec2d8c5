/// Affine and projective transformations: double-precision matrices to compose, float pairs to apply.
#pragma once

#include <array>
#include <optional>

#include "base/bounds.h"
#include "base/ray.h"

namespace alhazen {

/// Row-major 4 x 4 matrix of doubles; points are columns.
struct Matrix4 {
    std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    bool operator==(const Matrix4&) const = default;
    friend Matrix4 operator*(const Matrix4& a, const Matrix4& b);
    Matrix4 transposed() const;
    /// nullopt when singular or not finite.
    std::optional<Matrix4> inverse() const;
    /// Determinant of the upper left 3 x 3 part; negative when the matrix mirrors.
    double determinant3() const;
    bool is_finite() const;
    /// Of an affine matrix, whose last row is 0 0 0 1.
    Vec3d point(Vec3d p) const { return vector(p) + Vec3d{m[0][3], m[1][3], m[2][3]}; }
    Vec3d vector(Vec3d v) const {
        return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
    }

    static Matrix4 translate(Vec3d v);
    static Matrix4 scale(Vec3d v);
    /// Turns by degrees about axis, counter-clockwise seen against the axis; axis must not be zero.
    static Matrix4 rotate(double degrees, Vec3d axis);
    /// World to camera: eye at the origin, the target on +z, up towards +y, x to the right (left-handed, as
    /// in RenderMan and pbrt). nullopt when eye = target or up is parallel to the view.
    static std::optional<Matrix4> look_at(Vec3d eye, Vec3d target, Vec3d up);
};

/// An invertible transformation and its inverse in single precision, with the error bounds of applying it.
class Transform {
  public:
    Transform() = default;
    /// m must be invertible (check with Matrix4::inverse first); a singular m gives the identity.
    explicit Transform(const Matrix4& m);

    Vec3 point(Vec3 p) const { return apply_point(m_, p); }
    Vec3 vector(Vec3 v) const { return apply_vector(m_, v); }
    /// Transforms by the inverse transpose; the length is not kept.
    Vec3 normal(Vec3 n) const { return apply_transposed(inv_, n); }
    Bounds3 bounds(const Bounds3& b) const;
    Ray ray(const Ray& r) const { return {point(r.o), vector(r.d), r.tmax, r.time}; }
    /// Bound of the absolute error of point(p), given p is known to within +-error.
    Vec3 point_error(Vec3 p, Vec3 error) const;

    Vec3d point(Vec3d p) const { return exact_.point(p); }
    Vec3d vector(Vec3d v) const { return exact_.vector(v); }
    Vec3d inverse_point(Vec3d p) const { return exact_inverse_.point(p); }
    Vec3d inverse_vector(Vec3d v) const { return exact_inverse_.vector(v); }

    Vec3 inverse_point(Vec3 p) const { return apply_point(inv_, p); }
    Vec3 inverse_vector(Vec3 v) const { return apply_vector(inv_, v); }
    Vec3 inverse_normal(Vec3 n) const { return apply_transposed(m_, n); }
    Ray inverse_ray(const Ray& r) const { return {inverse_point(r.o), inverse_vector(r.d), r.tmax, r.time}; }

    Transform inverse() const;
    friend Transform operator*(const Transform& a, const Transform& b);
    const Matrix4& matrix() const { return exact_; }
    const Matrix4& inverse_matrix() const { return exact_inverse_; }
    bool swaps_handedness() const { return exact_.determinant3() < 0; }
    bool is_identity() const { return exact_ == Matrix4{}; }

  private:
    using Rows = std::array<std::array<float, 4>, 3>;
    static Vec3 apply_point(const Rows& m, Vec3 p) {
        return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
                m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
                m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
    }
    static Vec3 apply_vector(const Rows& m, Vec3 v) {
        return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
    }
    static Vec3 apply_transposed(const Rows& m, Vec3 n) {
        return {m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z, m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
                m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z};
    }

    Rows m_{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    Rows inv_{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    Matrix4 exact_, exact_inverse_;
};

} // namespace alhazen
