/// The kernel that follows bundles of rays, for x86-64 with AVX-512.
#include "integrators/bundle/kernel.h"

#if defined(__AVX512F__)

#include "base/processor.h"
#include "integrators/bundle/kernel_text.h"

const alhazen::BundleKernel* alhazen::bundle_kernel_avx512() {
    static constexpr BundleKernel kernel{"avx512", &processor_has_avx512, &trace_bundle};
    return &kernel;
}

#else

const alhazen::BundleKernel* alhazen::bundle_kernel_avx512() {
    return nullptr;
}

#endif
