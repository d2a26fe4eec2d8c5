#include "materials/forced_diffuse.h"

#include <bit>

#include "base/hash.h"
#include "materials/albedo.h"
#include "materials/diffuse_bsdf.h"

namespace alhazen {

namespace {

/// Three numbers in [0, 1) that are the same for the same place and direction.
Vec3 random_of(const Hit& hit) {
    auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    const std::uint64_t place = hash_of(bits(hit.p.x), bits(hit.p.y), bits(hit.p.z)),
                        seed = hash_of(place, bits(hit.wo.x), bits(hit.wo.y), bits(hit.wo.z));
    return {unit_float(hash_of(seed, 0)), unit_float(hash_of(seed, 1)), unit_float(hash_of(seed, 2))};
}

struct ForcedDiffuse final : Material {
    std::unique_ptr<Material> original;

    explicit ForcedDiffuse(std::unique_ptr<Material> material) : original(std::move(material)) {
        relief = original->relief;
    }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        const Bsdf* bsdf = original->at(hit, lambda, arena);
        if (!bsdf) return nullptr;
        // Few, as errors of one hit are not those of the next.
        constexpr int samples = 4;
        return arena.make<DiffuseBsdf>(albedo_of(*bsdf, hit.shading_frame().to_local(hit.wo), samples,
                                                 TransportMode::radiance, random_of(hit)));
    }
    bool needs_parameters() const override { return original->needs_parameters(); }
    bool is_interface() const override { return original->is_interface(); }
};

} // namespace

std::unique_ptr<Material> forced_diffuse(std::unique_ptr<Material> material) {
    return std::make_unique<ForcedDiffuse>(std::move(material));
}

} // namespace alhazen
