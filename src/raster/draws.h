/// The scene as a list of shapes, each with its place: instances within instances unfolded, what is outside
/// of the picture left out.
#pragma once

#include <array>
#include <vector>

#include "cameras/projection.h"
#include "scene/scene.h"

namespace alhazen {

/// One shape at one place.
struct PlacedSurface {
    const Object* object = nullptr;
    std::uint32_t shape = 0; ///< number in the object
    std::array<const PlacedObject*, Found::max_depth> instances{};
    std::size_t depth = 0; ///< how many instances it is in

    const PlacedShape& placed() const { return object->shapes()[shape]; }
    /// As in Hit.
    std::uint32_t instance_number() const { return depth > 0 ? instances[depth - 1]->number + 1 : 0; }
    /// The world's ray in the object's space; shift is by how much its t is less than the world's.
    Ray local_ray(const Ray& ray, float& shift) const;
    Ray local_ray(const Ray& ray) const {
        float shift = 0;
        return local_ray(ray, shift);
    }
    /// The hit that a local ray makes with a primitive of the shape; shown: as for Object::surface.
    Hit surface(const Ray& local, std::uint32_t primitive, const Intersection& met,
                const Material* shown = nullptr) const;
};

/// Something to draw.
struct Draw : PlacedSurface {
    /// In place of the shape's number: all shapes of the object and its instances, to be ray cast.
    static constexpr std::uint32_t whole_object = 0xffffffffu;

    Matrix4 film_from_object; ///< see Projection; places on the film in pixels of the viewport
    Matrix4 world_from_object;

    bool is_whole_object() const { return shape == whole_object; }
};

/// Draws for a viewport that starts at that pixel of the film, of which that part is wanted. Surfaces that
/// are only borders of media are left out. Instances that hold so many primitives that casting rays costs
/// less, with so many samples a pixel, are whole objects; so is the scene itself, where it holds too many.
std::vector<Draw> collect_draws(const Scene& scene, const Projection& projection, Vec2i origin,
                                const Rect2i& part, int samples);

} // namespace alhazen
