#include "media/collisions.h"

namespace alhazen {

std::optional<Collision> Collisions::next() {
    if (!left_) {
        const float u = first_u_ ? *first_u_ : rng_.uniform();
        first_u_.reset();
        const float sigma = sigma_t_[hero_];
        left_ = sigma > 0 ? -std::log(1 - u) / sigma : infinity;
        depth_ = 0;
    }
    float& left = *left_;
    for (;;) {
        if (segment_.density > 0) {
            const float density = segment_.density * length_of_d_;
            const float passed = (segment_.end - t_) * density;
            if (passed > left) {
                t_ += left / density;
                depth_ += left;
                left_.reset();
                return Collision{t_, medium_.at(ray_.at(t_), colors_, lambda_), sigma_t_ * segment_.density,
                                 transmittance()};
            }
            if (left < infinity) left -= passed;
            depth_ += passed;
            t_ = segment_.end;
        }
        if (needs_surface()) return std::nullopt;
        const std::optional<MajorantSegment> following = walk_.next();
        if (!following) return std::nullopt;
        segment_ = *following;
        t_ = segment_.begin;
    }
}

} // namespace alhazen
