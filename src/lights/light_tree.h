/// A tree over lights in which a light is found by walking from the root, taking at each node the child that
/// promises more light with proportionally higher probability (Conty Estevez and Kulla 2018, "Importance
/// sampling of many lights with adaptive tree splitting"; Pharr et al. 2023, section 12.6.3). Picture a box
/// around a group of lamps with an arrow for where they shine: how much it may give a point is known without
/// looking inside.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lights/light.h"

namespace alhazen {

/// A group of lights while the tree is built; angles instead of cosines, so that merging does not lose
/// digits.
struct LightGroup {
    Bounds3 bounds;
    Vec3 axis{0, 0, 1};
    float normal_angle = 0;  ///< half angle of the cone that holds the emitting normals
    float falloff_angle = 0; ///< how far from its normal a point still emits
    float power = 0;
    bool two_sided = false;

    LightGroup() = default;
    explicit LightGroup(const LightBounds& b);
    /// Contains the other group too; an empty group has empty bounds.
    void merge(const LightGroup& other);
    /// The cost measure of Conty Estevez and Kulla 2018, equation 1: surface area times the solid angle that
    /// is shone into, times power.
    float cost() const;
};

class LightTree {
  public:
    /// Light i of the caller has bounds[i]; those without power are left out and never found.
    explicit LightTree(std::span<const LightBounds> bounds);

    bool empty() const { return nodes_.empty(); }
    struct Found {
        std::uint32_t light = 0;
        float probability = 0;
    };
    /// u in [0, 1). nullopt when no light can reach the receiver, or none on the way that was taken.
    std::optional<Found> find(const LightReceiver& at, float u) const;
    /// The probability with which find() returns the light.
    float probability(const LightReceiver& at, std::uint32_t light) const;

  private:
    /// Two groups side by side, as importance asks for them. Each box is kept as the sphere around it.
    struct Pair {
        using Two = std::array<float, 2>;
        std::array<Two, 3> center{}, axis{};
        Two radius_squared{}, cos_normals{}, sin_normals{}, cos_falloff{}, power{};
        std::array<int, 2> two_sided{}; ///< -1 or 0, as lanes have it

        void set(std::size_t i, const LightGroup& group);
        /// Upper bounds, up to a common factor, of what the groups give the receiver.
        Two importance(const LightReceiver& at) const;
    };
    /// 128 bytes: two cache lines.
    struct alignas(64) Node {
        Pair children;
        std::uint32_t second = 0; ///< second child (the first follows its parent); in a leaf, the light
        bool is_leaf = false;
    };
    struct Item {
        LightGroup group;
        Vec3 centroid;
        std::uint32_t light;
    };

    LightGroup build(std::span<Item> items, std::uint64_t trail, int depth);
    /// A lone light may be out of the receiver's sight, too.
    bool is_unlit_by_all(const LightReceiver& at) const {
        return nodes_[0].is_leaf && all_.importance(at)[0] == 0;
    }

    static constexpr std::uint64_t not_in_tree = ~std::uint64_t{0};
    std::vector<Node> nodes_;
    Pair all_; ///< of both, all lights
    /// Of each light, which child to take at each level, lowest bit first.
    std::vector<std::uint64_t> trails_;
};

} // namespace alhazen
