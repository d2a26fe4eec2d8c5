#include "raster/dispatch.h"

#include "base/supported_kernels.h"

namespace alhazen {

std::span<const RasterKernel* const> supported_raster_kernels() {
    static const std::vector<const RasterKernel*> supported =
        supported_among({raster_kernel_avx512(), raster_kernel_avx2(), raster_kernel_plain()});
    return supported;
}

} // namespace alhazen
