/// What instructions this processor has. Declarations only, so that kernels may include it: see
/// accel/wide/kernel.h.
#pragma once

namespace alhazen {

/// SSE4.2 and popcnt.
bool processor_has_sse42();
/// AVX2 and what kernels for it are compiled with besides: FMA, BMI, BMI2, popcnt.
bool processor_has_avx2();
/// AVX-512 F, VL, DQ, BW, and all of AVX2's.
bool processor_has_avx512();

} // namespace alhazen
