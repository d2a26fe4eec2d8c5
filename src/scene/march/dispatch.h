/// Which of the marching kernels this processor gets.
#pragma once

#include <span>

#include "scene/march/kernel.h"

namespace alhazen {

/// All that this processor can run, the best first; "plain" is always among them. They give the same bits.
std::span<const MarchKernel* const> supported_march_kernels();

} // namespace alhazen
