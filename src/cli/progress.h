/// How far a render is: a bar with rate and time left on a terminal, a plain line now and then elsewhere.
#pragma once

#include "render/renderer.h"

namespace alhazen {

class ProgressBar {
  public:
    /// Writes to standard error; nothing at all when quiet.
    explicit ProgressBar(bool quiet);
    void update(const Progress& progress);
    /// Takes the bar away.
    void finish();

  private:
    bool quiet_, is_terminal_;
    bool drawn_ = false;
    double last_ = -1; ///< seconds at the last update
};

/// "3.2 s", "4 min 10 s", "2 h 5 min".
std::string duration_text(double seconds);

} // namespace alhazen
