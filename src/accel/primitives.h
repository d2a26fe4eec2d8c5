/// What acceleration structures are built over, and what walks ask about primitives they cannot decide alone.
///
/// The structures know triangles, which their kernels test themselves, and boxes with something inside, which
/// they hand back to whoever owns it: spheres, curves, instances of other objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/intersection.h"
#include "base/bounds.h"
#include "base/ray.h"

namespace alhazen {

/// How a primitive is tested.
enum class PrimitiveKind : std::uint8_t {
    triangle,          ///< by the kernel alone
    filtered_triangle, ///< by the kernel; then PrimitiveTests says whether the hit counts
    custom,            ///< by PrimitiveTests
};

/// Which kinds there are in a list.
struct PrimitiveKinds {
    bool triangle = false, filtered_triangle = false, custom = false;

    void add(PrimitiveKind kind) {
        triangle |= kind == PrimitiveKind::triangle;
        filtered_triangle |= kind == PrimitiveKind::filtered_triangle;
        custom |= kind == PrimitiveKind::custom;
    }
    void add(const PrimitiveKinds& more) {
        triangle |= more.triangle;
        filtered_triangle |= more.filtered_triangle;
        custom |= more.custom;
    }
    bool only_plain_triangles() const { return !filtered_triangle && !custom; }
};

/// The corners of a triangle.
struct Corners {
    Vec3 a, b, c;
};

/// A numbered list of primitives, as builders see it. All members must be safe to call from any thread.
class Primitives {
  public:
    virtual ~Primitives() = default;

    virtual std::uint32_t count() const = 0;
    virtual PrimitiveKind kind(std::uint32_t primitive) const = 0;
    /// All kinds that kind() gives, maybe more. By itself it asks for every primitive.
    virtual PrimitiveKinds kinds() const;
    /// Contains all that its test can hit, up to a few roundings of the box's coordinates; a primitive whose
    /// box is empty, infinite or NaN is never hit.
    virtual Bounds3 bounds(std::uint32_t primitive) const = 0;
    /// For triangles only, whose box follows from them.
    virtual Corners corners(std::uint32_t primitive) const = 0;
    /// Of n triangles that stand anywhere in memory: coordinate `axis` of corner c of the i-th goes to
    /// to[(3 c + axis) n + i].
    virtual void gather_corners(std::span<const std::uint32_t> primitives, float* to) const {
        const std::size_t n = primitives.size();
        for (std::size_t i = 0; i < n; ++i) store_corners(corners(primitives[i]), to + i, n);
    }
    /// Asks for the memory that gather_corners will read of these triangles, so that it need not wait: step 0
    /// for where it looks first, and, some time after, 1 and 2 for what that refers to.
    virtual void prefetch_corners(std::span<const std::uint32_t> /*primitives*/, int /*step*/) const {}

  protected:
    /// Coordinates that are n apart.
    static void store_corners(const Corners& t, float* to, std::size_t n) {
        const Vec3 corner[3] = {t.a, t.b, t.c};
        for (const Vec3& c : corner)
            for (int axis = 0; axis < 3; ++axis, to += n) *to = c[axis];
    }
};

/// The boxes of all primitives, a little larger than they are: by what a triangle test that moves vertices to
/// the ray's origin and shears them may lose to rounding over the primitive's own extent (Woop, Benthin and
/// Wald 2013, appendix; BoxRay covers the way from the origin to the box). Those that cannot be hit,
/// triangles without area among them, are empty.
std::vector<Bounds3> padded_boxes(const Primitives& primitives);

/// How far padded_boxes moves the sides of a box, and the box after that.
Vec3 padding(const Bounds3& box);
Bounds3 padded(const Bounds3& box);

/// Tests of the primitives that are not plain triangles, for one query of one or many rays.
class PrimitiveTests {
  public:
    virtual ~PrimitiveTests() = default;

    /// ray_index is the ray's place in its batch; ray.tmax is where the search ends by now: an equally near
    /// hit is still inside. best is the nearest hit so far. Of hits at the same distance the one with the
    /// lowest primitive number counts.
    struct Question {
        std::uint32_t ray_index;
        std::uint32_t primitive;
        const Ray& ray;
        const Intersection& best;

        /// Whether a hit at distance t would replace best.
        bool would_win(float t) const { return t < best.t || (t == best.t && primitive < best.primitive); }
    };
    /// Whether the ray meets a custom primitive at 0 < t < ray.tmax; then sets hit's t, u and v.
    virtual bool intersect(const Question& question, Intersection& hit) = 0;
    /// Whether a hit on a filtered triangle counts; it would win.
    virtual bool accept(const Question& question, const Intersection& hit) = 0;
};

/// For objects of plain triangles only.
class NoTests final : public PrimitiveTests {
  public:
    bool intersect(const Question&, Intersection&) override { return false; }
    bool accept(const Question&, const Intersection&) override { return true; }
};

} // namespace alhazen
