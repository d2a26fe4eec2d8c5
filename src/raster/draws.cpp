#include "raster/draws.h"

#include <unordered_map>

#include "raster/setup.h"

namespace alhazen {

namespace {

/// A ray costs about as much as so many triangles.
constexpr double triangles_a_ray = 32;
/// Primitives that are kept in memory at most.
constexpr double most_primitives = 6e7;

/// Where a box is on the film.
struct BoxOnFilm {
    bool is_in_view = false;
    double area = 0; ///< of the rectangle around it in the viewport, pixels
};

BoxOnFilm project(const Matrix4& film_from_object, const Bounds3& box, const Rect2i& part) {
    int all = 31, any = 0;
    Vec2d lo(viewport_size, viewport_size), hi;
    for (int i = 0; i < 8; ++i) {
        const Vec3d p(box.corner(i));
        auto row = [&](std::size_t r) {
            const auto& m = film_from_object.m[r];
            return m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
        };
        const double x = row(0), y = row(1), depth = row(2), w = row(3);
        // A pixel of slack keeps what rounding would put outside.
        const int sides = (x < (part.lo.x - 1) * w ? 1 : 0) | (x > (part.hi.x + 1) * w ? 2 : 0) |
                          (y < (part.lo.y - 1) * w ? 4 : 0) | (y > (part.hi.y + 1) * w ? 8 : 0) |
                          (depth <= 0 ? 16 : 0);
        all &= sides;
        any |= sides;
        lo = {std::min(lo.x, x / w), std::min(lo.y, y / w)};
        hi = {std::max(hi.x, x / w), std::max(hi.y, y / w)};
    }
    if (all) return {};
    // Not within the part, which must not decide how things are drawn.
    auto length_within = [](double from, double to) {
        return std::max(0.0, std::min(to, double{viewport_size}) - std::max(from, 0.0)) + 1;
    };
    if (any & 16) return {true, double{viewport_size} * viewport_size};
    return {true, length_within(lo.x, hi.x) * length_within(lo.y, hi.y)};
}

class Collector {
  public:
    Collector(const Matrix4& film_from_world, const Rect2i& part, int samples)
        : film_from_world_(film_from_world), part_(part), samples_(samples) {}

    void add(const Object& object, Draw& at) {
        at.film_from_object = film_from_world_ * at.world_from_object;
        if (object.bounds().empty() && at.depth > 0) return;
        const BoxOnFilm box = project(at.film_from_object, object.bounds(), part_);
        // The scene's own bounds leave out shapes without end.
        if (!box.is_in_view && at.depth > 0) return;
        at.object = &object;
        if (at.depth > 0 && count(object) > triangles_a_ray * box.area * samples_) {
            at.shape = Draw::whole_object;
            draws.push_back(at);
            return;
        }
        for (at.shape = 0; at.shape < object.shapes().size(); ++at.shape)
            if (!at.placed().material || !at.placed().material->is_interface()) {
                draws.push_back(at);
                primitives += at.placed().shape->primitive_count();
            }
        for (const PlacedObject& instance : object.instances()) {
            Draw inner = at;
            inner.instances[inner.depth++] = &instance;
            inner.world_from_object = at.world_from_object * instance.world_from_object.matrix();
            add(*instance.object, inner);
        }
    }

    std::vector<Draw> draws;
    double primitives = 0; ///< of all draws

  private:
    // Primitives, those of instances within counted each time.
    double count(const Object& object) {
        auto known = counts_.find(&object);
        if (known != counts_.end()) return known->second;
        double sum = 0;
        for (const PlacedShape& placed : object.shapes()) sum += placed.shape->primitive_count();
        for (const PlacedObject& instance : object.instances()) sum += count(*instance.object);
        return counts_[&object] = sum;
    }

    Matrix4 film_from_world_;
    Rect2i part_;
    int samples_;
    std::unordered_map<const Object*, double> counts_;
};

} // namespace

Ray PlacedSurface::local_ray(const Ray& ray, float& shift) const {
    Ray local = ray;
    shift = 0;
    for (std::size_t i = 0; i < depth; ++i) {
        float step = 0;
        local = ray_into(*instances[i], local, step);
        shift += step;
    }
    return local;
}

Hit PlacedSurface::surface(const Ray& local, std::uint32_t primitive, const Intersection& met,
                           const Material* shown) const {
    Found found;
    found.hit = met;
    found.hit.primitive = object->number_of(shape, primitive);
    found.object = object;
    found.instances = instances;
    found.depth = depth;
    found.ray = local;
    return Object::surface(found, shown);
}

std::vector<Draw> collect_draws(const Scene& scene, const Projection& projection, Vec2i origin,
                                const Rect2i& part, int samples) {
    // A shift by pixels goes by w.
    Matrix4 viewport_from_film;
    viewport_from_film.m[0][3] = -origin.x;
    viewport_from_film.m[1][3] = -origin.y;
    Collector collector(viewport_from_film * projection.film_from_world, part, samples);
    Draw start;
    collector.add(scene.root(), start);
    if (collector.primitives > most_primitives) {
        start.shape = Draw::whole_object;
        return {start};
    }
    return std::move(collector.draws);
}

} // namespace alhazen
