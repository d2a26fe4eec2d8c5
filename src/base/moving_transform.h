/// Transformations that change with time: from one at the start of the motion to another at its end (Shoemake
/// and Duff 1992, "Matrix animation and polar decomposition"; Pharr et al. 2023, section 3.9.3).
#pragma once

#include <optional>

#include "base/transform.h"

namespace alhazen {

/// Unit quaternion: a rotation.
struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
};

/// Each matrix is taken apart into a stretch, a rotation and a translation; these are interpolated, the
/// rotation along the shortest way at even speed. Before the start and after the end nothing moves.
class MovingTransform {
  public:
    /// nullopt when a matrix is singular or not affine, or when one mirrors and the other does not, so that
    /// on the way everything would be flat; or where not start_time < end_time (s).
    static std::optional<MovingTransform> make(const Matrix4& start, const Matrix4& end, float start_time,
                                               float end_time);

    Transform at(float time) const;
    /// Contains the box's places at all times.
    Bounds3 bounds(const Bounds3& box) const;
    /// Whether lengths stay as they are at all times.
    bool is_rigid() const;

  private:
    struct Parts {
        Vec3d translation;
        Quaternion rotation;
        Matrix4 stretch; ///< symmetric, and negative where the matrix mirrors
    };
    /// t: 0 at the start, 1 at the end.
    Transform at_fraction(double t) const;
    static std::optional<Parts> take_apart(const Matrix4& matrix);

    Parts start_, end_;
    double start_time_ = 0, end_time_ = 1;
    double angle_ = 0; ///< radians, between the ends' quaternions
};

} // namespace alhazen
