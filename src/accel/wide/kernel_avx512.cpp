/// The production structure's kernels for x86-64 with AVX-512 (VL, DQ, BW).
#include "accel/wide/kernel.h"

#if defined(__AVX512VL__)

#include "accel/wide/lanes_avx2.h"

#include "accel/wide/kernel_text.h"

const alhazen::WideKernels* alhazen::wide_kernels_avx512() {
    static constexpr WideKernels kernels = make_kernels("avx512", [] {
        return static_cast<bool>(__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
                                 __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("fma"));
    });
    return &kernels;
}

#else

const alhazen::WideKernels* alhazen::wide_kernels_avx512() {
    return nullptr;
}

#endif
