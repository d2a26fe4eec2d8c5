/// The production structure's kernels for x86-64 with SSE 4.2.
#include "accel/wide/kernel.h"

#if defined(__SSE4_2__)

#include "accel/wide/lanes_sse42.h"
#include "base/processor.h"

#include "accel/wide/kernel_text.h"

const alhazen::WideKernels* alhazen::wide_kernels_sse42() {
    static constexpr WideKernels kernels = make_kernels("sse42", &alhazen::processor_has_sse42);
    return &kernels;
}

#else

const alhazen::WideKernels* alhazen::wide_kernels_sse42() {
    return nullptr;
}

#endif
