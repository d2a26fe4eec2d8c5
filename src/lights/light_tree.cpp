#include "lights/light_tree.h"

#include <array>
#include <limits>

#include "base/lanes.h"
#include "color/spectrum.h"

namespace alhazen {
namespace {

/// cos(max(0, a - b)) and sin(max(0, a - b)) for angles within 0 ... pi.
Lanes4 cos_of_difference(Lanes4 sin_a, Lanes4 cos_a, Lanes4 sin_b, Lanes4 cos_b) {
    return cos_a > cos_b ? all_lanes(1) : cos_a * cos_b + sin_a * sin_b;
}
Lanes4 sin_of_difference(Lanes4 sin_a, Lanes4 cos_a, Lanes4 sin_b, Lanes4 cos_b) {
    return cos_a > cos_b ? all_lanes(0) : sin_a * cos_b - cos_a * sin_b;
}
Lanes4 square_root(Lanes4 v) {
    return sqrt(Spectrum(max_lanes(v, all_lanes(0)))).lanes;
}

constexpr int bucket_count = 12;
/// From this depth on, groups are halved by count, so that a trail fits into 64 bits.
constexpr int balanced_depth = 32;

int bucket_of(float x, float lo, float hi) {
    return std::clamp(static_cast<int>(static_cast<float>(bucket_count) * ((x - lo) / (hi - lo))), 0,
                      bucket_count - 1);
}

struct Split {
    int axis = -1;  ///< -1: none was found
    int bucket = 0; ///< the last one of the first half
    float cost = infinity;
};

/// The best of the planes between buckets along one axis. `stretch` prefers splitting a long box across.
template <class Items>
void try_axis(const Items& items, int axis, const Bounds3& centroids, float stretch, Split& best) {
    float lo = centroids.lo[axis], hi = centroids.hi[axis];
    std::array<LightGroup, bucket_count> buckets;
    for (const auto& item : items)
        buckets[static_cast<std::size_t>(bucket_of(item.centroid[axis], lo, hi))].merge(item.group);
    std::array<float, bucket_count> above{};
    LightGroup group;
    for (std::size_t i = bucket_count - 1; i > 0; --i) {
        group.merge(buckets[i]);
        above[i] = group.cost();
    }
    group = {};
    for (std::size_t i = 0; i + 1 < bucket_count; ++i) {
        group.merge(buckets[i]);
        float cost = stretch * (group.cost() + above[i + 1]);
        if (cost < best.cost) best = {axis, static_cast<int>(i), cost};
    }
}

} // namespace

LightTree::LightTree(std::span<const LightBounds> bounds) : trails_(bounds.size(), not_in_tree) {
    std::vector<Item> items;
    items.reserve(bounds.size());
    for (std::uint32_t i = 0; i < bounds.size(); ++i)
        if (bounds[i].power > 0 && !bounds[i].bounds.empty())
            items.push_back({LightGroup(bounds[i]), bounds[i].bounds.centroid(), i});
    nodes_.reserve(2 * items.size());
    if (items.empty()) return;
    const LightGroup all = build(items, 0, 0);
    all_.set(0, all);
    all_.set(1, all);
}

LightGroup LightTree::build(std::span<Item> items, std::uint64_t trail, int depth) {
    std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (items.size() == 1) {
        nodes_[index].is_leaf = true;
        nodes_[index].second = items[0].light;
        trails_[items[0].light] = trail;
        return items[0].group;
    }
    Bounds3 centroids, all;
    for (const Item& item : items) {
        centroids.extend(item.centroid);
        all.extend(item.group.bounds);
    }
    Split best;
    Vec3 size = all.diagonal();
    for (int axis = 0; axis < 3 && depth < balanced_depth; ++axis)
        if (centroids.hi[axis] > centroids.lo[axis])
            try_axis(items, axis, centroids, max_component(size) / size[axis], best);

    auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
    if (best.axis >= 0) {
        auto in_first = [&](const Item& item) {
            return bucket_of(item.centroid[best.axis], centroids.lo[best.axis], centroids.hi[best.axis]) <=
                   best.bucket;
        };
        auto end_of_first = std::partition(items.begin(), items.end(), in_first);
        if (end_of_first != items.begin() && end_of_first != items.end()) middle = end_of_first;
    } else {
        int axis = max_dimension(centroids.diagonal());
        std::nth_element(items.begin(), middle, items.end(),
                         [&](const Item& a, const Item& b) { return a.centroid[axis] < b.centroid[axis]; });
    }
    auto first_count = static_cast<std::size_t>(middle - items.begin());
    LightGroup group = build(items.first(first_count), trail, depth + 1);
    nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
    const LightGroup second =
        build(items.subspan(first_count), trail | (std::uint64_t{1} << depth), depth + 1);
    nodes_[index].children.set(0, group);
    nodes_[index].children.set(1, second);
    group.merge(second);
    return group;
}

void LightTree::Pair::set(std::size_t i, const LightGroup& group) {
    const Sphere3 sphere = bounding_sphere(group.bounds);
    for (int k = 0; k < 3; ++k) {
        center[static_cast<std::size_t>(k)][i] = sphere.center[k];
        axis[static_cast<std::size_t>(k)][i] = group.axis[k];
    }
    radius_squared[i] = sqr(sphere.radius);
    cos_normals[i] = std::cos(group.normal_angle);
    sin_normals[i] = std::sin(group.normal_angle);
    cos_falloff[i] = std::cos(group.falloff_angle);
    power[i] = group.power;
    two_sided[i] = group.two_sided ? -1 : 0;
}

// Where the paper's bound is close to 0, it is kept a little above, so that rounding never makes a light that
// contributes impossible to find.
LightTree::Pair::Two LightTree::Pair::importance(const LightReceiver& at) const {
    constexpr float smallest_cosine = 1e-3f;
    auto load = [](const Two& v) { return join_pairs(v.data(), v.data()); };
    const Lanes4 x = at.p.x - load(center[0]), y = at.p.y - load(center[1]), z = at.p.z - load(center[2]);
    const Lanes4 d2 = x * x + y * y + z * z, radius2 = load(radius_squared);
    const Lanes4 scale = 1 / square_root(d2);
    const Lanes4 sin2_b = radius2 / d2; // angle b: the group's radius as seen from the receiver
    const Lanes4 sin_b = square_root(sin2_b), cos_b = square_root(1 - sin2_b);
    auto cosine = [](Lanes4 v) { return max_lanes(min_lanes(v, all_lanes(1)), all_lanes(-1)); };
    Lanes4 cos_w = cosine((x * load(axis[0]) + y * load(axis[1]) + z * load(axis[2])) * scale);
    const IntLanes4 both{two_sided[0], two_sided[1], two_sided[0], two_sided[1]};
    cos_w = (both & (cos_w < 0)) ? -cos_w : cos_w;
    const Lanes4 sin_w = square_root(1 - cos_w * cos_w), cos_n = load(cos_normals), sin_n = load(sin_normals);
    Lanes4 cos_emitted = cos_of_difference(sin_of_difference(sin_w, cos_w, sin_n, cos_n),
                                           cos_of_difference(sin_w, cos_w, sin_n, cos_n), sin_b, cos_b);
    Lanes4 cos_received = all_lanes(1);
    if (at.ns != Vec3()) {
        Lanes4 cos_i = cosine((x * at.ns.x + y * at.ns.y + z * at.ns.z) * scale);
        cos_i = cos_i < 0 ? -cos_i : cos_i;
        cos_received = cos_of_difference(square_root(1 - cos_i * cos_i), cos_i, sin_b, cos_b);
    }
    const IntLanes4 outside = (d2 > radius2) & (d2 < infinity);
    const IntLanes4 is_dark = outside & (cos_emitted < load(cos_falloff) - smallest_cosine);
    const Lanes4 least = all_lanes(smallest_cosine);
    cos_emitted = outside ? max_lanes(cos_emitted, least) : all_lanes(1);
    cos_received = outside ? max_lanes(cos_received, least) : all_lanes(1);
    // Points at a light of no size are taken for very near ones.
    const Lanes4 value =
        load(power) * cos_emitted * cos_received / max_lanes(max_lanes(d2, radius2), all_lanes(1e-20f));
    // Not too large for two to be added; the comparison also catches NaN.
    constexpr float largest = 1e30f;
    const Lanes4 in_range =
        value < largest ? max_lanes(value, all_lanes(std::numeric_limits<float>::min())) : all_lanes(largest);
    return {is_dark[0] ? 0.0f : in_range[0], is_dark[1] ? 0.0f : in_range[1]};
}

std::optional<LightTree::Found> LightTree::find(const LightReceiver& at, float u) const {
    if (nodes_.empty()) return std::nullopt;
    float probability = 1;
    std::uint32_t i = 0;
    while (!nodes_[i].is_leaf) {
        std::uint32_t second = nodes_[i].second;
        const auto [a, b] = nodes_[i].children.importance(at);
        if (a + b == 0) return std::nullopt;
        // u is stretched over the child's part of the unit interval and used again.
        float to_first = a / (a + b);
        bool first = u < to_first;
        u = std::min(first ? u / to_first : (u - to_first) / (1 - to_first), one_minus_epsilon);
        probability *= (first ? a : b) / (a + b);
        i = first ? i + 1 : second;
    }
    if (is_unlit_by_all(at)) return std::nullopt;
    return Found{nodes_[i].second, probability};
}

float LightTree::probability(const LightReceiver& at, std::uint32_t light) const {
    std::uint64_t trail = trails_[light];
    if (trail == not_in_tree) return 0;
    float probability = 1;
    std::uint32_t i = 0;
    for (; !nodes_[i].is_leaf; trail >>= 1) {
        std::uint32_t second = nodes_[i].second;
        const auto [a, b] = nodes_[i].children.importance(at);
        bool first = (trail & 1) == 0;
        if ((first ? a : b) == 0) return 0;
        probability *= (first ? a : b) / (a + b);
        i = first ? i + 1 : second;
    }
    return is_unlit_by_all(at) ? 0 : probability;
}

} // namespace alhazen
