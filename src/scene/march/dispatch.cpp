#include "scene/march/dispatch.h"

#include <vector>

namespace alhazen {

std::span<const MarchKernel* const> supported_march_kernels() {
    static const std::vector<const MarchKernel*> supported = [] {
        std::vector<const MarchKernel*> list;
        for (const MarchKernel* k : {march_kernel_avx512(), march_kernel_avx2(), march_kernel_plain()})
            if (k && k->is_supported()) list.push_back(k);
        return list;
    }();
    return supported;
}

} // namespace alhazen
