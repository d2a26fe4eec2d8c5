/// Shapes and instances of other objects under one acceleration structure.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "accel/bvh.h"
#include "materials/material.h"
#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace alhazen {

class Object;

/// A shape with what the scene says of it.
struct PlacedShape {
    std::unique_ptr<Shape> shape;
    const Material* material = nullptr;
    std::vector<const Light*> lights; ///< one a primitive, or none
};

/// An object placed in another.
struct PlacedObject {
    const Object* object = nullptr;
    Transform world_from_object, object_from_world;
    std::uint32_t number = 0; ///< of the instance in the whole scene
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

class Object {
  public:
    /// Shapes may be empty; instances refer to finished objects.
    Object(std::vector<PlacedShape> shapes, std::vector<PlacedObject> instances);

    /// Updates found when something nearer than ray.tmax is met.
    void closest(const Ray& ray, Found& found) const;
    /// True when something stands before ray.tmax; borders of media do not count.
    bool any(const Ray& ray) const;
    /// The full hit, in world space.
    static Hit surface(const Found& found);

    Bounds3 bounds() const { return bvh_.bounds(); }
    const std::vector<PlacedShape>& shapes() const { return shapes_; }
    const std::vector<PlacedObject>& instances() const { return instances_; }
    const Bvh& bvh() const { return bvh_; }
    std::size_t primitive_count() const { return primitives_.size(); }
    /// How deep instances are nested to get out of the innermost: 1 without instances.
    std::size_t height() const { return height_; }

  private:
    /// A primitive of a shape, or an instance (shape = instance_mark, primitive = its index).
    struct Primitive {
        std::uint32_t shape, primitive;
    };
    static constexpr std::uint32_t instance_mark = 0xffffffffu;
    /// What the leaf test needs of a shape, in one place.
    struct Leaf {
        const Shape* shape;
        const TriangleMesh* mesh; ///< tested without a virtual call
        bool is_solid, is_interface;
    };

    /// What is computed once a ray for the tests of its leaves.
    struct PreparedRay {
        std::optional<RayShear> shear; ///< where there are triangles

        PreparedRay(const Ray& ray, bool has_triangles) {
            if (has_triangles) shear.emplace(ray);
        }
    };

    /// found.instances holds the first depth ones already.
    void closest_nested(const Ray& ray, Found& found, std::size_t depth) const;
    bool meets(const Ray& ray, const PreparedRay& prepared, const Primitive& primitive,
               Intersection& hit) const;
    bool alpha_passes(const Ray& ray, const Primitive& primitive, const Intersection& hit) const;

    std::vector<PlacedShape> shapes_;
    std::vector<PlacedObject> instances_;
    std::vector<Leaf> leaves_; ///< one a shape
    std::vector<Primitive> primitives_;
    bool has_triangles_ = false;
    Bvh bvh_;
    std::size_t height_ = 1;
};

} // namespace alhazen
