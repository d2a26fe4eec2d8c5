/// What is at the other end of standard output and standard error.
#pragma once

#include <optional>

#include "base/vec.h"

namespace alhazen {

bool stdout_is_terminal();
bool stderr_is_terminal();
/// Width in characters; 80 when not known.
int terminal_columns();
/// Size of a character cell in pixels, when the terminal says.
std::optional<Vec2i> terminal_cell_size();
/// Whether the terminal draws sixels: it is asked, and given a fifth of a second to answer.
bool terminal_has_sixel();
/// Whether the terminal is one that speaks the kitty graphics protocol.
bool terminal_has_kitty_graphics();

} // namespace alhazen
