#include "scene/object.h"

#include <unordered_set>

#include "base/hash.h"
#include "base/threads.h"

namespace alhazen {

namespace {

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

// The change of a unit normal n (before the transformation) that t does not leave at unit length.
Vec3 transform_change(const Transform& t, Vec3 n, Vec3 change) {
    const Vec3 scaled = t.normal(n), unit = normalize(scaled);
    const Vec3 d = t.normal(change) / length(scaled);
    return d - unit * dot(unit, d);
}

// Calls use with where the instance is at the time.
template <class Use>
auto with_place(const PlacedObject& instance, float time, Use use) {
    return instance.movement ? use(instance.movement->at(time)) : use(instance.world_from_object);
}

// Turns the hit's normal by the relief of its material.
void apply_relief(const Shape& shape, const Found& found, const Hit& local, Hit& hit) {
    if (hit.material->relief.is_flat()) return;
    NormalChange change = shape.normal_change(local);
    Vec3 n = local.ns;
    for (std::size_t i = found.depth; i-- > 0;) {
        with_place(*found.instances[i], found.ray.time, [&](const Transform& t) {
            change = {transform_change(t, n, change.dndu), transform_change(t, n, change.dndv)};
            n = normalize(t.normal(n));
        });
    }
    if (dot(n, hit.ns) < 0) change = {-change.dndu, -change.dndv};
    hit.material->relief.apply(hit, change);
}

} // namespace

Ray ray_into(const PlacedObject& instance, const Ray& ray, float& shift) {
    if (instance.movement) return ray_into(instance.movement->at(ray.time).inverse(), ray, shift);
    return ray_into(instance.object_from_world, ray, shift);
}

Ray ray_into(const Transform& object_from_world, const Ray& ray, float& shift) {
    Ray local = object_from_world.ray(ray);
    Vec3 error = object_from_world.point_error(ray.o, Vec3{});
    float len2 = length_squared(local.d);
    shift = len2 > 0 ? dot(abs(local.d), error) / len2 : 0;
    local.o += local.d * shift;
    local.tmax -= shift;
    return local;
}

Object::Object(std::vector<PlacedShape> shapes, std::vector<PlacedObject> instances, const AccelChoice& accel)
    : shapes_(std::move(shapes)), instances_(std::move(instances)) {
    for (const PlacedObject& instance : instances_)
        height_ = std::max(height_, instance.object->height() + 1);
    for (std::uint32_t s = 0; s < shapes_.size(); ++s) {
        const PlacedShape& placed = shapes_[s];
        const FloatTexture& alpha = placed.shape->alpha;
        leaves_.push_back({placed.shape.get(), placed.shape->triangles(),
                           alpha.is_constant() && alpha.constant() >= 1,
                           placed.material && placed.material->is_interface(),
                           placed.material && placed.material->may_be_interface(),
                           !placed.material || placed.material->needs_parameters() || !placed.lights.empty(),
                           placed.material && placed.material->has_relief(),
                           static_cast<std::uint32_t>(primitives_.size())});
        for (std::uint32_t i = 0; i < shapes_[s].shape->primitive_count(); ++i) primitives_.push_back({s, i});
    }
    for (std::uint32_t i = 0; i < instances_.size(); ++i) primitives_.push_back({instance_mark, i});
    is_apart_.assign(shapes_.size(), false);
    structure_is_chosen_ = accel.name() != AccelChoice{}.name();
    if (!structure_is_chosen_) set_balls_apart();
    structure_ = make_structure(*this, accel);
    bounds_ = parallel_sum<Bounds3>(
        primitives_.size(), 16384, Bounds3{},
        [this](Bounds3& box, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Bounds3 one = box_of(primitives_[i]);
                if (is_finite(one.lo) && is_finite(one.hi) && !one.empty()) box.extend(one);
            }
        },
        [](Bounds3& box, const Bounds3& part) { box.extend(part); });
}

bool Object::moves() const {
    // Each object is asked once: nested instances lead to it in more ways than could be counted.
    std::vector<const Object*> to_ask{this};
    std::unordered_set<const Object*> known{this};
    while (!to_ask.empty()) {
        const Object* object = to_ask.back();
        to_ask.pop_back();
        for (const PlacedObject& instance : object->instances_) {
            if (instance.movement) return true;
            if (known.insert(instance.object).second) to_ask.push_back(instance.object);
        }
    }
    return false;
}

void Object::rebuild(const AccelChoice& accel) {
    is_apart_.assign(shapes_.size(), false);
    balls_ = {};
    only_balls_ = false;
    structure_is_chosen_ = true;
    structure_ = make_structure(*this, accel);
}

