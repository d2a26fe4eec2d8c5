/// Threads, over oneTBB: how many there are, and work spread over them. What was written before a call is
/// seen inside it, and what was written inside it is seen after it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace alhazen {

/// Threads this machine can run at once.
int hardware_threads();

/// Runs work with at most the given number of threads for every loop inside it (0: all the machine has).
void with_threads(int threads, const std::function<void()>& work);

/// Calls body(i) for 0 <= i < count, in any order, on the threads of the enclosing with_threads. Indices are
/// taken in runs of grain.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

/// Calls body(begin, end) for the runs of at most grain indices, starting at multiples of grain, that make up
/// 0 .. count - 1. The caller may hold a lock, unlike around the other functions: a thread that waits here
/// for the others takes up no other work meanwhile.
void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Calls both, on two threads if one is free.
void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second);

/// The sum over 0 <= i < count: add(sum, begin, end) adds a run of at most grain indices to a copy of zero,
/// and join(sum, part) adds up the parts from first to last; so the result does not depend on the threads.
template <class Sum, class Add, class Join>
Sum parallel_sum(std::size_t count, std::size_t grain, const Sum& zero, const Add& add, const Join& join) {
    std::vector<Sum> parts((count + grain - 1) / grain, zero);
    parallel_ranges(count, grain,
                    [&](std::size_t begin, std::size_t end) { add(parts[begin / grain], begin, end); });
    Sum sum = zero;
    for (const Sum& part : parts) join(sum, part);
    return sum;
}

} // namespace alhazen
