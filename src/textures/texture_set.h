/// The named textures of a scene, built in the order in which the scene gives them.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>

#include "textures/texture.h"

namespace alhazen {

const KindList<FloatNode>& float_texture_kinds();
const KindList<SpectrumNode>& spectrum_texture_kinds();

/// Textures by name. A spectrum texture is built once for each role it is used in, when it is first used, since
/// its rgb values mean different spectra in each.
class TextureSet {
  public:
    /// Builds every node, adding errors to the context; later textures may refer to earlier ones. Duplicate names
    /// of one kind are errors.
    void build(const std::vector<TextureNode>& nodes, BuildContext& context);

    /// nullptr when there is none of that name.
    std::shared_ptr<const FloatNode> find_float(const std::string& name) const;
    std::shared_ptr<const SpectrumNode> find_spectrum(const std::string& name, SpectrumRole role) const;
    std::vector<std::string> float_names() const;
    std::vector<std::string> spectrum_names() const;

  private:
    struct SpectrumRoles {
        std::shared_ptr<const SpectrumNode> by_role[3];
    };
    std::unordered_map<std::string, std::shared_ptr<const FloatNode>> floats_;
    std::unordered_map<std::string, SpectrumRoles> spectra_;
};

} // namespace alhazen
