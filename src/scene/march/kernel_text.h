/// The kernel that marches rays through a distance field, once for every instruction set. Sphere tracing
/// (Hart 1996), eight rays at a time and several times eight in turn: while one eight waits for the memory
/// that its step named, the others step.
///
/// No surface is nearer than the nearest sample says, less the way to it: that is how far a ray may go, or to
/// the end of the sample's cell, if nothing is in it. Next to surfaces the sample knows the plane of the
/// nearest triangle, and the ray meets it where it crosses that plane within the cell, but for what is nearer
/// to the sample than its distance: there the triangle has ended. In bricks that are far from everything
/// their middle stands for all samples, and the brick for the cell.
#pragma once

#include "scene/march/start_text.h"

namespace {

constexpr int eights = 4;
/// How far into the next cell a step to a cell's end goes.
constexpr float beyond = 0.01f;
/// How far off a plane's number may put it.
constexpr float rough = 0.02f;
/// How far beyond a sample's cell planes count whose triangles are beside the sample, so that few rays slip
/// between them. Where triangles end before, their planes are less sure.
constexpr float ahead = 0.15f;

/// Eight rays underway.
struct alignas(64) Eight {
    float o[3][lanes], d[3][lanes], inverse[3][lanes]; ///< inverse of the direction
    float s[lanes], end[lanes], entry[lanes], t_a_cell[lanes];
    std::int32_t ray[lanes];          ///< its number; less than 0: none
    std::uint32_t brick[lanes];       ///< what is known of where it is
    std::uint32_t sample[lanes];      ///< the nearest, or 0 in far bricks
    alhazen::MarchSample word[lanes]; ///< that sample
    std::int32_t at[3][lanes];        ///< the nearest sample on each axis
    float offset[3][lanes];           ///< from that, or from the brick's middle
    std::int32_t is_met[lanes];       ///< whether it meets something at s
};

class March {
  public:
    March(const alhazen::MarchField& field, const alhazen::MarchRays& rays)
        : field_(field), rays_(rays), starts_(field, rays) {}

    void run() {
        int underway = 0;
        for (Eight& eight : eights_)
            for (int lane = 0; lane < lanes; ++lane) underway += load(eight, lane);
        // Each of these is short, so that processors are in several eights at once.
        while (underway > 0) {
            for (Eight& eight : eights_) find_brick(eight);
            for (Eight& eight : eights_) find_sample(eight);
            for (Eight& eight : eights_)
                for (int lane = 0; lane < lanes; ++lane)
                    eight.word[lane] = field_.samples[eight.sample[lane]];
            for (Eight& eight : eights_) step(eight);
            for (Eight& eight : eights_) underway -= end_rays(eight);
        }
    }

  private:
    // Whether there was another ray.
    bool load(Eight& eight, int lane) {
        const Start start = starts_.next();
        eight.ray[lane] = start.ray;
        if (start.ray < 0) {
            // An idle lane stays where it is.
            for (int axis = 0; axis < 3; ++axis) eight.o[axis][lane] = eight.d[axis][lane] = 0;
            eight.s[lane] = eight.end[lane] = 0;
            return false;
        }
        for (int axis = 0; axis < 3; ++axis) {
            eight.o[axis][lane] = start.o[axis];
            eight.d[axis][lane] = start.d[axis];
            eight.inverse[axis][lane] = start.inverse[axis];
        }
        eight.s[lane] = march_start;
        eight.end[lane] = start.end;
        eight.entry[lane] = start.entry;
        eight.t_a_cell[lane] = start.t_a_cell;
        return true;
    }

    ALHAZEN_INLINE void find_brick(Eight& eight) const {
        const Floats s = floats(eight.s);
        Ints at[3];
        for (int axis = 0; axis < 3; ++axis) {
            const Floats x = floats(eight.o[axis]) + floats(eight.d[axis]) * s;
            at[axis] = clamp(__builtin_convertvector(x + 0.5f, Ints), field_.last[axis]);
            store(eight.at[axis], at[axis]);
            store(eight.offset[axis], x - __builtin_convertvector(at[axis], Floats));
        }
        alignas(32) std::int32_t number[lanes];
        store(number, (at[0] >> 2) + (at[1] >> 2) * field_.bricks_x + (at[2] >> 2) * field_.bricks_xy);
        for (int lane = 0; lane < lanes; ++lane) eight.brick[lane] = field_.bricks[number[lane]];
    }

