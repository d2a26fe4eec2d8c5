/// The memory that the texels of a scene take.
#pragma once

#include <cstddef>
#include <cstdint>

namespace alhazen {

struct TextureMemory {
    std::size_t limit_bytes = 0; ///< 0: none
    std::size_t peak_bytes = 0;  ///< the most that was in memory; without a limit what is there now
    std::uint64_t tiles_made = 0, tiles_dropped = 0;
    std::uint64_t file_bytes = 0; ///< in the temporary folder
};

} // namespace alhazen
