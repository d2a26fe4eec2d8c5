/// Pictures of a scene for the page: what the camera sees, and how much work each pixel is.
#include "base/threads.h"
#include "lab/measure.h"

namespace alhazen {

namespace {

// A grey picture: value(ray) for the ray through each pixel's centre, 0 where there is none.
template <class Value>
Image grey_view(const World& world, Vec2i size, const Value& value) {
    Image image = Image::grey_image(size.x, size.y);
    parallel_for(static_cast<std::size_t>(size.y), 1, [&](std::size_t row) {
        int y = static_cast<int>(row);
        for (int x = 0; x < size.x; ++x)
            if (auto ray = camera_ray(world, {x, y}, size)) image.at(x, y) = value(*ray);
    });
    return image;
}

} // namespace

Image headlight_view(const World& world, Vec2i size) {
    return grey_view(world, size, [&](const Ray& ray) {
        auto hit = world.scene->closest(ray);
        return hit ? 0.02f + 0.8f * std::abs(dot(hit->ns, hit->wo)) : 0.0f;
    });
}

Image count_visits(const World& world, Vec2i size) {
    return grey_view(world, size, [&](const Ray& ray) {
        WalkCounts counts;
        world.scene->root().count(Query::closest, ray, counts);
        return static_cast<float>(counts.nodes);
    });
}

} // namespace alhazen
