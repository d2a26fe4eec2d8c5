/// The named textures of a scene, built in the order in which the scene gives them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "textures/texture.h"
#include "textures/texture_memory.h"

namespace alhazen {

const KindList<FloatNode>& float_texture_kinds();
const KindList<SpectrumNode>& spectrum_texture_kinds();

class ImageCache; // textures/image_cache.h

/// What a texture is being built for: BuildContext::texture_use while TextureSet builds.
struct TextureUse {
    /// What the rgb values of a spectrum texture mean.
    SpectrumRole role = SpectrumRole::unbounded;
    /// Images and tables that textures share.
    ImageCache* images = nullptr;
    /// The node is wanted for its errors only; it need not make tables.
    bool is_check = false;
};

/// Textures by name. Every spectrum texture is checked when the set is built, but made for a role only when
/// it is first asked for in that role, since its rgb values mean different spectra in each and images take
/// room. find_* may be called from several threads.
class TextureSet {
  public:
    TextureSet();
    ~TextureSet();
    TextureSet(TextureSet&&) noexcept;
    TextureSet& operator=(TextureSet&&) noexcept;

    /// Keeps at most that many bytes of the texels of images in memory, to be called before build: they lie
    /// in a temporary file, in tiles that are read when they are looked up. Does not change them.
    void limit_memory(std::size_t bytes);
    /// Builds every node, adding errors to the context; later textures may refer to earlier ones. Duplicate
    /// names of one kind are errors. Sets context.textures to this set.
    void build(const std::vector<TextureNode>& nodes, BuildContext& context);
    /// Frees images that only further roles would need; to be called when the scene is complete.
    void forget_images();

    /// nullptr when there is none of that name, or it had errors.
    std::shared_ptr<const FloatNode> find_float(const std::string& name) const;
    /// The same; errors of this role (a reflectance above 1) are added to messages, if given.
    std::shared_ptr<const SpectrumNode> find_spectrum(const std::string& name, SpectrumRole role,
                                                      Messages* messages = nullptr) const;
    /// Whether a node of that name was given, even one with errors.
    bool has_float(const std::string& name) const;
    bool has_spectrum(const std::string& name) const;
    /// The size (pixels) of the image that the texture of that name shows (of the float texture, when there
    /// are both); nullopt when it shows none.
    std::optional<Vec2i> image_size(const std::string& name) const;
    /// Memory of images and tables, each counted once however many textures share it.
    std::size_t bytes() const;
    TextureMemory memory() const;
    /// Throws std::runtime_error if texels could not be read while they were looked up, and were zero.
    void throw_if_failed() const;
    /// Sorted.
    std::vector<std::string> float_names() const;
    std::vector<std::string> spectrum_names() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace alhazen
