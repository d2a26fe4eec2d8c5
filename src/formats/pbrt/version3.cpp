#include "formats/pbrt/version3.h"

#include <array>
#include <unordered_map>

#include <fmt/format.h>

namespace alhazen {

namespace {

constexpr std::array old_names{
    OldName{"directive", "", "WorldEnd", "", "the world ends where the file ends"},
    OldName{"directive", "", "SurfaceIntegrator", "Integrator", ""},
    OldName{"directive", "", "VolumeIntegrator", "Integrator", "\"volpath\" renders media"},
    OldName{"directive", "", "Renderer", "Integrator", ""},
    OldName{"directive", "", "Filter", "PixelFilter", ""},
    OldName{"directive", "", "Volume", "MakeNamedMedium", ""},
    OldName{"directive", "", "Interior", "MediumInterface", ""},
    OldName{"directive", "", "Exterior", "MediumInterface", ""},
    OldName{"parameter type", "", "color", "rgb", ""},
    OldName{"parameter type", "", "point", "point3", ""},
    OldName{"parameter type", "", "vector", "vector3", ""},
    OldName{"parameter type", "", "normal3", "normal", ""},
    OldName{"parameter type", "", "xyz", "", "give \"rgb\" or \"spectrum\""},
    OldName{"film", "", "image", "rgb", ""},
    OldName{"camera", "", "environment", "spherical", "with \"string mapping\" \"equirectangular\""},
    OldName{"sampler", "", "random", "independent", ""},
    OldName{"sampler", "", "lowdiscrepancy", "paddedsobol", ""},
    OldName{"sampler", "", "02sequence", "paddedsobol", ""},
    OldName{"sampler", "", "maxmindist", "pmj02bn", ""},
    OldName{"sampler", "", "bestcandidate", "pmj02bn", ""},
    OldName{"integrator", "", "directlighting", "path", "with \"integer maxdepth\" 1"},
    OldName{"accelerator", "", "grid", "bvh", ""},
    OldName{"medium", "", "heterogeneous", "uniformgrid", ""},
    OldName{"shape", "", "cone", "", "give it as a trianglemesh"},
    OldName{"shape", "", "paraboloid", "", "give it as a trianglemesh"},
    OldName{"shape", "", "hyperboloid", "", "give it as a trianglemesh"},
    OldName{"shape", "", "heightfield", "", "give it as a trianglemesh"},
    OldName{"shape", "", "nurbs", "", "give it as a bilinearmesh"},
    OldName{"material", "", "matte", "diffuse", "with \"reflectance\" for \"Kd\""},
    OldName{"material", "", "plastic", "coateddiffuse", "with \"reflectance\" for \"Kd\""},
    OldName{"material", "", "substrate", "coateddiffuse", "with \"reflectance\" for \"Kd\""},
    OldName{"material", "", "uber", "coateddiffuse", "with \"reflectance\" for \"Kd\""},
    OldName{"material", "", "disney", "coateddiffuse", "with \"reflectance\" for \"color\""},
    OldName{"material", "", "glass", "dielectric", ""},
    OldName{"material", "", "metal", "conductor", ""},
    OldName{"material", "", "mirror", "conductor", "with \"reflectance\" for \"Kr\""},
    OldName{"material", "", "shinymetal", "conductor", ""},
    OldName{"material", "", "translucent", "diffusetransmission", ""},
    OldName{"material", "", "fourier", "", "\"measured\" reads files of another format"},
    OldName{"material", "", "kdsubsurface", "subsurface", ""},
    OldName{"material", "", "none", "interface", ""},
    OldName{"material", "", "", "interface", ""},
    OldName{"parameter", "light", "mapname", "filename", ""},
    OldName{"parameter", "light", "samples", "", "lights take no sample counts"},
    OldName{"parameter", "light", "nsamples", "", "lights take no sample counts"},
    OldName{"parameter", "filter", "xwidth", "xradius", ""},
    OldName{"parameter", "filter", "ywidth", "yradius", ""},
    OldName{"parameter", "filter", "alpha", "sigma", "sigma = 1 / sqrt(2 alpha)"},
    OldName{"parameter", "film", "maxsampleluminance", "maxcomponentvalue", ""},
    OldName{"parameter", "film", "scale", "iso", "iso = 100 scale"},
    OldName{"parameter", "integrator", "lightsamplestrategy", "lightsampler", ""},
    OldName{"parameter", "integrator", "rrthreshold", "",
            "\"roulettethreshold\" is ours, with a default that suits"},
    OldName{"parameter", "material", "Kd", "reflectance", ""},
    OldName{"parameter", "material", "Kr", "reflectance", ""},
    OldName{"parameter", "material", "Kt", "transmittance", ""},
    OldName{"parameter", "material", "Ks", "", "the highlight follows from \"eta\" and \"roughness\""},
    OldName{"parameter", "material", "opacity", "", "give the shape an \"alpha\""},
    OldName{"parameter", "material", "bumpmap", "displacement", ""},
    OldName{"parameter", "material", "index", "eta", ""},
    OldName{"parameter", "texture", "trilinear", "", "give \"string filter\" \"trilinear\""},
    OldName{"parameter", "texture", "gamma", "encoding", "as in \"string encoding\" \"gamma 2.2\""}};

} // namespace

const OldName* find_old_name(std::string_view family, std::string_view kind, std::string_view name) {
    static const auto by_name = [] {
        std::unordered_multimap<std::string_view, const OldName*> map;
        for (const OldName& old : old_names) map.emplace(old.name, &old);
        return map;
    }();
    for (auto [at, end] = by_name.equal_range(name); at != end; ++at)
        if (at->second->family == family && at->second->kind == kind) return at->second;
    return nullptr;
}

std::string describe_old_name(const OldName& old) {
    std::string hint = old.hint.empty() ? "" : fmt::format("{}{}", old.now.empty() ? ": " : "; ", old.hint);
    if (old.now.empty())
        return fmt::format("{} \"{}\" is an older pbrt's; pbrt-v4 has nothing of that name{}", old.family,
                           old.name, hint);
    return fmt::format("{} \"{}\" is an older pbrt's name; pbrt-v4 calls it \"{}\"{}", old.family, old.name,
                       old.now, hint);
}

std::string_view stand_in_for(const OldName& old) {
    return old.now.empty() && old.family == "material" ? "diffuse" : old.now;
}

Remedy remedy_for(const OldName& old) {
    const std::string_view other = stand_in_for(old);
    return other.empty() ? Remedy::leave_out() : Remedy::use(fmt::format("\"{}\"", other));
}

} // namespace alhazen
