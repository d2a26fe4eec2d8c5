#include "cli/interrupt.h"

#include <cstdint>
#include <ctime>

#include <unistd.h>

#include "cli/commands.h"

namespace alhazen {

namespace {

/// Set by the signal handler, which can reach nothing else.
std::atomic<bool> was_interrupted{false};
std::atomic<std::int64_t> first_time{0}; ///< of the first signal, milliseconds; 0: there was none

/// A program that runs others (timeout, say) may send what was one Ctrl-C twice: to its child and to its
/// group.
constexpr std::int64_t same_press = 300; // milliseconds

std::int64_t milliseconds_now() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1000000;
}

extern "C" void on_interrupt(int) {
    const std::int64_t now = milliseconds_now();
    std::int64_t first = 0;
    if (first_time.compare_exchange_strong(first, now))
        was_interrupted = true;
    else if (now - first >= same_press)
        _exit(exit_interrupted);
}

} // namespace

InterruptWatch::InterruptWatch() {
    was_interrupted = false;
    first_time = 0;
    struct sigaction handler {};
    handler.sa_handler = on_interrupt;
    sigaction(SIGINT, &handler, &before_);
}

InterruptWatch::~InterruptWatch() {
    sigaction(SIGINT, &before_, nullptr);
}

const std::atomic<bool>& InterruptWatch::interrupted() const {
    return was_interrupted;
}

} // namespace alhazen