    ALHAZEN_INLINE void find_sample(Eight& eight) const {
        const Ints brick = ints(eight.brick), is_far = brick < 0;
        Ints sample = brick << 6;
        for (int axis = 0; axis < 3; ++axis) {
            const Ints within = ints(eight.at[axis]) & 3;
            sample += within << 2 * axis;
            const Floats from_middle = __builtin_convertvector(within, Floats) - 1.5f;
            const Floats offset = floats(eight.offset[axis]);
            store(eight.offset[axis], is_far ? offset + from_middle : offset);
        }
        store(eight.sample, is_far ? Ints{} : sample);
        for (int lane = 0; lane < lanes; ++lane) __builtin_prefetch(field_.samples + eight.sample[lane]);
    }

    ALHAZEN_INLINE void step(Eight& eight) const {
        const Ints word = ints(eight.word), brick = ints(eight.brick), is_far = brick < 0;
        const Vector3 offset{floats(eight.offset[0]), floats(eight.offset[1]), floats(eight.offset[2])},
            d{floats(eight.d[0]), floats(eight.d[1]), floats(eight.d[2])};
        const Ints eighths = is_far ? brick & static_cast<int>(~alhazen::march_is_far)
                                    : word & static_cast<int>(alhazen::march_steps);
        const Floats distance = __builtin_convertvector(eighths, Floats) * (1 / alhazen::march_steps_a_cell);
        const Floats half = is_far ? Floats{} + 2 : Floats{} + 0.5f;
        const Floats exit = smaller(smaller(way_out(half, offset.x, d.x, floats(eight.inverse[0])),
                                            way_out(half, offset.y, d.y, floats(eight.inverse[1]))),
                                    way_out(half, offset.z, d.z, floats(eight.inverse[2])));
        const Floats sure = distance - square_root(dot(offset, offset));
        const Floats s = floats(eight.s);
        const Plane plane = plane_of(word);
        const Floats to = (plane.height - dot(plane.n, offset)) / dot(plane.n, d);
        const Vector3 met = offset + d * to;
        const Floats radius = larger(distance - rough, Floats{}), empty = radius * radius;
        const Ints is_beside = plane.height * plane.height >= empty * dot(plane.n, plane.n);
        const Ints is_met = (distance < alhazen::march_near) & (to >= -beyond) &
                            (to < (is_beside ? exit + ahead : exit)) & (s + to > alhazen::march_free) &
                            (dot(met, met) >= empty);
        store(eight.is_met, is_met);
        store(eight.s, s + (is_met ? to : larger(exit + beyond, sure)));
    }

    /// Points with dot(n, p) = height; as seen from the sample. The sizes of n's parts add up to 1.
    struct Plane {
        Vector3 n;
        Floats height;
    };
    ALHAZEN_INLINE static Plane plane_of(Ints word) {
        Vector3 n = {part(word, alhazen::march_normal_x) * (2.0f / alhazen::march_steps) - 1,
                     part(word, alhazen::march_normal_y) * (2.0f / alhazen::march_steps) - 1,
                     {}};
        n.z = 1 - absolute(n.x) - absolute(n.y);
        const Floats folded = n.z < 0 ? -n.z : Floats{};
        n.x = n.x - with_sign(folded, n.x);
        n.y = n.y - with_sign(folded, n.y);
        const Floats height =
            part(word, alhazen::march_height) * (2 * alhazen::march_most_height / alhazen::march_steps) -
            alhazen::march_most_height;
        return {n, height};
    }

    // How many rays have ended without another in their place.
    ALHAZEN_INLINE int end_rays(Eight& eight) {
        const Ints ended =
            (ints(eight.is_met) | (floats(eight.s) >= floats(eight.end))) & (ints(eight.ray) >= 0);
        int lost = 0;
        for (std::uint32_t left = bits_of(ended); left; left &= left - 1) {
            const int lane = __builtin_ctz(left);
            finish(eight, lane);
            lost += !load(eight, lane);
        }
        return lost;
    }

    ALHAZEN_INLINE static Floats part(Ints word, int bits) {
        return __builtin_convertvector(word >> bits & static_cast<int>(alhazen::march_steps), Floats);
    }
    // From there to the side of the cell, half its side from its middle.
    ALHAZEN_INLINE static Floats way_out(Floats half, Floats offset, Floats d, Floats inverse) {
        return (with_sign(half, d) - offset) * inverse;
    }

    void finish(const Eight& eight, int lane) const {
        const std::int32_t ray = eight.ray[lane];
        const bool is_hit = eight.is_met[lane] && eight.s[lane] < eight.end[lane];
        rays_.t[ray] = is_hit ? (eight.entry[lane] + eight.s[lane]) * eight.t_a_cell[lane] : __builtin_inff();
        rays_.sample[ray] = eight.sample[lane];
    }

    const alhazen::MarchField field_;
    const alhazen::MarchRays rays_;
    Starts starts_;
    Eight eights_[eights] = {};
};

void march(const alhazen::MarchField& field, const alhazen::MarchRays& rays) {
    March(field, rays).run();
}

} // namespace
