/// A box of samples of coloured matter (Pharr et al. 2023, section 11.4.4).
#include <fmt/format.h>

#include "color/upsample.h"
#include "media/box_medium.h"
#include "media/medium_fields.h"
#include "media/sampled_grid.h"

namespace alhazen {

namespace {

/// A colour of any strength, small: one a cell.
struct CellColor {
    Vec3 rgb;
    float strength = 0; ///< of the spectrum
    SigmoidCoefficients sigmoid;

    Spectrum eval(const Wavelengths& lambda) const {
        if (lambda.mode == ColorMode::rgb) return {rgb.x, rgb.y, rgb.z, (rgb.x + rgb.y + rgb.z) / 3};
        return strength > 0 ? strength * sigmoid.eval(lambda.lambda) : Spectrum(0);
    }
    float largest() const { return std::max(max_component(rgb), strength * sigmoid.max_value()); }
};

std::vector<CellColor> cell_colors(const RgbColorSpace& space, const std::vector<float>& components) {
    std::vector<CellColor> cells(components.size() / 3);
    std::vector<Vec3> halves(cells.size());
    const Matrix3 to_srgb = convert_rgb(space, srgb_space());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Vec3 rgb{components[3 * i], components[3 * i + 1], components[3 * i + 2]};
        cells[i].rgb = max(to_srgb * rgb, Vec3(0));
        cells[i].strength = 2 * max_component(rgb);
        if (cells[i].strength > 0) halves[i] = rgb / cells[i].strength;
    }
    std::vector<SigmoidCoefficients> sigmoids(cells.size());
    upsample(space, halves, sigmoids);
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i].sigmoid = sigmoids[i];
    return cells;
}

struct RgbGrid final : BoxMedium, GridSides {
    std::vector<float> sigma_a, sigma_s, Le;
    float Lescale = 1;

    static void describe(Fields<RgbGrid>& f) {
        f.about("Matter whose absorption, scattering and glow are given as colours at the centres of the "
                "cells of a box.");
        describe_sides(f);
        f.field("sigma_a", &RgbGrid::sigma_a,
                "nx ny nz colours (rgb), x running fastest: how much light is absorbed per length")
            .at_least(0)
            .otherwise("1 everywhere");
        f.field("sigma_s", &RgbGrid::sigma_s,
                "nx ny nz colours (rgb): how much light is scattered per length")
            .at_least(0)
            .otherwise("1 everywhere");
        f.field("Le", &RgbGrid::Le, "nx ny nz colours (rgb) of what is emitted by what absorbs").at_least(0);
        f.field("Lescale", &RgbGrid::Lescale,
                "factor on Le; as in pbrt-v4, white of Le 1 has the colour space's illuminant as its "
                "spectrum, not divided by its luminance")
            .at_least(0);
        describe_box(f);
        auto colors = [](std::string name, std::vector<float> v) {
            return make_array<float>(std::move(name), ValueType::rgb, std::move(v));
        };
        f.example("two colours", {make_integer("nx", 2), colors("sigma_a", {1, 0, 0, 0, 0, 2}),
                                  colors("sigma_s", {0, 1, 0, 3, 3, 3})});
        f.example("neon", {make_integer("nz", 2), colors("sigma_a", {1, 1, 1, 0, 1, 0}),
                           colors("Le", {4, 0.5f, 0.5f, 0, 1, 0}), make_float("Lescale", 0.01f),
                           make_float("scale", 2)});
    }

    void finish(const Node& node, BuildContext& context) {
        if (!place_box(node, context) || !check_counts(node, context)) return;
        set(node, "sigma_a", sigma_a, absorption_);
        set(node, "sigma_s", sigma_s, scattering_);
        set(node, "Le", Le, emission_);
        if (const Parameter* p = node.find("Le")) white_ = space_of(*p).illuminant;
        // In RGB mode the film has been divided by what an illuminant's integral is.
        emission_scale_ = context.color_mode == ColorMode::rgb ? Lescale * cie_y_integral : Lescale;
        constexpr int most_cells = 32;
        const Vec3i cells{std::min(nx, most_cells), std::min(ny, most_cells), std::min(nz, most_cells)};
        majorants_ = MajorantGrid(box_, cells, [this](const Bounds3& cell) {
            auto bound = [&](const SampledGrid<CellColor>& grid) {
                return grid.empty()
                           ? 1
                           : grid.largest(in_unit_cube(cell), [](const CellColor& c) { return c.largest(); });
            };
            return bound(absorption_) + bound(scattering_);
        });
    }

    // Colours differ from cell to cell; what they have in common is the majorant, of all wavelengths.
    MediumColors colors(const Wavelengths&) const override { return {scale, 0, 0}; }
    MediumPoint at(Vec3 p, const MediumColors&, const Wavelengths& lambda) const override {
        const Vec3 place = in_unit_cube(p);
        auto look_up = [&](const SampledGrid<CellColor>& grid) {
            return grid.lookup(place, [&](const CellColor& c) { return c.eval(lambda); });
        };
        MediumPoint point;
        point.sigma_a = absorption_.empty() ? Spectrum(scale) : look_up(absorption_) * scale;
        point.sigma_s = scattering_.empty() ? Spectrum(scale) : look_up(scattering_) * scale;
        if (!emission_.empty()) {
            point.Le = look_up(emission_) * emission_scale_;
            if (lambda.mode == ColorMode::spectral) point.Le *= white_->eval(lambda.lambda);
        }
        return point;
    }
    bool is_emissive() const override { return !emission_.empty() && emission_scale_ > 0; }

  private:
    static const RgbColorSpace& space_of(const Parameter& p) {
        const RgbColorSpace* space = find_color_space(p.color_space);
        return space ? *space : srgb_space();
    }
    void set(const Node& node, std::string_view name, std::vector<float>& values,
             SampledGrid<CellColor>& grid) const {
        if (values.empty()) return;
        grid = SampledGrid<CellColor>(sides(), cell_colors(space_of(*node.find(name)), values));
        values = {};
    }
    bool check_counts(const Node& node, BuildContext& context) const {
        const auto wanted = cell_count();
        bool is_right = true;
        auto fail = [&](const Place& place, std::string text) {
            context.messages.add_error(place, std::move(text));
            is_right = false;
        };
        auto check = [&](std::string_view name, const std::vector<float>& values) {
            if (!node.find(name) || static_cast<std::int64_t>(values.size()) == 3 * wanted) return;
            fail(
                node.find(name)->place,
                fmt::format("parameter \"{}\" has {} numbers; nx ny nz ask for {} x {} x {} colours of three",
                            name, values.size(), nx, ny, nz));
        };
        check("sigma_a", sigma_a);
        check("sigma_s", sigma_s);
        check("Le", Le);
        if (!Le.empty() && sigma_a.empty())
            fail(node.find("Le")->place,
                 "medium \"rgbgrid\" has \"Le\" without \"sigma_a\": only what absorbs emits");
        return is_right;
    }

    SampledGrid<CellColor> absorption_, scattering_, emission_;
    const SpectralCurve* white_ = nullptr;
    float emission_scale_ = 1;
};

} // namespace

Kind<Medium> rgbgrid_medium() {
    return make_kind<Medium, RgbGrid>("rgbgrid");
}

} // namespace alhazen
