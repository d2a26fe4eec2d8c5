/// The kernel that marches rays through a distance field, for x86-64 with AVX2.
#include "scene/march/kernel.h"

#if defined(__AVX2__)

#include "scene/march/kernel_text.h"

const alhazen::MarchKernel* alhazen::march_kernel_avx2() {
    static constexpr MarchKernel kernel{
        "avx2", [] { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }, &march};
    return &kernel;
}

#else

const alhazen::MarchKernel* alhazen::march_kernel_avx2() {
    return nullptr;
}

#endif
