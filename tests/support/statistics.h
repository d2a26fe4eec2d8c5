/// Tests whether samples agree with a number, or with other samples.
#pragma once

#include <cmath>
#include <vector>

namespace alhazen::testing {

/// Of two lists of so many means, from seeds of their own, |t| exceeds the limit with a chance of about 4e-6.
inline constexpr int t_test_seeds = 16;
inline constexpr double t_test_limit = 7;

struct Moments {
    double mean = 0;
    double variance_of_mean = 0;
};

inline Moments moments(const std::vector<double>& samples) {
    Moments m;
    auto n = static_cast<double>(samples.size());
    for (double s : samples) m.mean += s / n;
    double sum = 0;
    for (double s : samples) sum += (s - m.mean) * (s - m.mean);
    m.variance_of_mean = sum / (n - 1) / n;
    return m;
}

/// Student's t of the samples' mean against an exact value. floor is added to the standard error: the
/// relative rounding error of float arithmetic, for estimators without variance.
inline double t_against(const std::vector<double>& samples, double exact, double floor = 1e-5) {
    Moments m = moments(samples);
    return (m.mean - exact) / (std::sqrt(m.variance_of_mean) + floor * std::abs(exact));
}

/// Welch's t between two sets of independent samples.
inline double t_between(const std::vector<double>& a, const std::vector<double>& b, double floor = 1e-5) {
    Moments ma = moments(a), mb = moments(b);
    return (ma.mean - mb.mean) /
           (std::sqrt(ma.variance_of_mean + mb.variance_of_mean) + floor * std::abs(mb.mean));
}

} // namespace alhazen::testing
