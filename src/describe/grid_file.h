/// Grids of numbers that scenes keep in files of their own: what such a file holds, and how shapes ask for
/// one without knowing any file format.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/transform.h"
#include "base/vec.h"

namespace alhazen {

/// A cube of 8 x 8 x 8 samples.
struct GridBrick {
    static constexpr int size = 8;
    static constexpr std::size_t samples = 512;
    Vec3i origin;                        ///< index of the first sample; a multiple of 8 on each axis
    std::array<float, samples> values{}; ///< x runs fastest, then y
    static constexpr std::size_t at(int x, int y, int z) {
        return static_cast<std::size_t>(x + size * (y + size * z));
    }
};

/// Samples at points of a regular grid: of a signed distance field, where the value is not known but far from
/// 0 where no brick is; or of anything else (a density), which is 0 there.
struct GridData {
    Vec3i lo, hi;              ///< indices of the first and last samples on each axis
    Matrix4 object_from_index; ///< where the sample with an index stands
    float background = 1;      ///< magnitude of what is not stored
    bool is_level_set = true;  ///< the file does not say that it is something else
    std::vector<GridBrick> bricks;
};

/// Index of the brick that holds a sample, times 8.
inline int brick_origin(int index) {
    return index & ~(GridBrick::size - 1);
}

/// Thrown when a file has no grid of the wanted name.
struct NoSuchGrid : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads a grid file, and of a file with several grids the one of that name ("": the first of numbers).
/// Throws std::runtime_error saying what is wrong, without the file's name.
using GridReader = std::function<GridData(const std::filesystem::path&, const std::string& grid)>;

} // namespace alhazen
