/// Fine relief that a material gives to a surface without moving it: bumps of a height texture (Blinn 1978,
/// "Simulation of wrinkled surfaces"), or the normals of a normal map (Cohen, Olano and Manocha 1998;
/// Pharr et al. 2023, section 10.5.3). Only the shading normal and the tangents turn; what rays meet and how
/// they leave stays the geometry's.
#pragma once

#include <memory>
#include <optional>

#include "image/pyramid.h"
#include "textures/texture.h"

namespace alhazen {

/// An image of normals in the frame of the surface, (0, 0, 1) pointing out: a channel of 0 stands for -1, of
/// 1 for
/// 1. Repeats.
class NormalMap {
  public:
    NormalMap() = default;
    /// Throws std::runtime_error when the file cannot be read or has no colours.
    explicit NormalMap(const std::filesystem::path& path);

    bool empty() const { return !normals_; }
    /// Not zero, unit length.
    Vec3 at(Vec2 uv) const;

  private:
    std::shared_ptr<const Pyramid<Vec3>> normals_;
};

template <>
struct FieldType<NormalMap> {
    static std::string type_text() { return "string"; }
    static std::string default_text(const NormalMap&) { return "none"; }
    static void read(NormalMap& out, const Parameter& p, BuildContext& context);
};

/// A part of materials.
struct Relief {
    FloatTexture displacement{0};
    NormalMap normalmap;

    template <class T>
    static void describe(Fields<T>& f) {
        f.field("displacement", &T::relief, &Relief::displacement,
                "height of bumps above the surface, which only turn the shading normal");
        f.field("normalmap", &T::relief, &Relief::normalmap,
                "image file of shading normals, instead of bumps; red along u, green along v, blue out");
    }

    bool is_flat() const { return displacement.is_constant() && normalmap.empty(); }
    /// Turns the hit's shading normal and tangents; change says how the normal of the smooth surface does.
    void apply(Hit& hit, const NormalChange& change) const;
};

} // namespace alhazen
