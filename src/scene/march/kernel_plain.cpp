/// The kernel that marches rays through a distance field, for any processor.
#include "scene/march/kernel_text.h"

const alhazen::MarchKernel* alhazen::march_kernel_plain() {
    static constexpr MarchKernel kernel{"plain", [] { return true; }, &march};
    return &kernel;
}
