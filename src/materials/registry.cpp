#include "materials/material.h"

namespace alhazen {

#define KIND(name) Kind<Material> name##_material();
#include "materials/list.h"
#undef KIND

const KindList<Material>& material_kinds() {
    static const KindList<Material> kinds{
#define KIND(name) name##_material(),
#include "materials/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
