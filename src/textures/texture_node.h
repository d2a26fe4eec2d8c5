/// What texture nodes of numbers and of colours have in common, so that each texture is written once. A
/// texture is a template over its family; its value(at, lambda...) takes wavelengths when it is of colours:
///
///     template <class Family>
///     struct Mix final : TextureNodeOf<Family, Mix<Family>> {
///         TextureInput<Family> tex1{0}, tex2{1};
///         template <class... Lambda>
///         TextureValue<Family> value(const TexturePoint& at, const Lambda&... lambda) const;
#pragma once

#include "textures/texture_set.h"

namespace alhazen {

/// A colour among a texture's parameters: its rgb values mean what the texture is used for.
struct InheritedTexture : SpectrumTexture {
    using SpectrumTexture::SpectrumTexture;
};

template <>
struct FieldType<InheritedTexture> {
    static std::string type_text() { return FieldType<AlbedoTexture>::type_text(); }
    static std::string default_text(const InheritedTexture& v) { return v.text(); }
    static void read(InheritedTexture& out, const Parameter& p, BuildContext& context) {
        SpectrumRole role = context.texture_use ? context.texture_use->role : SpectrumRole::unbounded;
        read_spectrum_texture(out, p, role, context);
    }
};

template <class Family, class Texture>
struct TextureNodeOf;

template <class Texture>
struct TextureNodeOf<FloatNode, Texture> : FloatNode {
    float eval(const TexturePoint& at) const final { return static_cast<const Texture*>(this)->value(at); }
};
template <class Texture>
struct TextureNodeOf<SpectrumNode, Texture> : SpectrumNode {
    Spectrum eval(const TexturePoint& at, const Wavelengths& lambda) const final {
        return static_cast<const Texture*>(this)->value(at, lambda);
    }
};

template <class Family>
inline constexpr bool is_float_family = std::is_same_v<Family, FloatNode>;
template <class Family>
using TextureInput = std::conditional_t<is_float_family<Family>, FloatTexture, InheritedTexture>;
template <class Family>
using TextureValue = std::conditional_t<is_float_family<Family>, float, Spectrum>;

} // namespace alhazen
