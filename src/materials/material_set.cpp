#include "materials/material_set.h"

#include <algorithm>

#include <fmt/format.h>

#include "describe/build_apart.h"
#include "materials/forced_diffuse.h"
#include "materials/material_tables.h"

namespace alhazen {

namespace {

/// What lenient loading makes of materials that are not known: the nearest in look.
struct Substitute {
    std::string_view unknown, known;
};
constexpr Substitute substitutes[] = {
    {"metal", "conductor"}, {"mirror", "conductor"}, {"glass", "dielectric"}};

std::string_view substitute_for(std::string_view type) {
    for (const Substitute& s : substitutes)
        if (s.unknown == type) return s.known;
    return "diffuse";
}

} // namespace

/// Builds materials at the same time, and then mixtures depth first: what a mixture mixes before the mixture.
class MaterialSet::Builder {
  public:
    Builder(MaterialSet& set, const std::vector<Node>& nodes, BuildContext& context)
        : set_(set), nodes_(nodes), context_(context), states_(nodes.size(), State::waiting) {}

    void run() {
        set_.list_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const Node& node = nodes_[i];
            if (node.name.empty() || set_.by_name_.emplace(node.name, i).second) continue;
            context_.messages.add_error(node.place,
                                        fmt::format("the material \"{}\" is already defined", node.name));
        }
        std::vector<std::size_t> plain;
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (nodes_[i].type != "mix") plain.push_back(i);
        build_apart(plain.size(), context_,
                    [&](std::size_t i, BuildContext& context) { make(plain[i], context); });
        for (std::size_t i = 0; i < nodes_.size(); ++i) build(i, 0);
    }

  private:
    enum class State { waiting, building, done };
    // Keeps the recursion here and in Material::choose small.
    static constexpr int max_nesting = 64;

    void build(std::size_t i, int depth) {
        if (states_[i] == State::done) return;
        states_[i] = State::building;
        if (build_parts(i, depth)) make(i, context_);
        states_[i] = State::done;
    }

    void make(std::size_t i, BuildContext& context) {
        auto material = material_kinds().make(nodes_[i], context, substitute_for(nodes_[i].type));
        // Mixtures find what they mix matte already.
        const bool is_wrapped = material && set_.is_diffuse_forced_ && nodes_[i].type != "mix";
        set_.list_[i] = is_wrapped ? forced_diffuse(std::move(material)) : std::move(material);
        states_[i] = State::done;
    }

    // False when a part cannot be built, which has been told.
    bool build_parts(std::size_t i, int depth) {
        const Node& node = nodes_[i];
        const Parameter* parts = node.type == "mix" ? node.find("materials") : nullptr;
        const auto* names = parts ? std::get_if<std::vector<std::string>>(&parts->values) : nullptr;
        if (!names) return true;
        bool all_built = true;
        for (const std::string& name : *names) {
            auto it = set_.by_name_.find(name);
            if (it == set_.by_name_.end()) continue; // told by the mixture itself
            if (states_[it->second] == State::building) {
                context_.messages.add_error(
                    parts->place,
                    fmt::format("the material \"{}\" is part of itself through \"{}\"", name, node.name));
                return false;
            }
            if (depth == max_nesting) {
                context_.messages.add_error(parts->place,
                                            fmt::format("mixtures are nested deeper than {}", max_nesting));
                return false;
            }
            build(it->second, depth + 1);
            all_built = all_built && set_.list_[it->second];
        }
        return all_built;
    }

    MaterialSet& set_;
    const std::vector<Node>& nodes_;
    BuildContext& context_;
    std::vector<State> states_;
};

void MaterialSet::build(const std::vector<Node>& nodes, BuildContext& context) {
    list_.clear();
    by_name_.clear();
    tables_ = std::make_shared<MaterialTables>();
    context.materials = this;
    Builder(*this, nodes, context).run();
}

const Material* MaterialSet::find(const std::string& name) const {
    auto it = by_name_.find(name);
    return it == by_name_.end() ? nullptr : list_[it->second].get();
}

std::vector<std::string> MaterialSet::names() const {
    std::vector<std::string> names;
    for (const auto& [name, index] : by_name_) names.push_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

std::shared_ptr<MaterialTables> shared_tables(const BuildContext& context) {
    return context.materials ? context.materials->tables() : std::make_shared<MaterialTables>();
}

} // namespace alhazen
