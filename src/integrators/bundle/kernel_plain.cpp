/// The kernel that follows bundles of rays, for any processor.
#include "integrators/bundle/kernel_text.h"

const alhazen::BundleKernel* alhazen::bundle_kernel_plain() {
    static constexpr BundleKernel kernel{"plain", [] { return true; }, &trace_bundle};
    return &kernel;
}
