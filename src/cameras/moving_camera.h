/// A camera that moves while the shutter is open.
#pragma once

#include <memory>

#include "base/moving_transform.h"
#include "cameras/camera.h"

namespace alhazen {

/// camera: placed at the origin, without any transformation.
std::unique_ptr<Camera> make_moving_camera(std::unique_ptr<Camera> camera,
                                           const MovingTransform& world_from_camera);

} // namespace alhazen
