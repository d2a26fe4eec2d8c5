/// Shapes: surfaces that rays meet and lights are made of. A shape has one or more primitives (a mesh's
/// triangles, a single sphere), which the acceleration structure sees one by one.
#pragma once

#include <functional>
#include <optional>

#include "accel/intersection.h"
#include "base/bounds.h"
#include "base/hit.h"
#include "describe/kind.h"
#include "shapes/ball.h"
#include "textures/texture.h"

namespace alhazen {

struct TriangleMesh; // shapes/triangle_mesh.h
struct Corners;      // accel/primitives.h

/// Takes triangles, one after the other.
using TriangleSink = std::function<void(const Corners&)>;

/// A point chosen on a primitive.
struct ShapeSample {
    Vec3 p, p_error;
    Vec3 ng; ///< unit, outward
    Vec2 uv;
    float pdf = 0; ///< per unit of area, or per steradian, as the function says
};

/// World-space geometry; immutable once built. The normal ng points outward as pbrt defines it: by the
/// parameterisation (dpdu x dpdv) or, where the mesh has vertex normals, to their side; turned over by
/// ReverseOrientation xor a mirroring transformation.
struct Shape {
    static constexpr std::string_view family_name = "shape";
    virtual ~Shape() = default;

    virtual std::uint32_t primitive_count() const { return 1; }
    virtual Bounds3 bounds(std::uint32_t primitive) const = 0;

    /// When the ray meets the primitive at 0 < t < ray.tmax: sets hit's t, u, v and returns true; otherwise
    /// leaves hit alone. Must be safe for any ray, NaN and infinity included (then: no hit).
    virtual bool intersect(const Ray& ray, std::uint32_t primitive, Intersection& hit) const = 0;
    /// Everything geometric about an intersection: p, p_error, wo, ng, ns, dpdu, dpdv, uv, t, time,
    /// primitive. (material, area_light, shape and instance are the scene's.)
    virtual Hit surface(const Ray& ray, std::uint32_t primitive, const Intersection& hit) const = 0;

    /// The same, but where that is a saving, without uv and tangents (which are then zero).
    virtual Hit plain_surface(const Ray& ray, std::uint32_t primitive, const Intersection& hit) const {
        return surface(ray, primitive, hit);
    }

    /// How the shading normal changes at a hit that surface() made; asked only where bumps need it. Zero says
    /// that bumps are low beside the radius of curvature.
    virtual NormalChange normal_change(const Hit&) const { return {}; }

    /// False where points cannot be chosen on it: it cannot be an area light then.
    virtual bool can_be_light() const { return true; }
    virtual float area(std::uint32_t primitive) const = 0;
    /// A point uniform over the primitive's area (density 1 / area).
    virtual ShapeSample sample(std::uint32_t primitive, Vec2 u) const = 0;
    /// A point chosen with a density per steradian seen from reference; nullopt when none can be seen. The
    /// default chooses by area and converts.
    virtual std::optional<ShapeSample> sample_from(std::uint32_t primitive, Vec3 reference, Vec2 u) const;
    /// The density per steradian with which sample_from chooses the point of the hit, met along the unit
    /// direction wi from reference.
    virtual float pdf_from(std::uint32_t primitive, Vec3 reference, const Hit& hit, Vec3 wi) const;
    /// A cone holding all outward normals of the primitive: axis (unit) and cosine of the half angle (-1:
    /// any).
    struct NormalCone {
        Vec3 axis{0, 0, 1};
        float cosine = -1;
    };
    virtual NormalCone normals(std::uint32_t /*primitive*/) const { return {}; }

    /// The mesh, when the primitives are triangles: scenes test those without a virtual call a triangle.
    virtual const TriangleMesh* triangles() const { return nullptr; }

    /// Cuts the whole surface into triangles, whose points are at most tolerance (in the world, above 0) away
    /// from it, and from whose outside, by the parameterisation, the corners go round counter-clockwise: from
    /// the inside for ReverseOrientation. Returns false, and gives none, for kinds that cannot be cut.
    virtual bool tessellate(double tolerance, const TriangleSink& out) const;

    /// The ball that it is, if so: scenes test few of those together.
    virtual std::optional<Ball> ball() const { return std::nullopt; }

    /// Memory of the shape, its arrays included.
    virtual std::size_t bytes() const = 0;

    /// Fraction of the surface that is there: 1 solid, 0 not there; between, by chance.
    FloatTexture alpha{1.0f};

  protected:
    template <class T>
    static void describe_common(Fields<T>& f) {
        f.field("alpha", &T::alpha, "opacity: 1 solid, 0 not there").in(0, 1);
    }
};

/// Kinds' finish(node, context) takes context.world_from_node and context.reverse_orientation.
const KindList<Shape>& shape_kinds();

} // namespace alhazen
