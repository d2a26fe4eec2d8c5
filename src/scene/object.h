/// Shapes and instances of other objects under one acceleration structure.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "base/moving_transform.h"
#include "materials/material.h"
#include "media/medium.h"
#include "scene/ball_list.h"
#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

class Object;

/// A shape with what the scene says of it.
struct PlacedShape {
    std::unique_ptr<Shape> shape;
    const Material* material = nullptr;
    std::vector<const Light*> lights; ///< of each primitive, or none
    /// What lights of several primitives are attached to.
    std::vector<std::unique_ptr<const Shape>> joined;
    MediumInterface media;
};

/// An object placed in another.
struct PlacedObject {
    const Object* object = nullptr;
    /// Of what moves, where it is when the shutter opens.
    Transform world_from_object, object_from_world;
    std::shared_ptr<const MovingTransform> movement; ///< nullptr: it stands still
    std::uint32_t number = 0;                        ///< of the instance in the whole scene
};

/// A hit, and through which instances the ray got there.
struct Found {
    static constexpr std::size_t max_depth =
        8; ///< how deep objects may be nested, the scene itself not counted

    Intersection hit;
    const Object* object = nullptr; ///< whose primitive was met
    std::array<const PlacedObject*, max_depth> instances{};
    std::size_t depth = 0;
    Ray ray; ///< in the object's space
};

/// The ray in the instance's space. Its origin is moved forward, to the edge of the rounding error of
/// transforming it, so that it does not meet the surface it was moved off in world space; shift is by how
/// much of t.
Ray ray_into(const PlacedObject& instance, const Ray& ray, float& shift);
Ray ray_into(const Transform& object_from_world, const Ray& ray, float& shift);

class Object final : public Primitives {
  public:
    /// Shapes may be empty; instances refer to finished objects, which must outlive this one.
    Object(std::vector<PlacedShape> shapes, std::vector<PlacedObject> instances,
           const AccelChoice& accel = {});

    /// Updates found when something nearer than ray.tmax is met.
    void closest(const Ray& ray, Found& found) const;
    /// True when something stands before ray.tmax; borders of media do not count.
    bool any(const Ray& ray) const;
    /// The same for many rays at once: hits as constructed, found[i].object set to nullptr where nothing is
    /// hit, blocked set to 0 or 1.
    void closest(std::span<const Ray> rays, std::span<Intersection> hits, std::span<Found> found) const;
    void any(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
    /// Walks as closest or any would, into instances too, and adds what was visited. True when there is a
    /// hit.
    bool count(Query query, const Ray& ray, WalkCounts& counts) const;
    /// The full hit, in world space; shown: in place of the shape's material, which it is or is part of. If
    /// that is a mixture, none of what it mixes is chosen, and none's relief is seen.
    static Hit surface(const Found& found, const Material* shown = nullptr);

    /// The number that a shape's primitive has in Found.
    std::uint32_t number_of(std::uint32_t shape, std::uint32_t primitive) const {
        return leaves_[shape].first + primitive;
    }
    /// The shape and the primitive of that which have a number in Found; no instance has one.
    struct Member {
        std::uint32_t shape, primitive;
    };
    Member member(std::uint32_t number) const {
        return {primitives_[number].shape, primitives_[number].primitive};
    }
    /// Whether the shape is there at all of its points.
    bool is_solid(std::uint32_t shape) const { return leaves_[shape].is_solid; }
    /// Whether it is there where a ray (in the object's space) meets one of its primitives.
    bool is_there(const Ray& ray, std::uint32_t shape, std::uint32_t primitive,
                  const Intersection& hit) const {
        return is_solid(shape) || alpha_passes(ray, {shape, primitive}, hit);
    }

    /// Around all that can be hit, not padded as the structure's own are.
    const Bounds3& bounds() const { return bounds_; }
    const std::vector<PlacedShape>& shapes() const { return shapes_; }
    const std::vector<PlacedObject>& instances() const { return instances_; }
    const Structure& structure() const { return *structure_; }
    /// Whether somebody chose the structure, which gets everything then.
    bool structure_is_chosen() const { return structure_is_chosen_; }
    /// Builds another structure over the same things; for measurements. Nobody may be asking meanwhile.
    void rebuild(const AccelChoice& accel);
    std::size_t primitive_count() const { return primitives_.size(); }
    /// Whether anything in it does.
    bool moves() const;
    /// How deep instances are nested to get out of the innermost: 1 without instances.
    std::size_t height() const { return height_; }

    /// Around a primitive or an instance, whether the structure holds it or not.
    Bounds3 box(std::uint32_t number) const { return box_of(primitives_[number]); }
    std::uint32_t count() const override { return static_cast<std::uint32_t>(primitives_.size()); }
    PrimitiveKind kind(std::uint32_t primitive) const override;
    PrimitiveKinds kinds() const override;
    Bounds3 bounds(std::uint32_t primitive) const override;
    Corners corners(std::uint32_t primitive) const override;
    void gather_corners(std::span<const std::uint32_t> primitives, float* to) const override;
    void prefetch_corners(std::span<const std::uint32_t> primitives, int step) const override;

  private:
    class ClosestTests;
    class AnyTests;

    /// A primitive of a shape, or an instance (shape = instance_mark, primitive = its index).
    struct Primitive {
        std::uint32_t shape, primitive;
    };
    static constexpr std::uint32_t instance_mark = 0xffffffffu;
    /// What the tests need to know of a shape, in one place.
    struct Leaf {
        const Shape* shape;
        const TriangleMesh* mesh; ///< when the primitives are triangles
        bool is_solid, is_interface;
        bool may_be_interface; ///< at some of its points
        bool needs_parameters; ///< whether anybody looks at a hit's uv or tangents
        bool has_relief;       ///< whether the material may turn a hit's normal
        std::uint32_t first;   ///< number of its first primitive

        PrimitiveKind kind() const {
            if (!mesh) return PrimitiveKind::custom;
            return is_solid && !may_be_interface ? PrimitiveKind::triangle : PrimitiveKind::filtered_triangle;
        }
    };

    /// found.instances holds the first depth ones already.
    void closest_nested(const Ray& ray, Found& found, std::size_t depth) const;
    void settle(const Ray& ray, const Intersection& nearest, std::size_t depth, Found& found) const;
    void set_balls_apart();
    Bounds3 box_of(const Primitive& primitive) const;
    bool alpha_passes(const Ray& ray, const Primitive& primitive, const Intersection& hit) const;
    /// Whether the primitive, met there, stops a ray that asks for any hit.
    bool stops(const Ray& ray, const Primitive& primitive, const Intersection& hit) const;

    std::vector<PlacedShape> shapes_;
    std::vector<PlacedObject> instances_;
    std::vector<Leaf> leaves_; ///< one a shape
    std::vector<Primitive> primitives_;
    std::vector<bool> is_apart_; ///< one a shape: it is among the balls, not in the structure
    BallList balls_;
    bool only_balls_ = false; ///< the structure is empty
    bool structure_is_chosen_ = false;
    std::unique_ptr<Structure> structure_;
    Bounds3 bounds_;
    std::size_t height_ = 1;
};

} // namespace alhazen
