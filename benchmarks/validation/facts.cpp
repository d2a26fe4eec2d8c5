#include "benchmarks/validation/facts.h"

#include <cmath>
#include <vector>

namespace alhazen::bench {

std::span<const SceneFacts> validation_scenes() {
    static const std::vector<SceneFacts> scenes{
        {"cornell-box", {16, 7, 0.014}, {64, 25, 0.004}},
        {"menger", {16, 5, 0.021}, {64, 14, 0.0061}},
        {"teapot-cloud", {16, 14, 0.030}, {64, 57, 0.0096}},
        {"veach-bidir", {16, 21, 0.019}, {64, 88, 0.008}},
        {"coffee", {16, 6, 0.077}, {64, 18, 0.019}},
        {"material-testball", {16, 5, 0.041}, {64, 18, 0.015}},
        {"staircase", {16, 9, 0.074}, {64, 32, 0.026}, 0.02},
        {"living-room-2", {16, 10, 0.35}, {64, 36, 0.1}, 0.006},
        {"kitchen", {16, 11, 0.46}, {64, 40, 0.14}},
        {"veach-ajar", {16, 5, 4.6}, {64, 20, 1.6}},
    };
    return scenes;
}

std::string_view verdict_on(const SceneFacts& facts, bool agrees, const std::array<double, 3>& mean_ratio,
                            double mean_z2) {
    if (agrees) return "agrees";
    bool is_known = facts.known_difference > 0 && mean_z2 < largest_known_z2;
    for (double ratio : mean_ratio) is_known = is_known && std::abs(ratio - 1) <= facts.known_difference;
    return is_known ? "differs by design" : differs;
}

} // namespace alhazen::bench
