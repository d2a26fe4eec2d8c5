/// A grid file for tests of media: a ball of smoke, warm in the middle.
#pragma once

#include "describe/grid_file.h"

namespace alhazen::testing_support {

/// Grids "density" and "temperature" of 16 x 16 x 16 samples over the cube from -1 to 1.
inline GridData smoke(const std::filesystem::path& file, const std::string& grid) {
    if (file.extension() != ".nvdb") throw std::runtime_error("not a grid file");
    if (grid != "density" && grid != "temperature") throw NoSuchGrid("no grid of floats is named so");
    GridData data;
    data.is_level_set = false;
    data.background = 0;
    data.lo = {0, 0, 0};
    data.hi = {15, 15, 15};
    data.object_from_index = Matrix4::translate({-1, -1, -1}) * Matrix4::scale(Vec3d(2.0 / 15));
    for (int bz = 0; bz < 16; bz += 8)
        for (int by = 0; by < 16; by += 8)
            for (int bx = 0; bx < 16; bx += 8) {
                GridBrick& b = data.bricks.emplace_back();
                b.origin = {bx, by, bz};
                for (int z = 0; z < 8; ++z)
                    for (int y = 0; y < 8; ++y)
                        for (int x = 0; x < 8; ++x) {
                            const Vec3 p = Vec3(static_cast<float>(bx + x), static_cast<float>(by + y),
                                                static_cast<float>(bz + z)) *
                                               (2.0f / 15) -
                                           Vec3(1);
                            const float d = std::max(0.0f, 1 - length(p));
                            b.values[GridBrick::at(x, y, z)] = grid == "density" ? 3 * d : 400 * d;
                        }
            }
    return data;
}

} // namespace alhazen::testing_support
