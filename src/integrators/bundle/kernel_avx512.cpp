/// The kernel that follows bundles of rays, for x86-64 with AVX-512.
#include "integrators/bundle/kernel.h"

#if defined(__AVX512F__)

#include "integrators/bundle/kernel_text.h"

const alhazen::BundleKernel* alhazen::bundle_kernel_avx512() {
    static constexpr BundleKernel kernel{"avx512",
                                         [] {
                                             return __builtin_cpu_supports("avx512f") &&
                                                    __builtin_cpu_supports("avx512vl") &&
                                                    __builtin_cpu_supports("avx512dq") &&
                                                    __builtin_cpu_supports("avx512bw") &&
                                                    __builtin_cpu_supports("fma");
                                         },
                                         &trace_bundle};
    return &kernel;
}

#else

const alhazen::BundleKernel* alhazen::bundle_kernel_avx512() {
    return nullptr;
}

#endif
