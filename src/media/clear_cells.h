/// Where in a medium there is nothing but the medium.
#pragma once

#include <vector>

#include "media/medium.h"

namespace alhazen {

/// The cells of a medium's majorants that no surface reaches. What happens to light before it leaves them is
/// the medium's doing alone, and takes no ray through the scene.
class ClearCells {
  public:
    /// All cells are clear; of a medium that has no cells, none is. The medium must outlive this.
    explicit ClearCells(const Medium& medium);

    /// Something is in the box, which is in the world.
    void add_surface(const Bounds3& box);

    const Medium& medium() const { return medium_; }
    bool contains(Vec3i cell) const { return clear_[index(cell)] != 0; }

  private:
    std::size_t index(Vec3i cell) const {
        const Vec3i n = medium_.majorants().cells();
        return static_cast<std::size_t>(cell.x + n.x * (cell.y + n.y * cell.z));
    }

    const Medium& medium_;
    std::vector<std::uint8_t> clear_;
};

} // namespace alhazen
