#include "sdf/sdf_set.h"

#include <fmt/format.h>

#include "describe/nesting.h"

namespace alhazen {

void SdfSet::build(const std::vector<TextureNode>& nodes, BuildContext& context) {
    context.sdfs = this;
    nodes_.clear();
    NestingGuard nesting;
    for (const TextureNode& description : nodes) {
        const Node& node = description.node;
        const Motion& motion = description.world_from_texture;
        if (has(node.name)) {
            context.messages.add_error(node.place,
                                       fmt::format("the sdf \"{}\" is already defined", node.name));
            continue;
        }
        if (motion.is_animated())
            context.messages.add_unsupported(node.place, "moving sdfs are not supported yet",
                                             "the place at the start of the motion");
        std::shared_ptr<const Sdf> sdf;
        if (nesting.add(node, ValueType::string, "sdfs", context.messages))
            sdf = sdf_kinds().make(node, context, "");
        nodes_[node.name] = sdf ? std::make_shared<const PlacedSdf>(sdf, motion.start) : nullptr;
    }
}

std::shared_ptr<const PlacedSdf> SdfSet::find(const std::string& name) const {
    auto it = nodes_.find(name);
    return it == nodes_.end() ? nullptr : it->second;
}

std::vector<std::string> SdfSet::names() const {
    std::vector<std::string> names;
    for (const auto& [name, node] : nodes_) names.push_back(name);
    return names;
}

} // namespace alhazen
