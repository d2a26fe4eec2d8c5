/// The production structure's kernels for any processor.
#include "accel/wide/kernel.h"

#include "accel/wide/lanes_plain.h"

#include "accel/wide/kernel_text.h"

const alhazen::WideKernels* alhazen::wide_kernels_plain() {
    static constexpr WideKernels kernels = make_kernels("plain", [] { return true; });
    return &kernels;
}
