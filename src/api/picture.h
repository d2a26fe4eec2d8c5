/// What a public Picture holds.
#pragma once

#include "image/codec.h"
#include <alhazen/alhazen.h>

namespace alhazen {

struct Picture::Content {
    Image image; ///< linear R G B
    WriteOptions write_options;
    int samples = 0;
    double seconds = 0;
    std::uint64_t rays = 0;
    bool was_stopped = false;
    std::vector<Notice> warnings;
};

} // namespace alhazen
