/// What is told of an integration beside its picture.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"

namespace alhazen {

/// How far estimates were off the integral.
struct QuadratureError {
    int samples = 0; ///< of each estimate
    double mean_squared_error = 0;
};

struct Quadrature {
    std::vector<QuadratureError> errors;     ///< for growing numbers of samples
    Image integrand;                         ///< empty where nobody asked for it
    std::string errors_file, integrand_file; ///< where both are to go; "" for nowhere
};

} // namespace alhazen
