#include "cameras/camera.h"

namespace alhazen {

#define KIND(name) Kind<Camera> name##_camera();
#include "cameras/list.h"
#undef KIND

const KindList<Camera>& camera_kinds() {
    static const KindList<Camera> kinds{
#define KIND(name) name##_camera(),
#include "cameras/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
