/// The rasteriser's kernel for x86-64 with AVX2.
#include <cstddef>

#include "raster/kernel.h"

#if defined(__AVX2__)

#include "base/processor.h"
#include "raster/cull_text.h"
#include "raster/kernel_text.h"
#include "raster/points_text.h"
#include "raster/project_text.h"

const alhazen::RasterKernel* alhazen::raster_kernel_avx2() {
    static constexpr RasterKernel kernel{"avx2",          &processor_has_avx2, &draw_batch,  &project_points,
                                         &cull_triangles, &place_points,       &light_points};
    return &kernel;
}

#else

const alhazen::RasterKernel* alhazen::raster_kernel_avx2() {
    return nullptr;
}

#endif
