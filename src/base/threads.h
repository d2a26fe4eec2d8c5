/// Threads, over oneTBB: how many there are, and loops spread over them.
#pragma once

#include <cstddef>
#include <functional>

namespace alhazen {

/// Threads this machine can run at once.
int hardware_threads();

/// Runs work with at most the given number of threads for every loop inside it (0: all the machine has).
void with_threads(int threads, const std::function<void()>& work);

/// Calls body(i) for 0 <= i < count, in any order, on the threads of the enclosing with_threads. Indices are
/// taken in runs of grain.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

} // namespace alhazen
