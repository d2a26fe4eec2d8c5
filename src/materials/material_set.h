/// The materials of a scene: by number as the description lists them, and by name.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "materials/material.h"

namespace alhazen {

class MaterialTables; // materials/material_tables.h

class MaterialSet {
  public:
    /// Makes what is built from here on matte (see forced_diffuse()).
    void force_diffuse() { is_diffuse_forced_ = true; }
    /// Builds every node (context.textures must be set), adding errors to the context. Mixtures may refer to
    /// any named material, also to later ones, but not to themselves through others. Duplicate names are
    /// errors. Sets context.materials to this set, which must then stay where it is.
    void build(const std::vector<Node>& nodes, BuildContext& context);

    /// nullptr for a material that had errors.
    const Material* at(std::size_t index) const { return list_[index].get(); }
    /// nullptr when there is none of that name (or it had errors, or is not built yet).
    const Material* find(const std::string& name) const;
    /// Whether a node of that name was given, even one with errors.
    bool has(const std::string& name) const { return by_name_.count(name) != 0; }
    std::vector<std::string> names() const;
    std::size_t size() const { return list_.size(); }
    /// What its materials share; nullptr before the first build, new with each.
    const std::shared_ptr<MaterialTables>& tables() const { return tables_; }

  private:
    class Builder;
    std::vector<std::unique_ptr<Material>> list_;
    std::unordered_map<std::string, std::size_t> by_name_;
    std::shared_ptr<MaterialTables> tables_;
    bool is_diffuse_forced_ = false;
};

/// For a material that is being built: the tables of context.materials, or of its own where it belongs to no
/// set.
std::shared_ptr<MaterialTables> shared_tables(const BuildContext& context);

} // namespace alhazen
