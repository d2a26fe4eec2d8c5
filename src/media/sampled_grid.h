/// Values at the centres of a box's cells, interpolated between them: the field of a volume.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/bounds.h"

namespace alhazen {

/// Trilinear between the samples and 0 outside them, so that it fades out over the outer half of the
/// outermost cells. Places are in the unit cube; x runs fastest. (The convention of pbrt-v4's uniform grids.)
template <class T>
class SampledGrid {
  public:
    SampledGrid() = default;
    /// values: size.x * size.y * size.z of them.
    SampledGrid(Vec3i size, std::vector<T> values) : size_(size), values_(std::move(values)) {}

    bool empty() const { return values_.empty(); }
    std::size_t bytes() const { return values_.size() * sizeof(T); }

    /// The mean of convert(sample) over the eight samples around a place, weighed by nearness. V is what
    /// convert gives; V{} is nothing.
    template <class Convert>
    auto lookup(Vec3 place, const Convert& convert) const {
        using V = decltype(convert(values_[0]));
        const Vec3 at = scaled(place);
        if (!(at.x > -1 && at.y > -1 && at.z > -1)) return V{};
        const Vec3i lo{floor_to_int(at.x), floor_to_int(at.y), floor_to_int(at.z)};
        if (lo.x >= size_.x || lo.y >= size_.y || lo.z >= size_.z) return V{};
        const Vec3 f{at.x - static_cast<float>(lo.x), at.y - static_cast<float>(lo.y),
                     at.z - static_cast<float>(lo.z)};
        if (lo.x >= 0 && lo.y >= 0 && lo.z >= 0 && lo.x + 1 < size_.x && lo.y + 1 < size_.y &&
            lo.z + 1 < size_.z) {
            const auto row = static_cast<std::size_t>(size_.x),
                       layer = row * static_cast<std::size_t>(size_.y);
            const T* v = values_.data() + index(lo);
            auto along_x = [&](std::size_t i) { return convert(v[i]) * (1 - f.x) + convert(v[i + 1]) * f.x; };
            auto on_plane = [&](std::size_t i) { return along_x(i) * (1 - f.y) + along_x(i + row) * f.y; };
            return V(on_plane(0) * (1 - f.z) + on_plane(layer) * f.z);
        }
        auto sample = [&](int x, int y, int z) {
            const Vec3i p{lo.x + x, lo.y + y, lo.z + z};
            const bool is_inside =
                p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size_.x && p.y < size_.y && p.z < size_.z;
            return is_inside ? convert(values_[index(p)]) : V{};
        };
        auto along_x = [&](int y, int z) { return sample(0, y, z) * (1 - f.x) + sample(1, y, z) * f.x; };
        auto on_plane = [&](int z) { return along_x(0, z) * (1 - f.y) + along_x(1, z) * f.y; };
        return V(on_plane(0) * (1 - f.z) + on_plane(1) * f.z);
    }
    T lookup(Vec3 place) const {
        return lookup(place, [](const T& v) { return v; });
    }

    /// The largest convert(sample) among the samples that a place in the box depends on; at least 0.
    template <class Convert>
    float largest(const Bounds3& places, const Convert& convert) const {
        const Vec3 lo = scaled(places.lo), hi = scaled(places.hi);
        auto first = [](float v) { return std::max(static_cast<int>(std::floor(std::max(v, -1.0f))), 0); };
        auto last = [](float v, int n) {
            return std::min(static_cast<int>(std::floor(std::max(v, -1.0f))) + 1, n - 1);
        };
        float most = 0;
        for (int z = first(lo.z); z <= last(hi.z, size_.z); ++z)
            for (int y = first(lo.y); y <= last(hi.y, size_.y); ++y)
                for (int x = first(lo.x); x <= last(hi.x, size_.x); ++x)
                    most = std::max(most, convert(values_[index({x, y, z})]));
        return most;
    }

  private:
    Vec3 scaled(Vec3 place) const {
        return {place.x * static_cast<float>(size_.x) - 0.5f, place.y * static_cast<float>(size_.y) - 0.5f,
                place.z * static_cast<float>(size_.z) - 0.5f};
    }
    std::size_t index(Vec3i p) const {
        auto n = [](int v) { return static_cast<std::size_t>(v); };
        return n(p.x) + n(size_.x) * (n(p.y) + n(size_.y) * n(p.z));
    }

    Vec3i size_;
    std::vector<T> values_;
};

} // namespace alhazen
