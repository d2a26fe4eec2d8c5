/// Which of the coverage kernels this processor gets.
#pragma once

#include <span>

#include "raster/kernel.h"

namespace alhazen {

/// All that this processor can run, the best first; "plain" is always among them. They draw the same bits.
std::span<const RasterKernel* const> supported_raster_kernels();

} // namespace alhazen
