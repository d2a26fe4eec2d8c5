#include "integrators/integrator.h"

namespace alhazen {

#define KIND(name) Kind<Integrator> name##_integrator();
#include "integrators/list.h"
#undef KIND

const KindList<Integrator>& integrator_kinds() {
    static const KindList<Integrator> kinds{
#define KIND(name) name##_integrator(),
#include "integrators/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
