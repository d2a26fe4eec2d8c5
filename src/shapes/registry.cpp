#include "shapes/shape.h"

namespace alhazen {

#define KIND(name) Kind<Shape> name##_shape();
#include "shapes/list.h"
#undef KIND

const KindList<Shape>& shape_kinds() {
    static const KindList<Shape> kinds{
#define KIND(name) name##_shape(),
#include "shapes/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
