#include "accel/wide/dispatch.h"

#include "base/supported_kernels.h"

namespace alhazen {

std::span<const WideKernels* const> supported_wide_kernels() {
    static const std::vector<const WideKernels*> supported = supported_among(
        {wide_kernels_avx512(), wide_kernels_avx2(), wide_kernels_sse42(), wide_kernels_plain()});
    return supported;
}

const WideKernels& wide_kernels(std::string_view name) {
    for (const WideKernels* k : supported_wide_kernels())
        if (k->name == name) return *k;
    return *supported_wide_kernels().front();
}

} // namespace alhazen
