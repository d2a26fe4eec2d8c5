#include "accel/structure.h"

namespace alhazen {

void Structure::closest(std::span<const Ray> rays, std::span<Intersection> hits,
                        PrimitiveTests& tests) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        closest(rays[i], hits[i], tests, static_cast<std::uint32_t>(i));
}

void Structure::any(std::span<const Ray> rays, std::span<std::uint8_t> blocked, PrimitiveTests& tests) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
        blocked[i] = any(rays[i], tests, static_cast<std::uint32_t>(i));
}

} // namespace alhazen
