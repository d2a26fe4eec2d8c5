#include "base/processor.h"

namespace alhazen {

#if defined(__x86_64__) || defined(__i386__)

bool processor_has_sse42() {
    return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
}

bool processor_has_avx2() {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
}

bool processor_has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && processor_has_avx2();
}

#else

bool processor_has_sse42() {
    return false;
}
bool processor_has_avx2() {
    return false;
}
bool processor_has_avx512() {
    return false;
}

#endif

} // namespace alhazen
