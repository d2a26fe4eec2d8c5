/// No surface at all: only the border between two media.
#include "materials/material.h"

namespace alhazen {

namespace {

struct Interface final : Material {
    static void describe(Fields<Interface>& f) {
        f.about(
            "Light crosses the surface as if it were not there; it only parts the media on its two sides.");
        f.example("border", {});
    }
    Bsdf* at(const Hit&, Wavelengths&, Arena&) const override { return nullptr; }
    bool needs_parameters() const override { return false; }
    bool is_interface() const override { return true; }
};

} // namespace

Kind<Material> interface_material() {
    return make_kind<Material, Interface>("interface");
}

} // namespace alhazen
