/// How deep and how large things are that are made of others by name: textures of textures, bodies of bodies.
#pragma once

#include <algorithm>
#include <string>
#include <unordered_map>
#include <variant>

#include <fmt/format.h>

#include "describe/scene_description.h"

namespace alhazen {

/// What has been defined so far, by name. Building and evaluating follow names from one to the next, so that
/// depth is room on the stack, and size, in which what is named twice counts twice, is time.
class NestingGuard {
  public:
    static constexpr int max_depth = 256;
    static constexpr double max_size = 1e6;

    /// Counts the node and what its parameters of that type name; adds an error and returns false where that
    /// is too much. things: "textures", for the message.
    bool add(const Node& node, ValueType type, std::string_view things, Messages& messages) {
        Count count;
        for (const Parameter& p : node.parameters) {
            const auto* names = p.type == type ? std::get_if<std::vector<std::string>>(&p.values) : nullptr;
            if (!names) continue;
            for (const std::string& name : *names) {
                const auto found = counts_.find(name);
                if (found == counts_.end()) continue;
                count.depth = std::max(count.depth, found->second.depth + 1);
                count.size += found->second.size;
            }
        }
        if (count.depth > max_depth) {
            messages.add_error(node.place, fmt::format("{} are nested deeper than {}", things, max_depth));
            return false;
        }
        if (count.size > max_size) {
            messages.add_error(node.place,
                               fmt::format("\"{}\" is made of more than {:.0f} {}, those that are named "
                                           "again counted again; name fewer of them",
                                           node.name, max_size, things));
            return false;
        }
        Count& kept = counts_[node.name];
        kept = {std::max(kept.depth, count.depth), std::max(kept.size, count.size)};
        return true;
    }

  private:
    struct Count {
        int depth = 1;
        double size = 1;
    };
    std::unordered_map<std::string, Count> counts_;
};

} // namespace alhazen
