#include "sdf/voxel_field.h"

#include <map>
#include <tuple>

#include "base/threads.h"

namespace alhazen {

namespace {

constexpr int brick_size = GridBrick::size;

Vec3i brick_of(Vec3i p) {
    return {p.x >> 3, p.y >> 3, p.z >> 3};
}

std::size_t place_in(Vec3i brick, Vec3i lo, Vec3i n) {
    Vec3i q = brick - lo;
    return static_cast<std::size_t>(q.x) +
           static_cast<std::size_t>(n.x) * (static_cast<std::size_t>(q.y) +
                                            static_cast<std::size_t>(n.y) * static_cast<std::size_t>(q.z));
}

bool is_within(Vec3i brick, Vec3i lo, Vec3i n) {
    Vec3i q = brick - lo;
    return q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < n.x && q.y < n.y && q.z < n.z;
}

template <class Corners>
double trilinear(const Corners& s, Vec3d w) {
    auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    double y0 = mix(mix(s[0], s[1], w.x), mix(s[2], s[3], w.x), w.y);
    double y1 = mix(mix(s[4], s[5], w.x), mix(s[6], s[7], w.x), w.y);
    return mix(y0, y1, w.z);
}

template <class Corners>
Vec3d trilinear_gradient(const Corners& s, Vec3d w) {
    auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    Vec3d g;
    g.x = mix(mix(s[1] - s[0], s[3] - s[2], w.y), mix(s[5] - s[4], s[7] - s[6], w.y), w.z);
    g.y = mix(mix(s[2] - s[0], s[3] - s[1], w.x), mix(s[6] - s[4], s[7] - s[5], w.x), w.z);
    g.z = mix(mix(s[4] - s[0], s[5] - s[1], w.x), mix(s[6] - s[2], s[7] - s[3], w.x), w.y);
    return g;
}

// The trilinear function of the corners along o + s d, o and d in the cell's coordinates.
template <class Corners>
Cubic cubic_along(const Corners& v, Vec3d o, Vec3d d) {
    // v = k0 + k1 x + k2 y + k3 x y + z (k4 + k5 x + k6 y + k7 x y)
    double k0 = v[0], k1 = v[1] - v[0], k2 = v[2] - v[0], k3 = v[3] - v[2] - k1;
    double k4 = v[4] - v[0], a = v[5] - v[4], k5 = a - k1, k6 = v[6] - v[4] - k2, k7 = v[7] - v[6] - a - k3;
    double xy0 = o.x * o.y, xy1 = o.x * d.y + o.y * d.x, xy2 = d.x * d.y;
    // Of the two layers, by powers of s.
    double l0 = k0 + k1 * o.x + k2 * o.y + k3 * xy0, l1 = k1 * d.x + k2 * d.y + k3 * xy1, l2 = k3 * xy2;
    double u0 = k4 + k5 * o.x + k6 * o.y + k7 * xy0, u1 = k5 * d.x + k6 * d.y + k7 * xy1, u2 = k7 * xy2;
    return {l0 + o.z * u0, l1 + o.z * u1 + d.z * u0, l2 + o.z * u2 + d.z * u1, d.z * u2};
}

} // namespace

VoxelField::VoxelField(const GridData& data) : lo_(data.lo), hi_(data.hi) {
    background_ = static_cast<double>(data.background);
    brick_lo_ = brick_of(lo_);
    brick_n_ = brick_of(hi_) - brick_lo_ + Vec3i{1, 1, 1};
    keep_crossed(data);
    for (const Brick& b : bricks_)
        for (int z = 0; z < brick_size; ++z)
            for (int y = 0; y < brick_size; ++y)
                for (int x = 0; x < brick_size; ++x) {
                    if (!b.is_crossed(x, y, z)) continue;
                    Vec3d p(b.origin + Vec3i{x, y, z});
                    Box cell{p, p + Vec3d(1.0)};
                    bounds_ = bounds_.is_empty() ? cell : bounds_.united(cell);
                }
}

// The brick with the first samples of its neighbours (around[x + 2 y + 4 z]; the first is the brick itself).
// What is not stored does not change its sign here.
void VoxelField::fill(Brick& b, const std::array<const GridBrick*, 8>& around) const {
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const GridBrick* from =
                    around[static_cast<std::size_t>((x >> 3) + 2 * (y >> 3) + 4 * (z >> 3))];
                float value = from ? from->values[GridBrick::at(x & 7, y & 7, z & 7)]
                                   : std::copysign(static_cast<float>(background_),
                                                   around[0]->values[GridBrick::at(
                                                       std::min(x, 7), std::min(y, 7), std::min(z, 7))]);
                b.values[static_cast<std::size_t>(x + side * (y + side * z))] = value;
            }
}

