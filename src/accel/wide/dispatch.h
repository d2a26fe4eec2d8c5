/// Which of the kernels this processor gets.
#pragma once

#include <span>
#include <string_view>

#include "accel/wide/kernel.h"

namespace alhazen {

/// All that this processor can run, the best first; "plain" is always among them.
std::span<const WideKernels* const> supported_wide_kernels();

/// The kernels of that name, or the best when the name is empty or not supported here.
const WideKernels& wide_kernels(std::string_view name = {});

} // namespace alhazen
