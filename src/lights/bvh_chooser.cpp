/// Lights by what they may give the receiver: those with a place through a tree (see LightTree), infinitely
/// distant ones each with the same probability as the whole tree (Pharr et al. 2023, section 12.6.3).
#include "lights/light_chooser.h"
#include "lights/light_index.h"
#include "lights/light_tree.h"

namespace alhazen {
namespace {

std::vector<LightBounds> bounds_of(std::span<const Light* const> lights) {
    std::vector<LightBounds> all;
    all.reserve(lights.size());
    // Lights without bounds get empty ones, which the tree leaves out.
    for (const Light* light : lights) all.push_back(light->bounds().value_or(LightBounds{}));
    return all;
}

class BvhChooser final : public LightChooser {
  public:
    explicit BvhChooser(std::span<const Light* const> lights)
        : lights_(lights.begin(), lights.end()), index_(lights), tree_(bounds_of(lights)) {
        is_unbounded_.reserve(lights.size());
        for (const Light* light : lights) {
            is_unbounded_.push_back(!light->bounds());
            if (is_unbounded_.back()) unbounded_.push_back(light);
        }
        std::size_t choices = unbounded_.size() + (tree_.empty() ? 0 : 1);
        each_ = choices == 0 ? 0 : 1 / static_cast<float>(choices);
        all_unbounded_ = tree_.empty() ? 1 : each_ * static_cast<float>(unbounded_.size());
    }

    std::optional<ChosenLight> choose(const LightReceiver& at, float u) const override {
        if (!unbounded_.empty() && u < all_unbounded_) {
            auto i = static_cast<std::size_t>(static_cast<double>(u) / static_cast<double>(each_));
            return ChosenLight{unbounded_[std::min(i, unbounded_.size() - 1)], each_};
        }
        if (tree_.empty()) return std::nullopt;
        u = std::min((u - all_unbounded_) / (1 - all_unbounded_), one_minus_epsilon);
        auto found = tree_.find(at, u);
        if (!found) return std::nullopt;
        return ChosenLight{lights_[found->light], found->probability * each_};
    }
    float probability(const LightReceiver& at, const Light* light) const override {
        auto i = index_.find(light);
        if (!i) return 0;
        return is_unbounded_[*i] ? each_ : tree_.probability(at, *i) * each_;
    }

  private:
    std::vector<const Light*> lights_, unbounded_;
    std::vector<bool> is_unbounded_;
    LightIndex index_;
    LightTree tree_;
    float each_ = 0;          ///< probability of one unbounded light, and of the tree
    float all_unbounded_ = 0; ///< of any of the unbounded ones
};

} // namespace

std::unique_ptr<LightChooser> bvh_light_chooser(std::span<const Light* const> lights) {
    return std::make_unique<BvhChooser>(lights);
}

} // namespace alhazen