void Object::set_balls_apart() {
    std::vector<BallList::Numbered> balls;
    for (std::uint32_t i = 0; i < primitives_.size(); ++i) {
        const Primitive& p = primitives_[i];
        if (p.shape == instance_mark || !leaves_[p.shape].is_solid || leaves_[p.shape].may_be_interface)
            continue;
        // What has no finite box is never hit.
        if (auto ball = shapes_[p.shape].shape->ball(); ball && is_finite(box_of(p).diagonal()))
            balls.push_back({*ball, i});
        if (balls.size() > BallList::most) return;
    }
    for (const BallList::Numbered& ball : balls) is_apart_[primitives_[ball.primitive].shape] = true;
    balls_ = BallList(std::move(balls));
    only_balls_ =
        instances_.empty() && std::find(is_apart_.begin(), is_apart_.end(), false) == is_apart_.end();
}

PrimitiveKind Object::kind(std::uint32_t primitive) const {
    const Primitive& p = primitives_[primitive];
    return p.shape == instance_mark ? PrimitiveKind::custom : leaves_[p.shape].kind();
}

PrimitiveKinds Object::kinds() const {
    PrimitiveKinds kinds;
    for (const Leaf& leaf : leaves_) kinds.add(leaf.kind());
    if (!instances_.empty()) kinds.add(PrimitiveKind::custom);
    return kinds;
}

// As the structure sees it.
Bounds3 Object::bounds(std::uint32_t primitive) const {
    const Primitive& p = primitives_[primitive];
    return p.shape != instance_mark && is_apart_[p.shape] ? Bounds3{} : box_of(p);
}

Bounds3 Object::box_of(const Primitive& p) const {
    if (p.shape != instance_mark) return shapes_[p.shape].shape->bounds(p.primitive);
    const PlacedObject& instance = instances_[p.primitive];
    if (instance.object->bounds().empty()) return {};
    const Bounds3& inside = instance.object->bounds();
    Bounds3 box =
        instance.movement ? instance.movement->bounds(inside) : instance.world_from_object.bounds(inside);
    // Rays are transformed into the instance with a few roundings of their coordinates there, which seen from
    // here are a few of the box's.
    Vec3 pad = (max(abs(box.lo), abs(box.hi)) + box.diagonal()) * (16 * 0x1p-24f);
    return {box.lo - pad, box.hi + pad};
}

Corners Object::corners(std::uint32_t primitive) const {
    const Primitive& p = primitives_[primitive];
    auto [a, b, c] = leaves_[p.shape].mesh->vertices(p.primitive);
    return {a, b, c};
}

void Object::gather_corners(std::span<const std::uint32_t> primitives, float* to) const {
    const std::size_t n = primitives.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Primitive& p = primitives_[primitives[i]];
        const TriangleMesh& mesh = *leaves_[p.shape].mesh;
        const int* indices = &mesh.indices[std::size_t{3} * p.primitive];
        auto at = [&](int corner) { return mesh.P[static_cast<std::size_t>(indices[corner])]; };
        store_corners({at(0), at(1), at(2)}, to + i, n);
    }
}

