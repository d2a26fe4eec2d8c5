#include "base/threads.h"

#include <algorithm>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace alhazen {

int hardware_threads() {
    return tbb::info::default_concurrency();
}

void with_threads(int threads, const std::function<void()>& work) {
    int n = threads > 0 ? threads : hardware_threads();
    // An arena may use more threads than the machine has only where this allows it.
    tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(std::max(n, hardware_threads())));
    tbb::task_arena arena(n);
    arena.execute(work);
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(1, grain)),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
}

} // namespace alhazen
