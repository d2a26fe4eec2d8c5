#include "textures/texture_set.h"

namespace alhazen {

#define KIND(name)                                                                                           \
    Kind<FloatNode> name##_float_texture();                                                                  \
    Kind<SpectrumNode> name##_spectrum_texture();
#include "textures/list.h"
#undef KIND

const KindList<FloatNode>& float_texture_kinds() {
    static const KindList<FloatNode> kinds{
#define KIND(name) name##_float_texture(),
#include "textures/list.h"
#undef KIND
    };
    return kinds;
}

const KindList<SpectrumNode>& spectrum_texture_kinds() {
    static const KindList<SpectrumNode> kinds{
#define KIND(name) name##_spectrum_texture(),
#include "textures/list.h"
#undef KIND
    };
    return kinds;
}

} // namespace alhazen
