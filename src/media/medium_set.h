/// The media of a scene, by name.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "describe/scene_description.h"
#include "media/medium.h"

namespace alhazen {

class MediumSet {
  public:
    /// Builds every node, adding errors to the context.
    void build(std::vector<TextureNode>& nodes, BuildContext& context);

    /// nullptr for the name "", which is no medium, and, with an error added, for one that is not known.
    const Medium* find(const std::string& name, const Place& place, Messages& messages) const;
    bool empty() const { return list_.empty(); }

  private:
    std::vector<std::unique_ptr<Medium>> list_;
    std::unordered_map<std::string, const Medium*> by_name_; ///< nullptr: it had errors
};

} // namespace alhazen
