#include "cli/show.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "cli/terminal.h"
#include "image/terminal.h"

namespace alhazen {

namespace {

bool has_desktop() {
    auto is_set = [](const char* name) {
        const char* value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): nobody sets any
        return value && *value;
    };
    return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

/// Runs xdg-open; false when there is none or it fails.
bool open_in_viewer(const std::filesystem::path& file) {
    pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) {
        int null = open("/dev/null", O_WRONLY);
        if (null >= 0) {
            dup2(null, STDOUT_FILENO);
            dup2(null, STDERR_FILENO);
        }
        execlp("xdg-open", "xdg-open", file.c_str(), nullptr);
        _exit(127);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

void show_picture(const Image& image, const std::filesystem::path& file) {
    if (!file.empty() && has_desktop() && open_in_viewer(file)) return;
    if (!stdout_is_terminal()) return;
    TerminalSize size;
    size.columns = std::min(terminal_columns(), 100);
    if (auto cell = terminal_cell_size()) size.cell = *cell;
    std::string text = terminal_has_kitty_graphics() ? draw_kitty(image, size)
                       : terminal_has_sixel()        ? draw_sixel(image, size)
                                                     : draw_half_blocks(image, size);
    fmt::print("{}\n", text);
    std::fflush(stdout);
}

} // namespace alhazen
