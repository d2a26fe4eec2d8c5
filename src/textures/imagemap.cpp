/// Pictures on surfaces. The texture coordinates' origin is the picture's lower left corner, as in pbrt-v4.
/// What a pixel covers decides how much of a picture is blended (see PixelCone).
#include <fmt/format.h>

#include "image/encoding.h"
#include "textures/image_cache.h"
#include "textures/mapping.h"
#include "textures/texture_node.h"

namespace alhazen {

template <>
struct EnumNames<WrapMode> {
    static constexpr std::array names{"repeat", "clamp", "black", "octahedralsphere"};
};
template <>
struct EnumNames<TexelFilter> {
    static constexpr std::array names{"point", "bilinear", "trilinear", "ewa"};
    static constexpr std::array other_names{std::pair{"EWA", "ewa"}};
};

namespace {

// The picture's parameters, the same for both families.
struct ImageMapFields : TextureMapping {
    std::string filename;
    WrapMode wrap = WrapMode::repeat;
    TexelFilter filter = TexelFilter::bilinear;
    float maxanisotropy = 8;
    std::string encoding = "auto";
    float scale = 1;
    bool invert = false;
    Vec2i size{0, 0}; ///< of the picture, once it has been read

    template <class T>
    static void describe_image(Fields<T>& f) {
        f.about("A picture from an image file: EXR, PNG, JPEG, HDR, TGA, BMP or PFM.");
        f.field("filename", &T::filename, "the image file, relative to the scene file").required();
        f.field("wrap", &T::wrap, "what lies beyond the picture's borders");
        f.field("filter", &T::filter,
                "how texels are blended: point takes one and bilinear four, from the level whose texels are "
                "as large as "
                "the pixel; trilinear blends two levels, ewa the ellipse that the pixel covers");
        f.field("maxanisotropy", &T::maxanisotropy, "ewa: greatest ratio of the footprint's axes").in(1, 256);
        f.field(
            "encoding", &T::encoding,
            "how an integer file's values stand for light: \"sRGB\", \"linear\", \"gamma\" and a number, or "
            "\"auto\" (sRGB for integer files); float files are linear");
        f.field("scale", &T::scale, "factor of the file's values");
        f.field("invert", &T::invert, "1 minus the value, after scaling");
        T::describe_mapping(f);
    }

    TexelPlace image_place(const TexturePoint& at) const {
        const Vec2 st = map(at);
        const TextureFootprint covered = footprint(at);
        return {{st.x, 1 - st.y},
                {covered.a.x, -covered.a.y},
                {covered.b.x, -covered.b.y},
                filter,
                maxanisotropy};
    }

    // Runs use(source, cache) once everything is known; what it throws is an error of the file.
    template <class Use>
    void read(const Node& node, BuildContext& context, Use use) {
        place(context);
        auto parsed = Encoding::parse(encoding);
        if (!parsed) {
            context.messages.add_error(
                node.place_of("encoding"),
                fmt::format("encoding \"{}\" is not known; it must be \"auto\", \"sRGB\", "
                            "\"linear\" or \"gamma\" and a positive number",
                            encoding));
            return;
        }
        ImageSource source{context.resolve(filename), *parsed, wrap};
        ImageCache own;
        bool is_shared = context.texture_use && context.texture_use->images;
        ImageCache& cache = is_shared ? *context.texture_use->images : own;
        try {
            auto picture = cache.image(source);
            size = {picture->width(), picture->height()};
            use(source, cache);
        } catch (const std::exception& e) {
            context.messages.add_error(node.place_of("filename"),
                                       fmt::format("image \"{}\": {}", source.path.string(), e.what()));
        }
    }
};

template <class Family>
struct ImageMap;

template <>
struct ImageMap<FloatNode> final : FloatNode, ImageMapFields {
    std::shared_ptr<const FloatTexels> texels;

    static void describe(Fields<ImageMap>& f) { describe_image(f); }
    void finish(const Node& node, BuildContext& context) {
        read(node, context,
             [&](const ImageSource& source, ImageCache& cache) { texels = cache.numbers(source); });
    }
    float eval(const TexturePoint& at) const override {
        const float v = texels->lookup(image_place(at));
        return invert ? std::max(0.0f, 1 - scale * v) : scale * v;
    }
    Vec2i image_size() const override { return size; }
};

template <>
struct ImageMap<SpectrumNode> final : SpectrumNode, ImageMapFields {
    std::shared_ptr<const ColorTexels> texels;

    static void describe(Fields<ImageMap>& f) { describe_image(f); }
    void finish(const Node& node, BuildContext& context) {
        read(node, context, [&](const ImageSource& source, ImageCache& cache) {
            TextureUse use = context.texture_use ? *context.texture_use : TextureUse{};
            if (!use.is_check) texels = cache.colors(source, {scale, invert}, use.role, context.color_mode);
        });
    }
    Spectrum eval(const TexturePoint& at, const Wavelengths& lambda) const override {
        return texels->lookup(image_place(at), lambda);
    }
    Vec2i image_size() const override { return size; }
};

} // namespace

Kind<FloatNode> imagemap_float_texture() {
    return make_kind<FloatNode, ImageMap<FloatNode>>("imagemap");
}
Kind<SpectrumNode> imagemap_spectrum_texture() {
    return make_kind<SpectrumNode, ImageMap<SpectrumNode>>("imagemap");
}

} // namespace alhazen
