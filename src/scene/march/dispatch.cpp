#include "scene/march/dispatch.h"

#include "base/supported_kernels.h"

namespace alhazen {

std::span<const MarchKernel* const> supported_march_kernels() {
    static const std::vector<const MarchKernel*> supported =
        supported_among({march_kernel_avx512(), march_kernel_avx2(), march_kernel_plain()});
    return supported;
}

} // namespace alhazen
