/// A whole scene as one global distance field, as game engines keep one for indirect light (Wright et al.
/// 2022, "Lumen"): cheap to ask, coarse, and approximate. Details smaller than a cell are lost, and contacts
/// are blurred by about a cell: nothing is met within half a cell from where a ray starts, and before where
/// it is to end.
#pragma once

#include <optional>
#include <span>

#include "scene/distance_field.h"
#include "scene/object.h"

namespace alhazen {

class DistanceScene {
  public:
    /// cells along the longest side of the scene. Throws std::runtime_error when there are shapes that are no
    /// triangles. Borders between media are left out. The root must outlive this.
    DistanceScene(const Object& root, int cells);

    /// The nearest surface at 0 < t < ray.tmax, as a hit on the triangle that is nearest there.
    std::optional<Hit> closest(const Ray& ray) const;
    /// True when nothing is seen before ray.tmax.
    bool visible(const Ray& ray) const;
    /// The same for many rays at once, and with the same bits; found[i].object is nullptr where nothing is
    /// met, blocked is 0 or 1.
    void closest(std::span<const Ray> rays, std::span<Found> found) const;
    void blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;
    /// Which kernel marches: one of supported_march_kernels(), the best unless told otherwise.
    void set_kernel(const MarchKernel& kernel) { kernel_ = &kernel; }

    std::size_t bytes() const {
        return (field_ ? field_->bytes() : 0) + corners_.size() * (sizeof(Corners) + sizeof(Origin));
    }

  private:
    /// Where a triangle of the field is in the scene.
    struct Origin {
        std::uint32_t placed; ///< into placed_
        std::uint32_t primitive;
    };

    struct Collector;
    /// Calls take(number of the first, each one's t, each one's sample of the field) for some rays after the
    /// others; t is infinity where nothing is met.
    template <class Take>
    void march(std::span<const Ray> rays, const Take& take) const;
    // Leaves found as it is where the ray would not get further.
    void find(const Ray& ray, float t, std::uint32_t triangle, Found& found) const;

    std::vector<Found> placed_; ///< object and way to it, once an object that is placed
    std::vector<Origin> origins_;
    std::vector<Corners> corners_;
    std::optional<DistanceField> field_; ///< none for an empty scene
    const MarchKernel* kernel_;
};

} // namespace alhazen
