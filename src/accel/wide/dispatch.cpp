#include "accel/wide/dispatch.h"

#include <vector>

namespace alhazen {

std::span<const WideKernels* const> supported_wide_kernels() {
    static const std::vector<const WideKernels*> supported = [] {
        std::vector<const WideKernels*> list;
        for (const WideKernels* k :
             {wide_kernels_avx512(), wide_kernels_avx2(), wide_kernels_sse42(), wide_kernels_plain()})
            if (k && k->is_supported()) list.push_back(k);
        return list;
    }();
    return supported;
}

const WideKernels& wide_kernels(std::string_view name) {
    for (const WideKernels* k : supported_wide_kernels())
        if (k->name == name) return *k;
    return *supported_wide_kernels().front();
}

} // namespace alhazen
