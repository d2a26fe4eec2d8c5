#include "film/splats.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

template <class Eval>
Splats::Curve::Curve(float radius, Eval eval) : radius_(radius) {
    constexpr int count = 256;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        steps_.push_back(eval(radius * ((static_cast<float>(i) + 0.5f) / (0.5f * count) - 1)));
        sum += static_cast<double>(steps_.back());
    }
    const auto scale = static_cast<float>(count / (2 * static_cast<double>(radius) * sum));
    for (float& step : steps_) step *= scale;
}

float Splats::Curve::operator()(float offset) const {
    const auto count = static_cast<float>(steps_.size());
    const float step = (offset / radius_ + 1) * (0.5f * count);
    return step >= 0 && step < count ? steps_[static_cast<std::size_t>(step)] : 0;
}

// All filters are products of a curve across and one down.
Splats::Splats(Rect2i pixels, const Filter& filter)
    : pixels_(pixels), across_(filter.radius().x,
                               [&](float x) {
                                   return filter.eval({x, 0});
                               }),
      down_(filter.radius().y,
            [&](float y) {
                return filter.eval({0, y});
            }),
      lo_(Vec2(pixels.lo) + Vec2(0.5f, 0.5f) - filter.radius()),
      hi_(Vec2(pixels.hi) - Vec2(0.5f, 0.5f) + filter.radius()),
      sums_(3 * static_cast<std::size_t>(pixels.width()) * static_cast<std::size_t>(pixels.height())) {}

Splats::Footprint Splats::footprint(float place, const Curve& curve, int lo, int hi) {
    Footprint f;
    f.first = std::max(lo, static_cast<int>(std::ceil(place - curve.radius() - 0.5f)));
    const int last = std::min(hi - 1, static_cast<int>(std::floor(place + curve.radius() - 0.5f)));
    f.count = std::clamp(last - f.first + 1, 0, Footprint::most);
    for (int i = 0; i < f.count; ++i) f.weights[i] = curve(place - (static_cast<float>(f.first + i) + 0.5f));
    return f;
}

void Splats::add(Vec2 position, Vec3 color) {
    if (!reaches(position)) return;
    const Footprint across = footprint(position.x, across_, pixels_.lo.x, pixels_.hi.x);
    const Footprint down = footprint(position.y, down_, pixels_.lo.y, pixels_.hi.y);
    for (int y = 0; y < down.count; ++y) {
        const auto row = static_cast<std::size_t>(down.first + y - pixels_.lo.y) *
                         static_cast<std::size_t>(pixels_.width());
        for (int x = 0; x < across.count; ++x) {
            const double weight =
                static_cast<double>(down.weights[y]) * static_cast<double>(across.weights[x]);
            if (weight == 0) continue;
            const std::size_t pixel = row + static_cast<std::size_t>(across.first + x - pixels_.lo.x);
            for (int c = 0; c < 3; ++c)
                sums_.add(3 * pixel + static_cast<std::size_t>(c), static_cast<double>(color[c]) * weight);
        }
    }
}

} // namespace alhazen
