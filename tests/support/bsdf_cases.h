/// Every registered material's examples as BSDFs, for tests that hold for all of them.
#pragma once

#include <unistd.h>

#include <string>
#include <vector>

#include "materials/material_set.h"
#include "tests/support/measured_file.h"
#include "textures/texture_set.h"

namespace alhazen::testing_support {

/// A BSDF and where it comes from.
struct BsdfCase {
    std::string name; ///< "dielectric / frosted"
    std::string kind, example;
    Bsdf* bsdf = nullptr;
    Bsdf* plain = nullptr; ///< from a hit without uv and tangents, where the material says it needs none
    std::vector<Bsdf*> elsewhere = {}; ///< of stochastic ones: the same, with other random numbers
};

/// Owns what the cases point to. Mixtures are seen at several points, so that both parts are among the cases;
/// narrow lobes come a second time, regularised.
class BsdfCases {
  public:
    explicit BsdfCases(ColorMode mode = ColorMode::spectral) {
        // Programs of several tests may run at once.
        const auto folder =
            std::filesystem::temp_directory_path() / ("alhazen-bsdf-cases-" + std::to_string(getpid()));
        write_measured_examples(folder);
        BuildContext context{messages_, mode, folder};
        textures_.build({}, context);
        for (const auto& kind : material_kinds().all())
            for (const Example& example : kind.doc().examples) add(kind.name, example, context);
        std::filesystem::remove_all(folder);
    }
    const std::vector<BsdfCase>& list() const { return cases_; }
    const Messages& messages() const { return messages_; }

    /// How often stochastic ones are there.
    static constexpr int places = 400;

  private:
    static Node node_of(std::string type, std::string name, std::vector<Parameter> parameters) {
        Node node;
        node.type = std::move(type);
        node.name = std::move(name);
        node.parameters = std::move(parameters);
        return node;
    }

    void add(const std::string& kind, const Example& example, BuildContext& context) {
        // What the mixtures' examples mix.
        std::vector<Node> nodes{node_of("diffuse", "first", {make_rgb("reflectance", 0.2f, 0.4f, 0.6f)}),
                                node_of("conductor", "second", {make_float("roughness", 0.3f)}),
                                node_of(kind, "example", example.parameters)};
        auto set = std::make_unique<MaterialSet>();
        set->build(nodes, context);
        const Material* material = set->find("example");
        sets_.push_back(std::move(set));
        if (!material || material->is_interface()) return;
        int points = kind == "mix" ? 3 : 1;
        for (int i = 0; i < points; ++i) {
            std::string name = kind + " / " + example.name;
            Bsdf* plain = nullptr;
            if (!material->needs_parameters()) plain = bsdf_at(*material, i, context.color_mode, false);
            BsdfCase c{name, kind, example.name, bsdf_at(*material, i, context.color_mode), plain};
            add_elsewhere(c, *material, context.color_mode, false);
            bool was_specular = has(c.bsdf->lobes(), Lobes::specular);
            cases_.push_back(std::move(c));
            c = {name + ", regularised", kind, example.name + ", regularised",
                 bsdf_at(*material, i, context.color_mode)};
            c.bsdf->regularize();
            add_elsewhere(c, *material, context.color_mode, true);
            if (was_specular && !has(c.bsdf->lobes(), Lobes::specular)) cases_.push_back(std::move(c));
        }
    }

    void add_elsewhere(BsdfCase& c, const Material& material, ColorMode mode, bool is_regularised) {
        for (int place = 1; c.bsdf->is_stochastic() && place <= places; ++place) {
            c.elsewhere.push_back(bsdf_at(material, place, mode));
            if (is_regularised) c.elsewhere.back()->regularize();
        }
    }

    Bsdf* bsdf_at(const Material& material, int point, ColorMode mode, bool with_parameters = true) {
        Hit hit;
        hit.p = Vec3(0.25f, 0.5f, -1.5f) * static_cast<float>(point + 1);
        hit.ng = hit.ns = {0, 0, 1};
        if (with_parameters) {
            hit.dpdu = {1, 0, 0};
            hit.dpdv = {0, 1, 0};
            hit.uv = {0.3f, 0.6f};
        }
        Wavelengths lambda =
            mode == ColorMode::spectral ? Wavelengths::sample_visible(0.37f) : Wavelengths::rgb();
        return material.at(hit, lambda, arena_);
    }

    Messages messages_;
    TextureSet textures_;
    std::vector<std::unique_ptr<MaterialSet>> sets_;
    Arena arena_;
    std::vector<BsdfCase> cases_;
};

} // namespace alhazen::testing_support