// Notes the cells, between known samples, at whose corners the sign is not the same; whether there are any.
bool VoxelField::mark_crossed(Brick& b, const std::array<const GridBrick*, 8>& around) const {
    bool any = false;
    for (int z = 0; z < brick_size; ++z)
        for (int y = 0; y < brick_size; ++y)
            for (int x = 0; x < brick_size; ++x) {
                Vec3i cell = b.origin + Vec3i{x, y, z};
                bool is_of_grid = cell.x >= lo_.x && cell.y >= lo_.y && cell.z >= lo_.z && cell.x < hi_.x &&
                                  cell.y < hi_.y && cell.z < hi_.z;
                bool is_known = around[static_cast<std::size_t>(((x + 1) >> 3) + 2 * ((y + 1) >> 3) +
                                                                4 * ((z + 1) >> 3))] != nullptr;
                if (!is_of_grid || !is_known) continue;
                int inside = 0;
                for (int i = 0; i < 8; ++i) inside += b.at(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) < 0;
                if (inside == 0 || inside == 8) continue;
                b.crossed[static_cast<std::size_t>(z)] |= std::uint64_t{1} << (x + 8 * y);
                any = true;
            }
    return any;
}

// Every brick that the surface passes through, and those around, which smooth normals look into.
void VoxelField::keep_crossed(const GridData& data) {
    std::map<std::tuple<int, int, int>, const GridBrick*> all;
    for (const GridBrick& b : data.bricks) all[{b.origin.x >> 3, b.origin.y >> 3, b.origin.z >> 3}] = &b;
    std::size_t places = static_cast<std::size_t>(brick_n_.x) * static_cast<std::size_t>(brick_n_.y) *
                         static_cast<std::size_t>(brick_n_.z);
    index_.assign(places, -1);
    std::vector<Brick> made;
    std::vector<char> is_wanted(places, 0);
    for (const auto& [key, source] : all) {
        Vec3i place{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
        std::array<const GridBrick*, 8> around{};
        for (int i = 0; i < 8; ++i) {
            auto it = all.find({place.x + (i & 1), place.y + (i >> 1 & 1), place.z + (i >> 2)});
            if (it != all.end()) around[static_cast<std::size_t>(i)] = it->second;
        }
        Brick& b = made.emplace_back();
        b.origin = source->origin;
        fill(b, around);
        if (!mark_crossed(b, around)) continue;
        for (int i = 0; i < 27; ++i) {
            Vec3i q = place + Vec3i{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
            if (is_within(q, brick_lo_, brick_n_)) is_wanted[place_in(q, brick_lo_, brick_n_)] = 1;
        }
    }
    for (const Brick& b : made) {
        std::size_t at = place_in(brick_of(b.origin), brick_lo_, brick_n_);
        if (!is_wanted[at]) continue;
        index_[at] = static_cast<std::int32_t>(bricks_.size());
        bricks_.push_back(b);
    }
}

const VoxelField::Brick* VoxelField::brick_at(Vec3i p) const {
    Vec3i b = brick_of(p);
    if (!is_within(b, brick_lo_, brick_n_)) return nullptr;
    std::int32_t i = index_[place_in(b, brick_lo_, brick_n_)];
    return i < 0 ? nullptr : &bricks_[static_cast<std::size_t>(i)];
}

double VoxelField::sample(Vec3i p) const {
    p = {std::clamp(p.x, lo_.x, hi_.x), std::clamp(p.y, lo_.y, hi_.y), std::clamp(p.z, lo_.z, hi_.z)};
    const Brick* b = brick_at(p);
    return b ? b->at(p.x & 7, p.y & 7, p.z & 7) : background_;
}

VoxelField::Corners8 VoxelField::corners(Vec3i cell) const {
    Corners8 s;
    const Brick* b = brick_at(cell);
    for (int i = 0; i < 8; ++i) {
        Vec3i step{i & 1, i >> 1 & 1, i >> 2};
        s[static_cast<std::size_t>(i)] =
            b ? b->at((cell.x & 7) + step.x, (cell.y & 7) + step.y, (cell.z & 7) + step.z)
              : sample(cell + step);
    }
    return s;
}

Vec3i VoxelField::cell_of(Vec3d p) const {
    Vec3i cell;
    for (int i = 0; i < 3; ++i)
        cell[i] = static_cast<int>(
            std::clamp(std::floor(p[i]), static_cast<double>(lo_[i]), static_cast<double>(hi_[i] - 1)));
    return cell;
}

double VoxelField::value(Vec3d p) const {
    Vec3i cell = cell_of(p);
    return trilinear(corners(cell), p - Vec3d(cell));
}

Vec3d VoxelField::gradient(Vec3d p) const {
    Vec3i cell = cell_of(p);
    return trilinear_gradient(corners(cell), p - Vec3d(cell));
}

Vec3d VoxelField::smooth_gradient(Vec3d p) const {
    Vec3i base{static_cast<int>(std::floor(p.x - 0.5)), static_cast<int>(std::floor(p.y - 0.5)),
               static_cast<int>(std::floor(p.z - 0.5))};
    Vec3d w = p - Vec3d(0.5) - Vec3d(base), sum;
    for (int i = 0; i < 8; ++i) {
        Vec3i step{i & 1, i >> 1 & 1, i >> 2};
        Vec3i cell = cell_of(Vec3d(base + step));
        double weight = (step.x ? w.x : 1 - w.x) * (step.y ? w.y : 1 - w.y) * (step.z ? w.z : 1 - w.z);
        sum += trilinear_gradient(corners(cell), p - Vec3d(cell)) * weight;
    }
    return sum;
}

/// The way through bricks and, where they hold surface, through their cells (Amanatides and Woo 1987). Where
/// a side is crossed is computed from its coordinate each time, so that errors do not add up.
struct VoxelField::March {
    const VoxelField& field;
    Vec3d o, d;
    double sign = 0; ///< of the field so far; 0 as long as no brick has told

    // Calls visit(cell, t0, t1) for cells of the given size from t0 to t1, in order, until it returns true.
    template <class Visit>
    bool walk(double size, double t0, double t1, const Visit& visit) const {
        Vec3d p = o + d * t0;
        Vec3i cell, step;
        for (int i = 0; i < 3; ++i) {
            cell[i] = static_cast<int>(std::floor(p[i] / size));
            step[i] = d[i] > 0 ? 1 : d[i] < 0 ? -1 : 0;
        }
        while (t0 < t1) {
            double next = t1;
            int axis = -1;
            for (int i = 0; i < 3; ++i) {
                if (step[i] == 0) continue;
                double side_at = (static_cast<double>(cell[i] + (step[i] > 0 ? 1 : 0)) * size - o[i]) / d[i];
                if (side_at < next) {
                    next = side_at;
                    axis = i;
                }
            }
            next = std::max(next, t0);
            if (visit(cell, t0, next)) return true;
            if (axis < 0) return false;
            cell[axis] += step[axis];
            t0 = next;
        }
        return false;
    }

    std::optional<double> crossing_in(Vec3i cell, const Brick& brick, double t0, double t1) {
        Vec3i q = cell - brick.origin;
        if (q.x < 0 || q.y < 0 || q.z < 0 || q.x > 7 || q.y > 7 || q.z > 7 ||
            !brick.is_crossed(q.x, q.y, q.z))
            return std::nullopt;
        Corners8 s;
        for (int i = 0; i < 8; ++i)
            s[static_cast<std::size_t>(i)] = brick.at(q.x + (i & 1), q.y + (i >> 1 & 1), q.z + (i >> 2));
        Cubic c = cubic_along(s, o + d * t0 - Vec3d(cell), d);
        if (sign == 0) sign = c[0] < 0 ? -1 : 1;
        // Between two cells rounding may lose a zero; the sign tells.
        if (sign * c[0] < 0) return t0;
        auto at = first_sign_change(c, t1 - t0, sign);
        if (at) return t0 + *at;
        return std::nullopt;
    }
};

std::optional<double> VoxelField::first_crossing(Vec3d o, Vec3d d, double tmax) const {
    if (bounds_.is_empty()) return std::nullopt;
    double t0 = 0, t1 = tmax;
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (o[i] < bounds_.lo[i] || o[i] > bounds_.hi[i]) return std::nullopt;
            continue;
        }
        double a = (bounds_.lo[i] - o[i]) / d[i], b = (bounds_.hi[i] - o[i]) / d[i];
        t0 = std::max(t0, std::min(a, b));
        t1 = std::min(t1, std::max(a, b));
    }
    if (!(t0 < t1)) return std::nullopt;
    March march{*this, o, d};
    std::optional<double> found;
    march.walk(brick_size, t0, t1, [&](Vec3i b, double from, double to) {
        if (!is_within(b, brick_lo_, brick_n_)) return false;
        std::int32_t i = index_[place_in(b, brick_lo_, brick_n_)];
        if (i < 0) return false;
        const Brick& brick = bricks_[static_cast<std::size_t>(i)];
        return march.walk(1, from, to, [&](Vec3i cell, double in, double out) {
            found = march.crossing_in(cell, brick, in, out);
            return found.has_value();
        });
    });
    return found;
}

