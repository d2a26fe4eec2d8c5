/// Rays on their way into a distance field: from where to where they are in it.
#pragma once

#include "base/lanes_text.h"
#include "scene/march/kernel.h"

namespace {

/// Cells from where it starts, or comes into the field, at which a march begins: nothing would be met before.
constexpr float march_start = 0.5f;
static_assert(march_start < alhazen::march_free);

/// A ray from where it comes into the field; in cells, from the first sample. Its direction is unit length.
struct Start {
    std::int32_t ray; ///< its number; less than 0: there are no more
    float o[3], d[3], inverse[3];
    float entry; ///< how far the ray came before
    float end, t_a_cell;
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
            if (march_start < end_[lane]) break;
            rays_.t[at_] = __builtin_inff();
        }
        const std::uint32_t lane = at_ % lanes;
        return {static_cast<std::int32_t>(at_++),
                {o_[0][lane], o_[1][lane], o_[2][lane]},
                {d_[0][lane], d_[1][lane], d_[2][lane]},
                {inverse_[0][lane], inverse_[1][lane], inverse_[2][lane]},
                entry_[lane],
                end_[lane],
                t_a_cell_[lane]};
    }

  private:
    // Of eight rays.
    void prepare() {
        constexpr float longest = 1e9f, least_part = 1e-5f, least_inverse = 1e-20f;
        Vector3 o{}, d{};
        Floats tmax{};
        for (std::uint32_t lane = 0; lane < lanes && at_ + lane < rays_.count; ++lane) {
            const float* ray = rays_.rays + std::size_t{alhazen::march_ray_size} * (at_ + lane);
            o.x[lane] = ray[0], o.y[lane] = ray[1], o.z[lane] = ray[2];
            d.x[lane] = ray[3], d.y[lane] = ray[4], d.z[lane] = ray[5];
            tmax[lane] = ray[6];
        }
        // Squares of what is too large or small for them are avoided; what is not finite makes NaNs. Origins
        // may be far away, so that up to the field double precision is needed.
        const Floats size = larger(larger(absolute(d.x), absolute(d.y)), absolute(d.z));
        const Vector3d scaled = widen(Vector3{d.x / size, d.y / size, d.z / size});
        const Doubles length = square_root(dot(scaled, scaled));
        const Vector3d unit = scaled * (1 / length);
        const Floats cells_a_t = size * narrow(length) / field_.cell;
        const Floats t_a_cell = 1 / cells_a_t;
        const Doubles from[3] = {in_cells(o.x, 0), in_cells(o.y, 1), in_cells(o.z, 2)},
                      along[3] = {unit.x, unit.y, unit.z};
        Floats entry{}, end = tmax * cells_a_t;
        end = end >= longest ? Floats{} + longest : end - rays_.free_cells;
        Ints is_ray = (tmax == tmax) & (t_a_cell > 0) & (t_a_cell < infinite) & (cells_a_t < infinite);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats at = narrow(from[axis]);
            // What goes along the sides of cells, or nearly, never comes to them, from either side.
            Floats w = narrow(along[axis]);
            w = absolute(w) < least_part ? Floats{} : w;
            const Floats inverse = 1 / with_sign(larger(absolute(w), Floats{} + least_inverse), w);
            const Floats a = (0 - at) * inverse, b = (static_cast<float>(field_.last[axis]) - at) * inverse;
            entry = larger(smaller(a, b), entry);
            end = smaller(end, larger(a, b));
            is_ray &= (at - at == 0) & (w - w == 0);
            store(d_[axis], w);
            store(inverse_[axis], inverse);
        }
        for (int axis = 0; axis < 3; ++axis)
            store(o_[axis], narrow(from[axis] + widen(floats(d_[axis])) * widen(entry)));
        store(entry_, entry);
        store(end_, is_ray ? end - entry : Floats{});
        store(t_a_cell_, t_a_cell);
    }

    ALHAZEN_INLINE Doubles in_cells(Floats place, int axis) const {
        return (widen(place) - static_cast<double>(field_.lo[axis])) * cells_a_unit_;
    }
    const alhazen::MarchField& field_;
    const alhazen::MarchRays& rays_;
    const double cells_a_unit_ = 1 / static_cast<double>(field_.cell);
    std::uint32_t at_ = 0; ///< the next ray
    alignas(32) float o_[3][lanes], d_[3][lanes], inverse_[3][lanes], entry_[lanes], end_[lanes],
        t_a_cell_[lanes];
};

} // namespace
