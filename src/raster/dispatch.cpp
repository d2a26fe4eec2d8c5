#include "raster/dispatch.h"

#include <vector>

namespace alhazen {

std::span<const RasterKernel* const> supported_raster_kernels() {
    static const std::vector<const RasterKernel*> supported = [] {
        std::vector<const RasterKernel*> list;
        for (const RasterKernel* k : {raster_kernel_avx512(), raster_kernel_avx2(), raster_kernel_plain()})
            if (k && k->is_supported()) list.push_back(k);
        return list;
    }();
    return supported;
}

} // namespace alhazen
