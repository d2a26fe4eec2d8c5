/// The subcommands. Each adds itself to the program's argument parser; what it does when chosen is left in
/// action, whose result is the exit code.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace alhazen {

/// Exit codes of the program.
inline constexpr int exit_ok = 0;
inline constexpr int exit_over_limit = 1;    ///< diff: above --max
inline constexpr int exit_bad_input = 2;     ///< a file, scene or argument is wrong
inline constexpr int exit_interrupted = 130; ///< stopped by Ctrl-C; what was rendered is written

using Action = std::function<int()>;

void add_render_command(CLI::App& app, Action& action);
void add_info_command(CLI::App& app, Action& action);
void add_accel_command(CLI::App& app, Action& action);
void add_convert_command(CLI::App& app, Action& action);
void add_diff_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_sdf_command(CLI::App& app, Action& action);
void add_help_command(CLI::App& app, Action& action);

} // namespace alhazen
