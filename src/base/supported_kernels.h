/// For kernels that are one text compiled for several instruction sets: those that this processor can run.
#pragma once

#include <initializer_list>
#include <vector>

namespace alhazen {

/// In their order; nullptr stands for those that the compiler was not told to make.
template <class Kernel>
std::vector<const Kernel*> supported_among(std::initializer_list<const Kernel*> kernels) {
    std::vector<const Kernel*> supported;
    for (const Kernel* k : kernels)
        if (k && k->is_supported()) supported.push_back(k);
    return supported;
}

} // namespace alhazen
