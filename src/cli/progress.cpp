#include "cli/progress.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "cli/terminal.h"

namespace alhazen {

std::string duration_text(double seconds) {
    if (seconds < 10) return fmt::format("{:.1f} s", seconds);
    auto whole = std::lround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), is_terminal_(stderr_is_terminal()) {}

void ProgressBar::update(const Progress& p) {
    // Ten times a second is enough for the eye, twice a minute for a log.
    double interval = is_terminal_ ? 0.1 : 30;
    bool is_first = last_ < 0;
    if (quiet_ || (!is_first && p.seconds - last_ < interval)) return;
    if (is_first && !is_terminal_) {
        last_ = p.seconds;
        return;
    }
    last_ = p.seconds;
    std::string rate = p.rays_per_second > 0 ? fmt::format(", {:.2f} Mrays/s", p.rays_per_second / 1e6) : "";
    // A guess from the first moments would be wild.
    std::string left = p.seconds > 0.5 ? ", " + duration_text(p.seconds_left) + " left" : "";
    std::string tail = fmt::format(" {:3.0f} %  {}/{} spp{}{}", p.fraction * 100, p.samples_done,
                                   p.samples_total, rate, left);
    if (!is_terminal_) {
        fmt::print(stderr, "rendering:{}\n", tail);
        return;
    }
    int width = std::clamp(terminal_columns() - static_cast<int>(tail.size()) - 1, 0, 40);
    int filled = static_cast<int>(p.fraction * width);
    std::string bar;
    for (int i = 0; i < width; ++i) bar += i < filled ? "█" : "░";
    fmt::print(stderr, "\r{}{}\x1b[K", bar, tail);
    std::fflush(stderr);
    drawn_ = true;
}

void ProgressBar::finish() {
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
}

} // namespace alhazen
