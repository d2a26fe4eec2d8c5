#include "samplers/sampler.h"

namespace alhazen {

#define KIND(name) Kind<Sampler> name##_sampler();
#include "samplers/list.h"
#undef KIND

const KindList<Sampler>& sampler_kinds() {
    static const KindList<Sampler> kinds{
#define KIND(name) name##_sampler(),
#include "samplers/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
