/// The rasteriser's kernel for any processor.
#include <cstddef>

#include "raster/kernel.h"

#include "raster/cull_text.h"
#include "raster/kernel_text.h"
#include "raster/points_text.h"
#include "raster/project_text.h"

const alhazen::RasterKernel* alhazen::raster_kernel_plain() {
    static constexpr RasterKernel kernel{"plain",         [] { return true; }, &draw_batch,  &project_points,
                                         &cull_triangles, &place_points,       &light_points};
    return &kernel;
}