Vec3d VoxelField::move_to_surface(Vec3d p) const {
    Vec3d best = p;
    double least = Box::far;
    for (int i = 0; i < 12; ++i) {
        double f = value(p);
        if (std::abs(f) < least) {
            least = std::abs(f);
            best = p;
        }
        Vec3d g = gradient(p);
        double g2 = dot(g, g);
        if (f == 0 || !(g2 > 0)) break;
        Vec3d step = g * (f / g2);
        if (!(length(step) < 1)) break;
        p -= step;
    }
    return best;
}

std::vector<SdfTriangle> VoxelField::triangles() const {
    std::vector<std::vector<SdfTriangle>> parts(bricks_.size());
    parallel_ranges(bricks_.size(), 1, [&](std::size_t k, std::size_t) {
        const Brick& b = bricks_[k];
        for (int z = 0; z < brick_size; ++z)
            for (int y = 0; y < brick_size; ++y)
                for (int x = 0; x < brick_size; ++x) {
                    if (!b.is_crossed(x, y, z)) continue;
                    Vec3i cell = b.origin + Vec3i{x, y, z};
                    march_cell(
                        Vec3d(cell), 1, corners(cell), [this](Vec3d p) { return move_to_surface(p); },
                        parts[k]);
                }
    });
    std::vector<SdfTriangle> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace alhazen
