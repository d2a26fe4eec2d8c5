/// Building nodes on several threads, with messages as if it were done in turn.
#pragma once

#include <functional>

#include "describe/context.h"

namespace alhazen {

/// The context with other messages.
BuildContext with_messages(const BuildContext& context, Messages& messages);

/// Calls build(i, context) for 0 <= i < count on the threads of the enclosing with_threads, each time with a
/// context of its own. What it adds to the messages comes in the order of i; what it throws comes out, the
/// first by i.
void build_apart(std::size_t count, BuildContext& context,
                 const std::function<void(std::size_t, BuildContext&)>& build);

} // namespace alhazen