void Object::prefetch_corners(std::span<const std::uint32_t> primitives, int step) const {
    for (const std::uint32_t primitive : primitives) {
        const Primitive* p = &primitives_[primitive];
        if (step == 0) {
            __builtin_prefetch(p);
            continue;
        }
        const TriangleMesh& mesh = *leaves_[p->shape].mesh;
        const int* indices = &mesh.indices[std::size_t{3} * p->primitive];
        if (step == 1)
            __builtin_prefetch(indices);
        else
            for (int corner = 0; corner < 3; ++corner)
                __builtin_prefetch(&mesh.P[static_cast<std::size_t>(indices[corner])]);
    }
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

bool Object::stops(const Ray& ray, const Primitive& primitive, const Intersection& hit) const {
    const Leaf& leaf = leaves_[primitive.shape];
    if (leaf.is_interface) return false;
    if (!leaf.is_solid && !alpha_passes(ray, primitive, hit)) return false;
    if (!leaf.may_be_interface) return true;
    const PlacedShape& placed = shapes_[primitive.shape];
    return !placed.material->choose(placed.shape->surface(ray, primitive.primitive, hit))->is_interface();
}

/// Instances are searched from within the search outside: what is met there becomes the ray's find.
class Object::ClosestTests final : public PrimitiveTests {
  public:
    /// counts: where what is visited inside instances is added, or none.
    ClosestTests(const Object& object, std::span<Found> found, std::size_t depth,
                 WalkCounts* counts = nullptr)
        : object_(object), found_(found), depth_(depth), counts_(counts) {}

    bool intersect(const Question& q, Intersection& hit) override {
        const Primitive& primitive = object_.primitives_[q.primitive];
        if (primitive.shape == instance_mark) return enter(q, object_.instances_[primitive.primitive], hit);
        const Leaf& leaf = object_.leaves_[primitive.shape];
        return leaf.shape->intersect(q.ray, primitive.primitive, hit) &&
               (leaf.is_solid || object_.alpha_passes(q.ray, primitive, hit));
    }
    bool accept(const Question& q, const Intersection& hit) override {
        const Primitive& primitive = object_.primitives_[q.primitive];
        return object_.leaves_[primitive.shape].is_solid || object_.alpha_passes(q.ray, primitive, hit);
    }

  private:
    bool enter(const Question& q, const PlacedObject& instance, Intersection& hit) {
        Found& found = found_[q.ray_index];
        float shift = 0;
        Ray local = ray_into(instance, q.ray, shift);
        Found inner;
        inner.instances = found.instances;
        inner.instances[depth_] = &instance;
        if (counts_) instance.object->count(Query::closest, local, *counts_);
        instance.object->closest_nested(local, inner, depth_ + 1);
        hit.t = inner.hit.t + shift;
        if (!inner.object || !q.would_win(hit.t)) return false;
        found = inner;
        return true;
    }

    const Object& object_;
    std::span<Found> found_;
    std::size_t depth_;
    WalkCounts* counts_;
};

class Object::AnyTests final : public PrimitiveTests {
  public:
    explicit AnyTests(const Object& object, WalkCounts* counts = nullptr)
        : object_(object), counts_(counts) {}

    bool intersect(const Question& q, Intersection& hit) override {
        const Primitive& primitive = object_.primitives_[q.primitive];
        if (primitive.shape == instance_mark) {
            const PlacedObject& instance = object_.instances_[primitive.primitive];
            float shift = 0;
            hit.t = 0;
            Ray local = ray_into(instance, q.ray, shift);
            return counts_ ? instance.object->count(Query::any, local, *counts_)
                           : instance.object->any(local);
        }
        const Leaf& leaf = object_.leaves_[primitive.shape];
        return !leaf.is_interface && leaf.shape->intersect(q.ray, primitive.primitive, hit) &&
               object_.stops(q.ray, primitive, hit);
    }
    bool accept(const Question& q, const Intersection& hit) override {
        return object_.stops(q.ray, object_.primitives_[q.primitive], hit);
    }

  private:
    const Object& object_;
    WalkCounts* counts_;
};

void Object::closest(const Ray& ray, Found& found) const {
    closest_nested(ray, found, 0);
}

void Object::closest_nested(const Ray& ray, Found& found, std::size_t depth) const {
    ClosestTests tests(*this, {&found, 1}, depth);
    Intersection nearest;
    if (!only_balls_) structure_->closest(ray, nearest, tests);
    balls_.closest(ray, nearest);
    if (nearest.found()) settle(ray, nearest, depth, found);
}

void Object::closest(std::span<const Ray> rays, std::span<Intersection> hits, std::span<Found> found) const {
    ClosestTests tests(*this, found, 0);
    for (Found& f : found) f.object = nullptr;
    structure_->closest(rays, hits, tests);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        balls_.closest(rays[i], hits[i]);
        if (hits[i].found()) settle(rays[i], hits[i], 0, found[i]);
    }
}

// An instance's test has filled found already.
void Object::settle(const Ray& ray, const Intersection& nearest, std::size_t depth, Found& found) const {
    if (primitives_[nearest.primitive].shape == instance_mark) return;
    found.hit = nearest;
    found.object = this;
    found.depth = depth;
    found.ray = ray;
}

bool Object::any(const Ray& ray) const {
    if (balls_.any(ray)) return true;
    if (only_balls_) return false;
    AnyTests tests(*this);
    return structure_->any(ray, tests);
}

void Object::any(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
    AnyTests tests(*this);
    structure_->any(rays, blocked, tests);
    if (balls_.empty()) return;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!blocked[i]) blocked[i] = balls_.any(rays[i]);
}

bool Object::count(Query query, const Ray& ray, WalkCounts& counts) const {
    if (query == Query::any) {
        AnyTests tests(*this, &counts);
        return structure_->count(query, ray, tests, counts) || balls_.any(ray);
    }
    Found found;
    ClosestTests tests(*this, {&found, 1}, 0, &counts);
    Intersection nearest;
    balls_.closest(ray, nearest);
    return structure_->count(query, ray, tests, counts) || nearest.found();
}

Hit Object::surface(const Found& found, const Material* shown) {
    const Primitive& primitive = found.object->primitives_[found.hit.primitive];
    const PlacedShape& placed = found.object->shapes_[primitive.shape];
    const Leaf& leaf = found.object->leaves_[primitive.shape];
    Hit hit = leaf.needs_parameters || leaf.has_relief
                  ? placed.shape->surface(found.ray, primitive.primitive, found.hit)
                  : placed.shape->plain_surface(found.ray, primitive.primitive, found.hit);
    const Hit local = leaf.has_relief ? hit : Hit{};
    hit.shape = primitive.shape;
    hit.primitive = primitive.primitive;
    hit.material = shown ? shown : placed.material;
    hit.media = placed.media.is_border() ? &placed.media : nullptr;
    hit.area_light = placed.lights.empty() ? nullptr : placed.lights[primitive.primitive];
    for (std::size_t i = found.depth; i-- > 0;)
        with_place(*found.instances[i], found.ray.time, [&](const Transform& t) { transform_hit(t, hit); });
    if (found.depth > 0) hit.instance = found.instances[found.depth - 1]->number + 1;
    if (!leaf.has_relief) return hit;
    if (!shown) hit.material = hit.material->choose(hit);
    apply_relief(*placed.shape, found, local, hit);
    return hit;
}

} // namespace alhazen
