/// The named signed distance fields of a scene, built in the order in which the scene gives them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "describe/scene_description.h"
#include "sdf/placed_sdf.h"

namespace alhazen {

class SdfSet {
  public:
    /// Builds every node, adding errors to the context; operators may refer to nodes before them. Each node
    /// is seen from its parent through the transformation it was given with. Sets context.sdfs to this set,
    /// which must stay where it is.
    void build(const std::vector<TextureNode>& nodes, BuildContext& context);

    /// nullptr when there is none of that name, or it had errors.
    std::shared_ptr<const PlacedSdf> find(const std::string& name) const;
    /// Whether a node of that name was given, even one with errors.
    bool has(const std::string& name) const { return nodes_.count(name) != 0; }
    /// Sorted.
    std::vector<std::string> names() const;

  private:
    std::map<std::string, std::shared_ptr<const PlacedSdf>> nodes_;
};

} // namespace alhazen
