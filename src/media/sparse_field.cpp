#include "media/sparse_field.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

constexpr int bits = 3; // of an index in a brick
static_assert(GridBrick::size == 1 << bits);

Vec3i floor_of(Vec3 p) {
    return {floor_to_int(p.x), floor_to_int(p.y), floor_to_int(p.z)};
}

std::size_t at(const GridBrick& brick, Vec3i p) {
    return GridBrick::at(p.x - brick.origin.x, p.y - brick.origin.y, p.z - brick.origin.z);
}

} // namespace

SparseField::SparseField(GridData data)
    : lo_(data.lo), hi_(data.hi), bricks_(std::move(data.bricks)),
      object_from_index_(data.object_from_index) {
    for (int i = 0; i < 3; ++i) {
        first_brick_[i] = lo_[i] >> bits;
        count_[i] = (hi_[i] >> bits) - first_brick_[i] + 1;
    }
    auto n = [](int v) { return static_cast<std::size_t>(v); };
    index_.assign(n(count_.x) * n(count_.y) * n(count_.z), -1);
    for (std::size_t k = 0; k < bricks_.size(); ++k) {
        Vec3i b;
        bool is_inside = true;
        for (int i = 0; i < 3; ++i) {
            b[i] = (bricks_[k].origin[i] >> bits) - first_brick_[i];
            is_inside = is_inside && b[i] >= 0 && b[i] < count_[i];
        }
        if (is_inside)
            index_[n(b.x) + n(count_.x) * (n(b.y) + n(count_.y) * n(b.z))] = static_cast<std::int32_t>(k);
    }
}

Bounds3 SparseField::bounds() const {
    auto real = [](Vec3i p) {
        return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    };
    return {real(lo_), real(hi_) + Vec3(1)};
}

const GridBrick* SparseField::brick_at(Vec3i sample) const {
    const Vec3i b{(sample.x >> bits) - first_brick_.x, (sample.y >> bits) - first_brick_.y,
                  (sample.z >> bits) - first_brick_.z};
    if (b.x < 0 || b.y < 0 || b.z < 0 || b.x >= count_.x || b.y >= count_.y || b.z >= count_.z)
        return nullptr;
    auto n = [](int v) { return static_cast<std::size_t>(v); };
    const std::int32_t k = index_[n(b.x) + n(count_.x) * (n(b.y) + n(count_.y) * n(b.z))];
    return k < 0 ? nullptr : &bricks_[static_cast<std::size_t>(k)];
}

float SparseField::sample(Vec3i p) const {
    const GridBrick* brick = brick_at(p);
    return brick ? brick->values[at(*brick, p)] : 0;
}

float SparseField::lookup(Vec3 p) const {
    const Vec3i lo = floor_of(p);
    const Vec3 f{p.x - static_cast<float>(lo.x), p.y - static_cast<float>(lo.y),
                 p.z - static_cast<float>(lo.z)};
    std::array<float, 8> corner;
    constexpr int last = GridBrick::size - 1;
    if ((lo.x & last) != last && (lo.y & last) != last && (lo.z & last) != last) {
        // Most places have their eight samples in one brick.
        const GridBrick* brick = brick_at(lo);
        if (!brick) return 0;
        const float* v = brick->values.data() + at(*brick, lo);
        corner = {v[0], v[1], v[8], v[9], v[64], v[65], v[72], v[73]};
    } else {
        for (int i = 0; i < 8; ++i)
            corner[static_cast<std::size_t>(i)] =
                sample({lo.x + (i & 1), lo.y + (i >> 1 & 1), lo.z + (i >> 2)});
    }
    auto along_x = [&](std::size_t i) { return lerp(f.x, corner[i], corner[i + 1]); };
    auto on_plane = [&](std::size_t i) { return lerp(f.y, along_x(i), along_x(i + 2)); };
    return lerp(f.z, on_plane(0), on_plane(4));
}

float SparseField::largest(const Bounds3& box) const {
    Vec3i lo = floor_of(box.lo), hi = floor_of(box.hi);
    for (int i = 0; i < 3; ++i) {
        lo[i] = std::max(lo[i], lo_[i]);
        hi[i] = std::min(hi[i] + 1, hi_[i]);
    }
    float most = 0;
    constexpr int size = GridBrick::size;
    for (int bz = brick_origin(lo.z); bz <= hi.z; bz += size)
        for (int by = brick_origin(lo.y); by <= hi.y; by += size)
            for (int bx = brick_origin(lo.x); bx <= hi.x; bx += size) {
                const GridBrick* brick = brick_at({bx, by, bz});
                if (!brick) continue;
                for (int z = std::max(bz, lo.z); z <= std::min(bz + size - 1, hi.z); ++z)
                    for (int y = std::max(by, lo.y); y <= std::min(by + size - 1, hi.y); ++y)
                        for (int x = std::max(bx, lo.x); x <= std::min(bx + size - 1, hi.x); ++x)
                            most = std::max(most, brick->values[at(*brick, {x, y, z})]);
            }
    return most;
}

} // namespace alhazen
