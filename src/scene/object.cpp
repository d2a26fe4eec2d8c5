#include "scene/object.h"

#include "base/hash.h"

namespace alhazen {

namespace {

/// The ray in the instance's space. Its origin is moved forward, to the edge of the rounding error of
/// transforming it, so that it does not meet the surface it was moved off in world space; shift is by how
/// much of t.
Ray ray_into(const PlacedObject& instance, const Ray& ray, float& shift) {
    Ray local = instance.object_from_world.ray(ray);
    Vec3 error = instance.object_from_world.point_error(ray.o, Vec3{});
    float len2 = length_squared(local.d);
    shift = len2 > 0 ? dot(abs(local.d), error) / len2 : 0;
    local.o += local.d * shift;
    local.tmax -= shift;
    return local;
}

std::vector<Bounds3> bounds_of(const std::vector<PlacedShape>& shapes,
                               const std::vector<PlacedObject>& instances) {
    std::vector<Bounds3> bounds;
    for (const PlacedShape& s : shapes)
        for (std::uint32_t i = 0; i < s.shape->primitive_count(); ++i) bounds.push_back(s.shape->bounds(i));
    for (const PlacedObject& o : instances) bounds.push_back(o.world_from_object.bounds(o.object->bounds()));
    return bounds;
}

// The hit seen from outside the instance.
void transform_hit(const Transform& t, Hit& hit) {
    hit.p_error = t.point_error(hit.p, hit.p_error);
    hit.p = t.point(hit.p);
    hit.ng = normalize(t.normal(hit.ng));
    hit.ns = face_forward(normalize(t.normal(hit.ns)), hit.ng);
    hit.dpdu = t.vector(hit.dpdu);
    hit.dpdv = t.vector(hit.dpdv);
    hit.wo = normalize(t.vector(hit.wo));
}

} // namespace

Object::Object(std::vector<PlacedShape> shapes, std::vector<PlacedObject> instances)
    : shapes_(std::move(shapes)), instances_(std::move(instances)), bvh_(bounds_of(shapes_, instances_)) {
    primitives_.reserve(bvh_.primitive_count());
    for (const PlacedObject& instance : instances_)
        height_ = std::max(height_, instance.object->height() + 1);
    for (const PlacedShape& placed : shapes_) {
        const FloatTexture& alpha = placed.shape->alpha;
        leaves_.push_back({placed.shape.get(), placed.shape->triangles(),
                           alpha.is_constant() && alpha.constant() >= 1,
                           placed.material && placed.material->is_interface()});
    }
    has_triangles_ = std::any_of(leaves_.begin(), leaves_.end(), [](const Leaf& l) { return l.mesh; });
    for (std::uint32_t s = 0; s < shapes_.size(); ++s)
        for (std::uint32_t i = 0; i < shapes_[s].shape->primitive_count(); ++i) primitives_.push_back({s, i});
    for (std::uint32_t i = 0; i < instances_.size(); ++i) primitives_.push_back({instance_mark, i});
}

bool Object::meets(const Ray& ray, const PreparedRay& prepared, const Primitive& primitive,
                   Intersection& hit) const {
    const Leaf& leaf = leaves_[primitive.shape];
    bool met = leaf.mesh ? leaf.mesh->intersect_with(ray, *prepared.shear, primitive.primitive, hit)
                         : leaf.shape->intersect(ray, primitive.primitive, hit);
    return met && (leaf.is_solid || alpha_passes(ray, primitive, hit));
}

// Chance decides between solid and absent, by a hash of the ray: the same ray always sees the same surface.
bool Object::alpha_passes(const Ray& ray, const Primitive& primitive, const Intersection& hit) const {
    const PlacedShape& placed = shapes_[primitive.shape];
    float alpha =
        placed.shape->alpha.eval(TexturePoint(placed.shape->surface(ray, primitive.primitive, hit)));
    if (alpha >= 1) return true;
    if (!(alpha > 0)) return false;
    auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
    std::uint64_t h = hash_of(bits(ray.o.x), bits(ray.o.y), bits(ray.o.z), bits(ray.d.x), bits(ray.d.y),
                              bits(ray.d.z), primitive.shape, primitive.primitive);
    return unit_float(h) < alpha;
}

void Object::closest(const Ray& ray, Found& found) const {
    closest_nested(ray, found, 0);
}

void Object::closest_nested(const Ray& ray, Found& found, std::size_t depth) const {
    const PreparedRay prepared(ray, has_triangles_);
    Intersection nearest;
    bvh_.closest(ray, nearest, [&](std::uint32_t index, const Ray& r, Intersection& hit) {
        const Primitive& primitive = primitives_[index];
        if (primitive.shape != instance_mark) return meets(r, prepared, primitive, hit);
        const PlacedObject& instance = instances_[primitive.primitive];
        float shift = 0;
        Ray local = ray_into(instance, r, shift);
        Found inner;
        inner.instances = found.instances;
        inner.instances[depth] = &instance;
        instance.object->closest_nested(local, inner, depth + 1);
        hit.t = inner.hit.t + shift;
        // Of hits at the same distance the first primitive counts, as in the walk, so that found follows it.
        if (!inner.object || hit.t > nearest.t || (hit.t == nearest.t && index > nearest.primitive))
            return false;
        found = inner;
        return true;
    });
    if (!nearest.found() || primitives_[nearest.primitive].shape == instance_mark) return;
    found.hit = nearest;
    found.object = this;
    found.depth = depth;
    found.ray = ray;
}

bool Object::any(const Ray& ray) const {
    const PreparedRay prepared(ray, has_triangles_);
    return bvh_.any(ray, [&](std::uint32_t index, const Ray& r, Intersection& hit) {
        const Primitive& primitive = primitives_[index];
        if (primitive.shape == instance_mark) {
            const PlacedObject& instance = instances_[primitive.primitive];
            float shift = 0;
            hit.t = 0;
            return instance.object->any(ray_into(instance, r, shift));
        }
        return !leaves_[primitive.shape].is_interface && meets(r, prepared, primitive, hit);
    });
}

Hit Object::surface(const Found& found) {
    const Primitive& primitive = found.object->primitives_[found.hit.primitive];
    const PlacedShape& placed = found.object->shapes_[primitive.shape];
    Hit hit = placed.shape->surface(found.ray, primitive.primitive, found.hit);
    hit.shape = primitive.shape;
    hit.primitive = primitive.primitive;
    hit.material = placed.material;
    hit.area_light = placed.lights.empty() ? nullptr : placed.lights[primitive.primitive];
    for (std::size_t i = found.depth; i-- > 0;) transform_hit(found.instances[i]->world_from_object, hit);
    if (found.depth > 0) hit.instance = found.instances[found.depth - 1]->number + 1;
    return hit;
}

} // namespace alhazen
