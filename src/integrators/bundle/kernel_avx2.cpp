/// The kernel that follows bundles of rays, for x86-64 with AVX2.
#include "integrators/bundle/kernel.h"

#if defined(__AVX2__)

#include "base/processor.h"
#include "integrators/bundle/kernel_text.h"

const alhazen::BundleKernel* alhazen::bundle_kernel_avx2() {
    static constexpr BundleKernel kernel{"avx2", &processor_has_avx2, &trace_bundle};
    return &kernel;
}

#else

const alhazen::BundleKernel* alhazen::bundle_kernel_avx2() {
    return nullptr;
}

#endif
