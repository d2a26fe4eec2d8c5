/// Seconds, and what to make of several measurements of the same thing.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace alhazen {

/// How long work takes. On one thread: the processor time of this thread, so that other programs' turns do
/// not count; else, by the wall clock.
double seconds_of(int threads, const std::function<void()>& work);

/// The processor time of all threads of this program: not what other programs' turns take.
double processor_seconds_of(const std::function<void()>& work);

/// The middle of the values, or the mean of the two in the middle; 0 for none.
double median_of(std::vector<double> values);
/// (largest - smallest) / median: how far to trust it; 0 for none.
double spread_of(const std::vector<double>& values);

/// To be read: "1.23 s", "45.6 ms", "7.89 us".
std::string timing_text(double seconds);

} // namespace alhazen
