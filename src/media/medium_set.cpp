#include "media/medium_set.h"

#include <fmt/format.h>

namespace alhazen {

void MediumSet::build(std::vector<TextureNode>& nodes, BuildContext& context) {
    for (TextureNode& node : nodes) {
        if (node.world_from_texture.is_animated())
            context.messages.add_unsupported(node.node.place, "moving media are not supported",
                                             "the place at the start of the motion");
        context.world_from_node = Transform(node.world_from_texture.start);
        std::unique_ptr<Medium> medium = medium_kinds().make(node.node, context, "");
        node.node.parameters = {}; // grids are large, and have been read
        by_name_[node.node.name] = medium.get();
        if (medium) list_.push_back(std::move(medium));
    }
}

const Medium* MediumSet::find(const std::string& name, const Place& place, Messages& messages) const {
    if (name.empty()) return nullptr;
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [known_name, medium] : by_name_) known.push_back(known_name);
    std::sort(known.begin(), known.end());
    messages.add_error(place, fmt::format("no medium is named \"{}\"{}", name, did_you_mean(name, known)));
    return nullptr;
}

} // namespace alhazen
