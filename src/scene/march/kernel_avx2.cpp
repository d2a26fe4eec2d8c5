/// The kernel that marches rays through a distance field, for x86-64 with AVX2.
#include "scene/march/kernel.h"

#if defined(__AVX2__)

#include "base/processor.h"
#include "scene/march/kernel_text.h"

const alhazen::MarchKernel* alhazen::march_kernel_avx2() {
    static constexpr MarchKernel kernel{"avx2", &processor_has_avx2, &march};
    return &kernel;
}

#else

const alhazen::MarchKernel* alhazen::march_kernel_avx2() {
    return nullptr;
}

#endif
