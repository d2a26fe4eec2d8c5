/// The production structure's kernels for x86-64 with AVX-512 (VL, DQ, BW).
#include "accel/wide/kernel.h"

#if defined(__AVX512VL__)

#include "accel/wide/lanes_avx2.h"
#include "base/processor.h"

#include "accel/wide/kernel_text.h"

const alhazen::WideKernels* alhazen::wide_kernels_avx512() {
    static constexpr WideKernels kernels = make_kernels("avx512", &alhazen::processor_has_avx512);
    return &kernels;
}

#else

const alhazen::WideKernels* alhazen::wide_kernels_avx512() {
    return nullptr;
}

#endif
