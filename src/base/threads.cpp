#include "base/threads.h"

#include <algorithm>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#ifdef ALHAZEN_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace alhazen {

namespace {

// Tells the thread sanitizer the order that oneTBB keeps, which it cannot see, as that library (and with it
// the templates of this file, see src/CMakeLists.txt) is not built with it: a piece of work comes after what
// its caller did before, and before what the caller does after. Between pieces it promises nothing, so that
// races there are found.
class Order {
  public:
    Order() { release(before_); }
    ~Order() { acquire(after_); }
    Order(const Order&) = delete;
    Order& operator=(const Order&) = delete;

    /// Held while one piece is worked on.
    class Piece {
      public:
        explicit Piece(Order& order) : order_(order) { acquire(order_.before_); }
        ~Piece() { release(order_.after_); }
        Piece(const Piece&) = delete;
        Piece& operator=(const Piece&) = delete;

      private:
        Order& order_;
    };

  private:
#ifdef ALHAZEN_TSAN
    static void release(char& place) { __tsan_release(&place); }
    static void acquire(char& place) { __tsan_acquire(&place); }
#else
    static void release(char&) {}
    static void acquire(char&) {}
#endif
    char before_ = 0, after_ = 0;
};

template <class Body>
void for_runs(std::size_t count, std::size_t grain, const Body& body) {
    grain = std::max<std::size_t>(1, grain);
    Order order;
    tbb::parallel_for(
        std::size_t{0}, (count + grain - 1) / grain,
        [&](std::size_t run) {
            Order::Piece piece(order);
            body(run * grain, std::min(count, (run + 1) * grain));
        },
        tbb::simple_partitioner());
}

} // namespace

int hardware_threads() {
    return tbb::info::default_concurrency();
}

void with_threads(int threads, const std::function<void()>& work) {
    int n = threads > 0 ? threads : hardware_threads();
    // An arena may use more threads than the machine has only where this allows it.
    tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(std::max(n, hardware_threads())));
    tbb::task_arena arena(n);
    Order order;
    arena.execute([&] {
        Order::Piece piece(order);
        work();
    });
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
    for_runs(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i != end; ++i) body(i);
    });
}

void parallel_ranges(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
    tbb::this_task_arena::isolate([&] { for_runs(count, grain, body); });
}

void parallel_invoke(const std::function<void()>& first, const std::function<void()>& second) {
    Order order;
    auto piece = [&](const std::function<void()>& work) {
        Order::Piece held(order);
        work();
    };
    tbb::parallel_invoke([&] { piece(first); }, [&] { piece(second); });
}

} // namespace alhazen
