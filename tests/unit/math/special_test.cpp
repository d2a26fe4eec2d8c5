/// Special functions against tabulated values.
#include <gtest/gtest.h>

#include "math/special.h"

namespace alhazen {

namespace {

// exp(-x) I0(x) to 12 digits, by mpmath; the two forms meet at 12.
TEST(Special, BesselI0) {
    struct {
        float x;
        double value;
    } table[] = {{0, 1},
                 {0.1f, 0.907100925782},
                 {1, 0.465759607594},
                 {5, 0.183540812609},
                 {11.9f, 0.116925611951},
                 {12.1f, 0.115933182337},
                 {20, 0.0897803118848},
                 {100, 0.0399443792991},
                 {1000, 0.0126172404559}};
    for (auto [x, value] : table)
        EXPECT_NEAR(static_cast<double>(bessel_i0_scaled(x)), value, 2e-6 * value) << x;
}

} // namespace

} // namespace alhazen
