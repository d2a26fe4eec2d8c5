/// From a light to its number among the scene's lights.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>

#include "lights/light.h"

namespace alhazen {

class LightIndex {
  public:
    explicit LightIndex(std::span<const Light* const> lights) {
        numbers_.reserve(lights.size());
        for (std::uint32_t i = 0; i < lights.size(); ++i) numbers_.emplace(lights[i], i);
    }
    /// nullopt for a light that is not one of them.
    std::optional<std::uint32_t> find(const Light* light) const {
        auto it = numbers_.find(light);
        if (it == numbers_.end()) return std::nullopt;
        return it->second;
    }

  private:
    std::unordered_map<const Light*, std::uint32_t> numbers_;
};

} // namespace alhazen
