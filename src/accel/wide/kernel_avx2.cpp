/// The production structure's kernels for x86-64 with AVX2 and FMA.
#include "accel/wide/kernel.h"

#if defined(__AVX2__) && defined(__FMA__)

#include "accel/wide/lanes_avx2.h"
#include "base/processor.h"

#include "accel/wide/kernel_text.h"

const alhazen::WideKernels* alhazen::wide_kernels_avx2() {
    static constexpr WideKernels kernels = make_kernels("avx2", &alhazen::processor_has_avx2);
    return &kernels;
}

#else

const alhazen::WideKernels* alhazen::wide_kernels_avx2() {
    return nullptr;
}

#endif
