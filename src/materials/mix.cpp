/// Two materials sprinkled over one surface: each point shows one of them, chosen by a hash of its position,
/// so that the mean over a pixel is the mixture (as pbrt-v4, but by the position alone: the same point shows
/// the same material from every side). Who looks but once a pixel asks for all shares.
#include <bit>

#include <fmt/format.h>

#include "base/hash.h"
#include "materials/material_set.h"

namespace alhazen {

namespace {

std::uint64_t hash_text(std::string_view text) {
    std::uint64_t h = 0;
    for (char c : text) h = hash_of(h, static_cast<unsigned char>(c));
    return h;
}

struct Mix final : Material {
    FloatTexture amount{0.5f};
    std::vector<std::string> materials;
    const Material* first = nullptr;
    const Material* second = nullptr;
    std::uint64_t salt = 0; ///< mixtures of mixtures must not all choose alike

    /// What holds of one of the two, or of both; found once, since mixtures may share much of what they mix.
    struct Parts {
        bool need_parameters = true, have_relief = false, have_subsurface = false;
        bool are_interfaces = false, may_be_interfaces = false;
    } parts;

    static void describe(Fields<Mix>& f) {
        f.about("Shows one of two materials at each point, at random.");
        f.field("materials", &Mix::materials, "names of the two materials").required();
        f.field("amount", &Mix::amount, "fraction of the second material").in(0, 1);
        f.example("half and half", {two_materials("first", "second")});
        f.example("a little", {two_materials("first", "second"), make_float("amount", 0.1f)});
    }
    static Parameter two_materials(std::string a, std::string b) {
        return make_array<std::string>("materials", ValueType::string, {std::move(a), std::move(b)});
    }

    void finish(const Node& node, BuildContext& context) {
        const Parameter& p = *node.find("materials");
        if (materials.size() != 2) {
            report_wrong_count(p, "two names of materials", context);
            return;
        }
        first = find(materials[0], p, context);
        second = find(materials[1], p, context);
        salt = hash_of(hash_text(materials[0]), hash_text(materials[1]));
        if (!first || !second) return;
        parts.need_parameters =
            !amount.is_constant() || first->needs_parameters() || second->needs_parameters();
        parts.have_relief = first->has_relief() || second->has_relief();
        parts.have_subsurface = first->has_subsurface() || second->has_subsurface();
        parts.are_interfaces = first->is_interface() && second->is_interface();
        parts.may_be_interfaces = first->may_be_interface() || second->may_be_interface();
    }

    static const Material* find(const std::string& name, const Parameter& p, BuildContext& context) {
        const Material* found = context.materials ? context.materials->find(name) : nullptr;
        if (!found) {
            std::vector<std::string> known;
            if (context.materials) known = context.materials->names();
            context.messages.add_error(p.place,
                                       fmt::format("parameter \"materials\" refers to the material \"{}\", "
                                                   "which is not defined{}",
                                                   name, did_you_mean(name, known)));
        }
        return found;
    }

    const Material* choose(const Hit& hit) const override {
        float t = amount.eval(TexturePoint(hit));
        auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
        float u = unit_float(hash_of(salt, bits(hit.p.x), bits(hit.p.y), bits(hit.p.z)));
        return (u < t ? second : first)->choose(hit);
    }
    bool is_mixture() const override { return true; }
    // Mixtures of mixtures may have more parts than could be counted: below a 64th one is chosen.
    void add_shares(const Hit& hit, float share, std::vector<MaterialShare>& shares) const override {
        if (!(share >= 1.0f / 64)) return shares.push_back({choose(hit), share});
        const float t = amount.eval(TexturePoint(hit));
        const float of_second = t >= 1 ? share : t > 0 ? share * t : 0;
        if (of_second < share) first->add_shares(hit, share - of_second, shares);
        if (of_second > 0) second->add_shares(hit, of_second, shares);
    }
    bool needs_parameters() const override { return parts.need_parameters; }
    bool has_relief() const override { return parts.have_relief; }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        return choose(hit)->at(hit, lambda, arena);
    }
    const Bssrdf* subsurface(const Hit& hit, const Wavelengths& lambda, Arena& arena) const override {
        return choose(hit)->subsurface(hit, lambda, arena);
    }
    bool has_subsurface() const override { return parts.have_subsurface; }
    bool is_interface() const override { return parts.are_interfaces; }
    bool may_be_interface() const override { return parts.may_be_interfaces; }
};

} // namespace

Kind<Material> mix_material() {
    return make_kind<Material, Mix>("mix");
}

} // namespace alhazen
