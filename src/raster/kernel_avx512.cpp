/// The rasteriser's kernel for x86-64 with AVX-512.
#include <cstddef>

#include "raster/kernel.h"

#if defined(__AVX512F__)

#include "base/processor.h"
#include "raster/cull_text.h"
#include "raster/kernel_text.h"
#include "raster/points_text.h"
#include "raster/project_text.h"

const alhazen::RasterKernel* alhazen::raster_kernel_avx512() {
    static constexpr RasterKernel kernel{"avx512",        &processor_has_avx512, &draw_batch,
                                         &project_points, &cull_triangles,       &place_points,
                                         &light_points};
    return &kernel;
}

#else

const alhazen::RasterKernel* alhazen::raster_kernel_avx512() {
    return nullptr;
}

#endif
