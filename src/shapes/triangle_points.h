/// Points chosen uniformly over the triangles that stand for a curved surface, made when they are first asked
/// for: most surfaces are no lights.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/vec.h"

namespace alhazen {

class TrianglePoints {
  public:
    TrianglePoints() = default;
    /// Triangles in object space; to_world says where they are when areas are measured.
    TrianglePoints(std::vector<std::array<Vec3d, 3>> triangles, const std::function<Vec3d(Vec3d)>& to_world);

    /// In the world.
    float area() const { return static_cast<float>(area_); }
    /// A point of object space, uniform over the area in the world; nullopt when there is no area.
    std::optional<Vec3d> at(Vec2 u) const;

  private:
    std::vector<std::array<Vec3d, 3>> triangles_;
    std::vector<double> up_to_; ///< area of the triangles so far
    double area_ = 0;
};

/// A value that the first who asks for it makes, whichever thread that is.
template <class T>
class OnDemand {
  public:
    template <class Make>
    const T& get(const Make& make) const {
        std::call_once(state_->once, [&] { state_->value = make(); });
        return state_->value;
    }

  private:
    struct State {
        std::once_flag once;
        T value;
    };
    std::unique_ptr<State> state_ = std::make_unique<State>();
};

} // namespace alhazen
