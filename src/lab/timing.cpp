#include "lab/timing.h"

#include <algorithm>

#include <fmt/format.h>
#include <time.h>

namespace alhazen {

namespace {

double seconds_by(clockid_t clock, const std::function<void()>& work) {
    timespec start{}, end{};
    clock_gettime(clock, &start);
    work();
    clock_gettime(clock, &end);
    double seconds = static_cast<double>(end.tv_sec - start.tv_sec);
    // Never 0: others divide by it.
    return std::max(seconds + 1e-9 * static_cast<double>(end.tv_nsec - start.tv_nsec), 1e-9);
}

} // namespace

double seconds_of(int threads, const std::function<void()>& work) {
    return seconds_by(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, work);
}

double processor_seconds_of(const std::function<void()>& work) {
    return seconds_by(CLOCK_PROCESS_CPUTIME_ID, work);
}

double median_of(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double spread_of(const std::vector<double>& values) {
    double median = median_of(values);
    if (!(median > 0)) return 0;
    auto [least, most] = std::minmax_element(values.begin(), values.end());
    return (*most - *least) / median;
}

std::string timing_text(double seconds) {
    const auto text = [](double value, const char* unit) {
        return fmt::format("{:.{}f} {}", value, value < 10 ? 2 : value < 100 ? 1 : 0, unit);
    };
    if (seconds < 1e-3) return text(seconds * 1e6, "us");
    return seconds < 1 ? text(seconds * 1e3, "ms") : text(seconds, "s");
}

} // namespace alhazen
