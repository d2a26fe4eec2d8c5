#include "cameras/pixel_cone.h"

namespace alhazen {

PixelCone pixel_cone(const Camera& camera, Vec2i resolution, int spp) {
    CameraSample at;
    at.lens = {0.5f, 0.5f};
    PixelCone cone;
    float narrowest = infinity;
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) {
            const Vec2 place{(static_cast<float>(i) + 0.5f) / 5 * static_cast<float>(resolution.x),
                             (static_cast<float>(j) + 0.5f) / 5 * static_cast<float>(resolution.y)};
            auto ray_at = [&](Vec2 offset) {
                at.film = place + offset;
                return camera.ray(at);
            };
            const auto here = ray_at({0, 0}), right = ray_at({1, 0}), below = ray_at({0, 1});
            if (!here || !right || !below) continue;
            const float width =
                std::max(length(right->ray.o - here->ray.o), length(below->ray.o - here->ray.o));
            const float spread =
                std::max(length(right->ray.d - here->ray.d), length(below->ray.d - here->ray.d));
            if (!(width + spread < narrowest)) continue;
            narrowest = width + spread;
            cone = {here->ray.o, spread < 1e-7f ? here->ray.d : Vec3(), width, spread};
        }
    const float share = std::max(0.125f, 1 / std::sqrt(static_cast<float>(std::max(spp, 1))));
    cone.width *= share;
    cone.spread *= share;
    return cone;
}

} // namespace alhazen
