/// A box of samples of a density: smoke, clouds (Pharr et al. 2023, section 11.4.3).
#include <fmt/format.h>

#include "media/box_medium.h"
#include "media/glow.h"
#include "media/medium_fields.h"
#include "media/sampled_grid.h"

namespace alhazen {

namespace {

struct UniformGrid final : BoxMedium, CrossSections, TemperatureFields, GridSides {
    std::vector<float> density, temperature, Lescale;
    std::optional<IlluminantSpectrum> Le;

    static void describe(Fields<UniformGrid>& f) {
        f.about("Matter whose density is given at the centres of the cells of a box.");
        describe_sides(f);
        f.field("density", &UniformGrid::density, "nx ny nz densities, x running fastest")
            .at_least(0)
            .required();
        f.field("temperature", &UniformGrid::temperature,
                "as many temperatures: what absorbs glows as a black body, whose maximum is 1")
            .unit("K");
        describe_temperatures(f);
        describe_cross_sections(f);
        f.field("Le", &UniformGrid::Le, "radiance of what absorbs, instead of temperatures");
        f.field("Lescale", &UniformGrid::Lescale, "nx ny nz factors on what is emitted")
            .at_least(0)
            .otherwise("1 everywhere");
        describe_box(f);
        auto numbers = [](std::string name, std::vector<float> v) {
            return make_array<float>(std::move(name), ValueType::real, std::move(v));
        };
        f.example("eight cells", {make_integer("nx", 2), make_integer("ny", 2), make_integer("nz", 2),
                                  numbers("density", {0, 1, 2, 0, 3, 0, 0, 1})});
        f.example("fire", {make_integer("nx", 2), numbers("density", {1, 2}),
                           numbers("temperature", {1500, 4000}), numbers("Lescale", {0.01f, 0.02f}),
                           make_float("temperatureoffset", 300), make_float("temperaturescale", 1.2f)});
        f.example("glowing fog", {numbers("density", {1}), make_rgb("Le", 1, 0.5f, 0.2f),
                                  make_float("g", -0.3f), make_float("scale", 0.5f)});
    }

    void finish(const Node& node, BuildContext& context) {
        if (!place_box(node, context) || !check_counts(node, context)) return;
        const Vec3i size = sides();
        density_ = SampledGrid<float>(size, std::move(density));
        if (!temperature.empty()) temperature_ = SampledGrid<float>(size, std::move(temperature));
        if (!Lescale.empty()) glow_scale_ = SampledGrid<float>(size, std::move(Lescale));
        if (Le && !Le->value.is_black())
            emitted_ = Le->value.scaled(Le->value.light_scale(context.color_mode));
        glow_ = Glow(context.color_mode);
        // Fine enough to see the empty parts, coarse enough to cross quickly.
        constexpr int most_cells = 32;
        const Vec3i cells{std::min(nx, most_cells), std::min(ny, most_cells), std::min(nz, most_cells)};
        majorants_ = MajorantGrid(box_, cells, [this](const Bounds3& cell) {
            return density_.largest(in_unit_cube(cell), [](float d) { return d; });
        });
    }

    MediumColors colors(const Wavelengths& lambda) const override {
        return {sigma_a.eval(lambda) * scale, sigma_s.eval(lambda) * scale, emitted_.eval(lambda)};
    }
    MediumPoint at(Vec3 p, const MediumColors& c, const Wavelengths& lambda) const override {
        const Vec3 place = in_unit_cube(p);
        const float d = density_.lookup(place);
        MediumPoint point{c.sigma_a * d, c.sigma_s * d, 0};
        if (!is_emissive()) return point;
        const float s = glow_scale_.empty() ? 1 : glow_scale_.lookup(place);
        if (!(s > 0)) return point;
        point.Le =
            temperature_.empty() ? c.Le * s : glow_.eval(kelvin(temperature_.lookup(place)), lambda) * s;
        return point;
    }
    bool is_emissive() const override { return !temperature_.empty() || !emitted_.is_black(); }

  private:
    bool check_counts(const Node& node, BuildContext& context) const {
        const auto wanted = cell_count();
        bool is_right = true;
        auto check = [&](std::string_view name, const std::vector<float>& values) {
            if (values.empty() || static_cast<std::int64_t>(values.size()) == wanted) return;
            is_right = false;
            context.messages.add_error(
                node.find(name)->place,
                fmt::format("parameter \"{}\" has {} values; nx ny nz ask for {} x {} x {} = {}", name,
                            values.size(), nx, ny, nz, wanted));
        };
        check("density", density);
        check("temperature", temperature);
        check("Lescale", Lescale);
        if (density.empty()) {
            context.messages.add_error(node.find("density")->place, "parameter \"density\" has no values");
            is_right = false;
        }
        if (Le && !temperature.empty()) {
            context.messages.add_error(
                node.find("Le")->place,
                "medium \"uniformgrid\" has both \"Le\" and \"temperature\"; it takes one of them");
            is_right = false;
        }
        return is_right;
    }

    SampledGrid<float> density_, temperature_, glow_scale_;
    SpectrumValue emitted_;
    Glow glow_{ColorMode::spectral};
};

} // namespace

Kind<Medium> uniformgrid_medium() {
    return make_kind<Medium, UniformGrid>("uniformgrid");
}

} // namespace alhazen
