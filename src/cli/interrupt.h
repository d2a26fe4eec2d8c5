/// Ctrl-C, for work that can stop in good order.
#pragma once

#include <atomic>
#include <csignal>

namespace alhazen {

/// As long as there is one, the first Ctrl-C is noted, and only the second ends the program.
class InterruptWatch {
  public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    const std::atomic<bool>& interrupted() const;

  private:
    struct sigaction before_ {};
};

} // namespace alhazen
