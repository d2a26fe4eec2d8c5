/// The kernel that marches rays through a distance field, for x86-64 with AVX-512.
#include "scene/march/kernel.h"

#if defined(__AVX512F__)

#include "base/processor.h"
#include "scene/march/kernel_text.h"

const alhazen::MarchKernel* alhazen::march_kernel_avx512() {
    static constexpr MarchKernel kernel{"avx512", &processor_has_avx512, &march};
    return &kernel;
}

#else

const alhazen::MarchKernel* alhazen::march_kernel_avx512() {
    return nullptr;
}

#endif
