#include "cli/interrupt.h"

#include <unistd.h>

#include "cli/commands.h"

namespace alhazen {

namespace {

/// Set by the signal handler, which can reach nothing else.
std::atomic<bool> was_interrupted{false};

extern "C" void on_interrupt(int) {
    if (was_interrupted.exchange(true)) _exit(exit_interrupted);
}

} // namespace

InterruptWatch::InterruptWatch() {
    was_interrupted = false;
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
