/// Chi-square tests: do counts come from the distribution that is claimed? The false-alarm rate of a whole
/// family of tests is kept by Sidak's correction.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace alhazen::testing_support {

/// Upper regularised incomplete gamma function Q(a, x), a > 0, x >= 0: by its series where that converges
/// fast, else by its continued fraction (Abramowitz and Stegun 1964, 6.5.29 and 6.5.31; Lentz's method).
inline double gamma_q(double a, double x) {
    if (x <= 0) return 1;
    double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return std::max(0.0, 1 - front * sum);
    }
    constexpr double tiny = 1e-300;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        double an = -n * (n - a);
        b += 2;
        d = an * d + b;
        c = b + an / c;
        d = 1 / (std::abs(d) < tiny ? tiny : d);
        c = std::abs(c) < tiny ? tiny : c;
        double step = d * c;
        h *= step;
        if (std::abs(step - 1) < 1e-15) break;
    }
    return front * h;
}

/// Probability of a chi-square statistic at least this large with the given degrees of freedom.
inline double chi_square_p_value(double statistic, int degrees) {
    return degrees > 0 ? gamma_q(0.5 * degrees, 0.5 * statistic) : 1;
}

/// Level of each of `tests` independent tests such that all together raise a false alarm with probability
/// family_level.
inline double sidak_level(double family_level, int tests) {
    return -std::expm1(std::log1p(-family_level) / tests);
}

struct ChiSquareResult {
    double statistic = 0;
    int degrees = 0;
    double p_value = 1;
};

/// Observed against expected counts, cell by cell. Cells that expect fewer than min_expected are pooled. Give
/// what is in no cell as a cell of its own, so that the sums agree.
inline ChiSquareResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                       double min_expected = 5) {
    std::vector<std::size_t> order(observed.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    ChiSquareResult result;
    int cells = 0;
    double pooled_observed = 0, pooled_expected = 0;
    auto close_pool = [&] {
        // Nothing is expected: a single count refutes it.
        if (pooled_expected <= 0)
            result.statistic += pooled_observed > 0 ? std::numeric_limits<double>::infinity() : 0;
        else {
            double difference = pooled_observed - pooled_expected;
            result.statistic += difference * difference / pooled_expected;
            ++cells;
        }
        pooled_observed = pooled_expected = 0;
    };
    for (std::size_t i : order) {
        pooled_observed += observed[i];
        pooled_expected += expected[i];
        if (pooled_expected >= min_expected) close_pool();
    }
    if (pooled_observed > 0 || pooled_expected > 0) close_pool();
    result.degrees = std::max(1, cells - 1);
    result.p_value =
        std::isfinite(result.statistic) ? chi_square_p_value(result.statistic, result.degrees) : 0;
    return result;
}

} // namespace alhazen::testing_support
