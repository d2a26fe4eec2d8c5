#include "lights/light_tree.h"

#include <array>
#include <limits>

namespace alhazen {
namespace {

/// cos(max(0, a - b)) and sin(max(0, a - b)) for angles within 0 ... pi.
float cos_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
    return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sin_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
    return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
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
    if (!items.empty()) build(items, 0, 0);
}

LightGroup LightTree::build(std::span<Item> items, std::uint64_t trail, int depth) {
    std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (items.size() == 1) {
        set_node(index, items[0].group);
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
    group.merge(build(items.subspan(first_count), trail | (std::uint64_t{1} << depth), depth + 1));
    set_node(index, group);
    return group;
}

void LightTree::set_node(std::size_t index, const LightGroup& group) {
    Node& node = nodes_[index];
    Sphere3 sphere = bounding_sphere(group.bounds);
    node.center = sphere.center;
    node.radius_squared = sqr(sphere.radius);
    node.axis = group.axis;
    node.cos_normals = std::cos(group.normal_angle);
    node.sin_normals = std::sin(group.normal_angle);
    node.cos_falloff = std::cos(group.falloff_angle);
    node.power = group.power;
    node.two_sided = group.two_sided;
}

// An upper bound, up to a factor, of what the group gives the receiver. Where the paper's bound is close to
// 0, it is kept a little above, so that rounding never makes a light that contributes impossible to find.
float LightTree::Node::importance(const LightReceiver& at) const {
    constexpr float smallest_cosine = 1e-3f;
    Vec3 v = at.p - center;
    float d2 = length_squared(v);
    float cos_emitted = 1, cos_received = 1;
    if (d2 > radius_squared && d2 < infinity) {
        Vec3 w = v / std::sqrt(d2);
        float sin2_b = radius_squared / d2; // angle b: the group's radius as seen from the receiver
        float sin_b = std::sqrt(sin2_b), cos_b = safe_sqrt(1 - sin2_b);
        float cos_w = std::clamp(dot(axis, w), -1.0f, 1.0f);
        if (two_sided) cos_w = std::abs(cos_w);
        float sin_w = safe_sqrt(1 - cos_w * cos_w);
        float cos_x = cos_of_difference(sin_w, cos_w, sin_normals, cos_normals);
        float sin_x = sin_of_difference(sin_w, cos_w, sin_normals, cos_normals);
        cos_emitted = cos_of_difference(sin_x, cos_x, sin_b, cos_b);
        if (cos_emitted < cos_falloff - smallest_cosine) return 0;
        if (at.ns != Vec3()) {
            float cos_i = std::min(abs_dot(w, at.ns), 1.0f);
            cos_received = cos_of_difference(safe_sqrt(1 - cos_i * cos_i), cos_i, sin_b, cos_b);
        }
    }
    // Points at a light of no size are taken for very near ones.
    float value = power * std::max(cos_emitted, smallest_cosine) * std::max(cos_received, smallest_cosine) /
                  std::max(std::max(d2, radius_squared), 1e-20f);
    // Not too large for two to be added; the comparison also catches NaN.
    constexpr float largest = 1e30f;
    return value < largest ? std::max(value, std::numeric_limits<float>::min()) : largest;
}

std::optional<LightTree::Found> LightTree::find(const LightReceiver& at, float u) const {
    if (nodes_.empty()) return std::nullopt;
    float probability = 1;
    std::uint32_t i = 0;
    while (!nodes_[i].is_leaf) {
        std::uint32_t second = nodes_[i].second;
        float a = nodes_[i + 1].importance(at), b = nodes_[second].importance(at);
        if (a + b == 0) return std::nullopt;
        // u is stretched over the child's part of the unit interval and used again.
        float to_first = a / (a + b);
        bool first = u < to_first;
        u = std::min(first ? u / to_first : (u - to_first) / (1 - to_first), one_minus_epsilon);
        probability *= (first ? a : b) / (a + b);
        i = first ? i + 1 : second;
    }
    if (i == 0 && nodes_[0].importance(at) == 0) return std::nullopt;
    return Found{nodes_[i].second, probability};
}

float LightTree::probability(const LightReceiver& at, std::uint32_t light) const {
    std::uint64_t trail = trails_[light];
    if (trail == not_in_tree) return 0;
    float probability = 1;
    std::uint32_t i = 0;
    for (; !nodes_[i].is_leaf; trail >>= 1) {
        std::uint32_t second = nodes_[i].second;
        float a = nodes_[i + 1].importance(at), b = nodes_[second].importance(at);
        bool first = (trail & 1) == 0;
        if ((first ? a : b) == 0) return 0;
        probability *= (first ? a : b) / (a + b);
        i = first ? i + 1 : second;
    }
    return i == 0 && nodes_[0].importance(at) == 0 ? 0 : probability;
}

} // namespace alhazen
