#include "materials/metal.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

UnboundedTexture copper(std::string_view part) {
    const SpectralCurve* curve = named_spectrum("metal-Cu-" + std::string(part));
    return UnboundedTexture(SpectrumValue::curve(*curve, SpectrumRole::unbounded));
}

} // namespace

void MetalColor::finish(const Node& node, BuildContext& context, std::string_view prefix) {
    if (reflectance && (eta || k)) {
        context.messages.add_error(
            node.place,
            fmt::format(
                "material \"{}\" has both \"reflectance\" and \"{}eta\" or \"{}k\"; only one can be given",
                node.type, prefix, prefix));
        return;
    }
    if (!reflectance && !eta) eta = copper("eta");
    if (!reflectance && !k) k = copper("k");
}

bool MetalColor::varies() const {
    auto texture_varies = [](const auto& texture) { return texture && !texture->is_constant(); };
    return texture_varies(eta) || texture_varies(k) || texture_varies(reflectance);
}

MetalIndex MetalColor::index(const TexturePoint& at, const Wavelengths& lambda) const {
    if (!reflectance) return {eta->eval(at, lambda), k->eval(at, lambda)};
    // With eta = 1 the reflectance at normal incidence is k^2 / (k^2 + 4), solved for k (as pbrt-v4). It must
    // stay below 1, where k is infinite.
    Spectrum r = clamp(reflectance->eval(at, lambda), 0, 0.9999f);
    return {1, 2 * sqrt(r) / sqrt(1 - r)};
}

} // namespace alhazen
