/// Where a quadric stands in the world. Quadrics are intersected in their own coordinates in double
/// precision, so that a floor of radius 10000 and a marble on it are both exact to the last bit of a float.
#pragma once

#include <optional>

#include "accel/primitives.h"
#include "base/bounds.h"
#include "base/ray.h"
#include "describe/context.h"
#include "describe/scene_description.h"
#include "sdf/placed_sdf.h"

namespace alhazen {

/// A ray in object coordinates; distances along it are those along the world's ray.
struct ObjectRay {
    Vec3d o, d;
    Vec3d at(double t) const { return o + d * t; }
};

class Placement {
  public:
    /// Takes the node's transformation and orientation from the context; adds an error when the
    /// transformation cannot be undone.
    void set(const Node& node, const BuildContext& context);

    ObjectRay to_object(const Ray& ray) const {
        return {world_from_object_.inverse_point(Vec3d(ray.o)),
                world_from_object_.inverse_vector(Vec3d(ray.d))};
    }
    Vec3d to_object(Vec3 p) const { return world_from_object_.inverse_point(Vec3d(p)); }
    Vec3d to_object_vector(Vec3d v) const { return world_from_object_.inverse_vector(v); }
    Vec3d point(Vec3d p) const { return world_from_object_.point(p); }
    Vec3d vector(Vec3d v) const { return world_from_object_.vector(v); }
    /// Bound of the error of Vec3(point(p)).
    Vec3 point_error(Vec3d p) const;
    /// The unit normal in the world of a normal that points outward by the parameterisation.
    Vec3 normal(Vec3d n) const;

    /// Area in the world over area in object space, where the object's unit normal is n.
    double stretch(Vec3d n) const { return std::abs(determinant_) * length(transposed_inverse(n)); }
    /// Solid angle in object space over solid angle in the world, around the world's unit direction w.
    double solid_angle_ratio(Vec3 w) const;
    /// Whether all directions are stretched alike.
    bool is_similarity() const { return is_similarity_; }
    /// No length grows by more than this.
    double largest_stretch() const { return alhazen::largest_stretch(world_from_object_.matrix()); }
    /// The world's triangle of three points, which go round counter-clockwise seen from outside: they do so
    /// in the world, too, but the other way for ReverseOrientation.
    Corners triangle(Vec3d a, Vec3d b, Vec3d c) const {
        if (is_turned_) std::swap(b, c);
        return {Vec3(point(a)), Vec3(point(b)), Vec3(point(c))};
    }
    /// By how much lengths grow, where lengths grow alike in all directions to the last bits of a double;
    /// nullopt otherwise.
    std::optional<double> uniform_scale() const { return uniform_scale_; }
    /// The normal that points outward by the parameterisation, turned to the side it shall have.
    Vec3 turned(Vec3 outward) const { return is_turned_ ? -outward : outward; }
    bool is_turned() const { return is_turned_; }

    /// Boxes in the world, rounded outward: around a ball at the origin, around a disk across the z axis, and
    /// around a box.
    Bounds3 ball_bounds(double radius) const;
    Bounds3 disk_bounds(double radius, double z) const;
    Bounds3 box_bounds(Vec3d lo, Vec3d hi) const;

  private:
    Vec3d transposed_inverse(Vec3d n) const;

    Transform world_from_object_;
    double determinant_ = 1;
    bool is_similarity_ = true;
    std::optional<double> uniform_scale_ = 1;
    bool is_turned_ = false; ///< normals point against the parameterisation
};

/// The box around the points with angle 0 ... phimax (radians) and distance up to radius from the z axis.
void sector_box(double radius, double phimax, Vec3d& lo, Vec3d& hi);

inline Bounds3 intersection_of(const Bounds3& a, const Bounds3& b) {
    return {max(a.lo, b.lo), min(a.hi, b.hi)};
}

} // namespace alhazen
