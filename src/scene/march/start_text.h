/// Rays on their way into a distance field: from where to where they are in it.
#pragma once

#include "base/lanes_text.h"
#include "scene/march/kernel.h"

namespace {

ALHAZEN_INLINE Floats floats(const float* numbers) {
    Floats v;
    __builtin_memcpy(&v, numbers, sizeof v);
    return v;
}
template <class Int>
ALHAZEN_INLINE Ints ints(const Int* numbers) {
    Ints v;
    __builtin_memcpy(&v, numbers, sizeof v);
    return v;
}
template <class Number, class V>
ALHAZEN_INLINE void store(Number* numbers, V v) {
    static_assert(sizeof(Number) == 4 && sizeof v == 32);
    __builtin_memcpy(numbers, &v, sizeof v);
}
ALHAZEN_INLINE Floats smaller(Floats a, Floats b) {
    return a < b ? a : b;
}
ALHAZEN_INLINE Floats larger(Floats a, Floats b) {
    return a > b ? a : b;
}
ALHAZEN_INLINE Ints clamp(Ints v, std::int32_t last) {
    v = v > 0 ? v : Ints{};
    return v < last ? v : Ints{} + last;
}

/// A ray in cells from the first sample; its direction is unit length.
struct Start {
    std::int32_t ray; ///< its number; less than 0: there are no more
    float o[3], d[3], inverse[3], begin, end, t_a_cell;
};

/// The rays one after the other, without those that do not come through the field.
class Starts {
  public:
    Starts(const alhazen::MarchField& field, const alhazen::MarchRays& rays) : field_(field), rays_(rays) {}

    Start next() {
        for (;; ++at_) {
            if (at_ == rays_.count) return {-1, {}, {}, {}, 0, 0, 0};
            const std::uint32_t lane = at_ % lanes;
            if (lane == 0) prepare();
            if (begin_[lane] < end_[lane]) break;
            rays_.t[at_] = __builtin_inff();
        }
        const std::uint32_t lane = at_ % lanes;
        return {static_cast<std::int32_t>(at_++),
                {o_[0][lane], o_[1][lane], o_[2][lane]},
                {d_[0][lane], d_[1][lane], d_[2][lane]},
                {inverse_[0][lane], inverse_[1][lane], inverse_[2][lane]},
                begin_[lane],
                end_[lane],
                t_a_cell_[lane]};
    }

  private:
    // Of eight rays.
    void prepare() {
        constexpr float longest = 1e9f, least_inverse = 1e-20f;
        Vector3 o{}, d{};
        Floats tmax{};
        for (std::uint32_t lane = 0; lane < lanes && at_ + lane < rays_.count; ++lane) {
            const float* ray = rays_.rays + std::size_t{alhazen::march_ray_size} * (at_ + lane);
            o.x[lane] = ray[0], o.y[lane] = ray[1], o.z[lane] = ray[2];
            d.x[lane] = ray[3], d.y[lane] = ray[4], d.z[lane] = ray[5];
            tmax[lane] = ray[6];
        }
        // Squares of what is too large or small for them are avoided; what is not finite makes NaNs, which
        // are in no interval.
        const Floats size = larger(larger(absolute(d.x), absolute(d.y)), absolute(d.z));
        d = {d.x / size, d.y / size, d.z / size};
        const Floats length = square_root(dot(d, d));
        const Floats cells_a_t = size * length / field_.cell;
        Floats begin{}, end = tmax * cells_a_t;
        end = end >= longest ? Floats{} + longest : end - rays_.free_cells;
        end = tmax == tmax ? end : Floats{};
        const Floats from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
        for (int axis = 0; axis < 3; ++axis) {
            const Floats at = (from[axis] - field_.lo[axis]) / field_.cell, w = along[axis] / length + 0.0f;
            // Along the sides of cells it never comes to them; no direction is -0, as if it came from there.
            const Floats inverse = 1 / with_sign(larger(absolute(w), Floats{} + least_inverse), w);
            const Floats a = (0 - at) * inverse, b = (static_cast<float>(field_.last[axis]) - at) * inverse;
            begin = larger(smaller(a, b), begin);
            end = smaller(end, larger(a, b));
            end = at - at == 0 && w - w == 0 ? end : Floats{};
            store(o_[axis], at);
            store(d_[axis], w);
            store(inverse_[axis], inverse);
        }
        // From surfaces they start a little way off: nothing would be met before.
        constexpr float off = 0.5f;
        static_assert(off < alhazen::march_free);
        store(begin_, larger(begin, Floats{} + off));
        store(end_, end);
        store(t_a_cell_, 1 / cells_a_t);
    }

    const alhazen::MarchField& field_;
    const alhazen::MarchRays& rays_;
    std::uint32_t at_ = 0; ///< the next ray
    alignas(32) float o_[3][lanes], d_[3][lanes], inverse_[3][lanes], begin_[lanes], end_[lanes],
        t_a_cell_[lanes];
};

} // namespace
