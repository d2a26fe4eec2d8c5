/// Light that comes to the film from elsewhere than its pixels' own samples: paths from the lights land where
/// they will, from all threads, and are spread over the pixels around by the filter (Pharr et al. 2023,
/// section 5.4.6).
#pragma once

#include "base/bounds.h"
#include "base/exact_sums.h"
#include "film/filter.h"

namespace alhazen {

class Splats {
  public:
    Splats(Rect2i pixels, const Filter& filter);

    /// Whether anything that lands there touches a pixel; position as in CameraSample::film.
    bool reaches(Vec2 position) const {
        return position.x > lo_.x && position.y > lo_.y && position.x < hi_.x && position.y < hi_.y;
    }
    /// May be called by several threads at a time: the sums do not depend on the order.
    void add(Vec2 position, Vec3 color);
    /// What has landed at a pixel, numbered by rows.
    Vec3d sum(std::size_t pixel) const {
        return {sums_.sum(3 * pixel), sums_.sum(3 * pixel + 1), sums_.sum(3 * pixel + 2)};
    }

  private:
    /// The filter along one axis, as steps fine enough to pass for it, with mean 1 over a pixel's width.
    class Curve {
      public:
        Curve() = default;
        template <class Eval>
        Curve(float radius, Eval eval);
        float radius() const { return radius_; }
        float operator()(float offset) const;

      private:
        std::vector<float> steps_;
        float radius_ = 0;
    };
    /// The pixels from first on that a place touches along an axis, and how much.
    struct Footprint {
        static constexpr int most = 129;
        int first = 0, count = 0;
        float weights[most];
    };
    static Footprint footprint(float place, const Curve& curve, int lo, int hi);

    Rect2i pixels_;
    Curve across_, down_;
    Vec2 lo_, hi_;
    ExactSums sums_; ///< three a pixel
};

} // namespace alhazen
