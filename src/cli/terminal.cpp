#include "cli/terminal.h"

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace alhazen {

namespace {

std::string_view environment(const char* name) {
    const char* value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): nobody sets any
    return value ? value : "";
}

/// Sends a query to the terminal and returns what it answers up to the character `last`.
std::string ask_terminal(std::string_view query, char last) {
    termios before{};
    if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before) != 0) return "";
    termios raw = before;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    std::string answer;
    if (write(STDOUT_FILENO, query.data(), query.size()) == static_cast<ssize_t>(query.size())) {
        pollfd waiting{STDIN_FILENO, POLLIN, 0};
        char c = 0;
        while (answer.size() < 64 && poll(&waiting, 1, 200) > 0 && read(STDIN_FILENO, &c, 1) == 1) {
            answer += c;
            if (c == last) break;
        }
    }
    tcsetattr(STDIN_FILENO, TCSANOW, &before);
    return answer;
}

} // namespace

bool stdout_is_terminal() {
    return isatty(STDOUT_FILENO) != 0;
}
bool stderr_is_terminal() {
    return isatty(STDERR_FILENO) != 0;
}

int terminal_columns() {
    winsize size{};
    for (int fd : {STDERR_FILENO, STDOUT_FILENO})
        if (ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

std::optional<Vec2i> terminal_cell_size() {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_xpixel == 0 || size.ws_col == 0 ||
        size.ws_row == 0)
        return std::nullopt;
    return Vec2i{size.ws_xpixel / size.ws_col, size.ws_ypixel / size.ws_row};
}

bool terminal_has_sixel() {
    // Primary device attributes: "ESC [ ? 62 ; 4 ; 22 c"; 4 means sixel graphics.
    std::string answer = ask_terminal("\x1b[c", 'c');
    for (std::size_t i = 0; i < answer.size(); ++i)
        if (answer[i] == ';' && i + 2 < answer.size() && answer[i + 1] == '4' &&
            (answer[i + 2] == ';' || answer[i + 2] == 'c'))
            return true;
    return false;
}

bool terminal_has_kitty_graphics() {
    std::string_view program = environment("TERM_PROGRAM");
    return environment("TERM") == "xterm-kitty" || !environment("KITTY_WINDOW_ID").empty() ||
           program == "ghostty" || program == "WezTerm";
}

} // namespace alhazen
