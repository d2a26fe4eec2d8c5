/// Which lights there are: the lists are expanded once to declare each kind's function and once to call it.
#include "lights/area_light.h"
#include "lights/light.h"

namespace alhazen {

#define KIND(name) Kind<Light> name##_light();
#include "lights/list.h"
#undef KIND
#define KIND(name) Kind<AreaLight> name##_area_light();
#include "lights/area_list.h"
#undef KIND

const KindList<Light>& light_kinds() {
    static const KindList<Light> kinds{
#define KIND(name) name##_light(),
#include "lights/list.h"
#undef KIND
    };
    return kinds;
}

const KindList<AreaLight>& area_light_kinds() {
    static const KindList<AreaLight> kinds{
#define KIND(name) name##_area_light(),
#include "lights/area_list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
