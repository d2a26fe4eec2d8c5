/// Textures: values that vary over surfaces. Materials, shapes and lights hold FloatTexture and
/// SpectrumTexture members; a plain number or colour in the scene is a texture that does not vary, and costs
/// no virtual call.
#pragma once

#include <memory>
#include <string>

#include "base/hit.h"
#include "color/spectrum_value.h"
#include "color/wavelengths.h"
#include "describe/field_types.h"
#include "describe/kind.h"

namespace alhazen {

/// Where a texture is looked up.
struct TexturePoint {
    Vec3 p;  ///< world space
    Vec3 ng; ///< geometric normal, world space
    Vec2 uv;
    const Hit* hit = nullptr; ///< must live as long; nullptr where the point is all that is known

    explicit TexturePoint(const Hit& hit_) : p(hit_.p), ng(hit_.ng), uv(hit_.uv), hit(&hit_) {}
    TexturePoint(Vec3 p_, Vec3 ng_, Vec2 uv_) : p(p_), ng(ng_), uv(uv_) {}
};

/// A texture node of numbers. Immutable once built; eval may be called from any thread.
struct FloatNode {
    static constexpr std::string_view family_name = "float texture";
    virtual ~FloatNode() = default;
    virtual float eval(const TexturePoint&) const = 0;
    /// Upper bound of |eval|; infinity when not known.
    virtual float max_value() const { return infinity; }
    /// Width and height (pixels) of the image it shows; zero when it shows none.
    virtual Vec2i image_size() const { return {0, 0}; }
};

/// A texture node of colours.
struct SpectrumNode {
    static constexpr std::string_view family_name = "spectrum texture";
    virtual ~SpectrumNode() = default;
    virtual Spectrum eval(const TexturePoint&, const Wavelengths&) const = 0;
    /// Width and height (pixels) of the image it shows; zero when it shows none.
    virtual Vec2i image_size() const { return {0, 0}; }
};

/// A number that may vary over a surface: a constant, or a node.
class FloatTexture {
  public:
    FloatTexture(float value = 0) : value_(value) {}
    explicit FloatTexture(std::shared_ptr<const FloatNode> node) : node_(std::move(node)) {}

    float eval(const TexturePoint& at) const { return node_ ? node_->eval(at) : value_; }
    bool is_constant() const { return !node_; }
    float constant() const { return value_; }
    float max_value() const { return node_ ? node_->max_value() : value_; }

  private:
    float value_ = 0;
    std::shared_ptr<const FloatNode> node_;
};

/// A colour that may vary over a surface: a constant, or a node.
class SpectrumTexture {
  public:
    SpectrumTexture(float grey = 0) : value_(SpectrumValue::constant(grey)), grey_(grey) {}
    explicit SpectrumTexture(SpectrumValue value) : value_(std::move(value)), grey_(-1) {}
    explicit SpectrumTexture(std::shared_ptr<const SpectrumNode> node) : grey_(-1), node_(std::move(node)) {}

    Spectrum eval(const TexturePoint& at, const Wavelengths& lambda) const {
        return node_ ? node_->eval(at, lambda) : value_.eval(lambda);
    }
    bool is_constant() const { return !node_; }
    const SpectrumValue& constant() const { return value_; }
    /// The manual's text of a default: a number where it is grey.
    std::string text() const { return grey_ >= 0 ? number_text(static_cast<double>(grey_)) : "..."; }

  private:
    SpectrumValue value_ = SpectrumValue::constant(0);
    float grey_ = 0;
    std::shared_ptr<const SpectrumNode> node_;
};

/// A SpectrumTexture whose rgb values mean what role says: reflectances (albedo), any positive quantity
/// (unbounded), or light (illuminant).
template <SpectrumRole role>
struct RoleTexture : SpectrumTexture {
    using SpectrumTexture::SpectrumTexture;
};
using AlbedoTexture = RoleTexture<SpectrumRole::albedo>;
using UnboundedTexture = RoleTexture<SpectrumRole::unbounded>;
using IlluminantTexture = RoleTexture<SpectrumRole::illuminant>;

void read_float_texture(FloatTexture& out, const Parameter& p, BuildContext& context);
void read_spectrum_texture(SpectrumTexture& out, const Parameter& p, SpectrumRole role,
                           BuildContext& context);

template <>
struct FieldType<FloatTexture> {
    static std::string type_text() { return "float | texture"; }
    static std::string default_text(const FloatTexture& v) {
        return number_text(static_cast<double>(v.constant()));
    }
    static void read(FloatTexture& out, const Parameter& p, BuildContext& context) {
        read_float_texture(out, p, context);
    }
};

template <SpectrumRole role>
struct FieldType<RoleTexture<role>> {
    static std::string type_text() { return "rgb | spectrum | blackbody | float | texture"; }
    static std::string default_text(const RoleTexture<role>& v) { return v.text(); }
    static void read(RoleTexture<role>& out, const Parameter& p, BuildContext& context) {
        read_spectrum_texture(out, p, role, context);
    }
};

} // namespace alhazen
