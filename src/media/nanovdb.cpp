/// Smoke, clouds and fire from grid files, where most of space is empty (Pharr et al. 2023, section 11.4.6).
#include <fmt/format.h>

#include "media/glow.h"
#include "media/medium.h"
#include "media/medium_fields.h"
#include "media/sparse_field.h"

namespace alhazen {

namespace {

struct NanoVdb final : Medium, CrossSections, TemperatureFields {
    std::string filename;
    float Lescale = 1;

    static void describe(Fields<NanoVdb>& f) {
        f.about("Matter whose density a NanoVDB file holds, in a grid named \"density\"; where there is a "
                "grid named \"temperature\", what absorbs glows as a black body, whose maximum is 1.");
        f.field("filename", &NanoVdb::filename, "the .nvdb file, relative to the scene's folder").required();
        describe_cross_sections(f);
        describe_common(f);
        f.field("Lescale", &NanoVdb::Lescale, "factor on what is emitted").at_least(0);
        describe_temperatures(f);
        f.example("smoke", {make_string("filename", "volumes/smoke.nvdb")});
        f.example("fire", {make_string("filename", "volumes/smoke.nvdb"), make_float("scale", 10),
                           make_float("Lescale", 0.01f), make_float("temperaturescale", 10)});
    }
    void finish(const Node& node, BuildContext& context) {
        phase_ = HenyeyGreenstein(g);
        glow_ = Glow(context.color_mode);
        if (!read(node, context)) return;
        world_from_medium_ = context.world_from_node;
        const Bounds3 samples = density_.bounds();
        Bounds3 box;
        for (int i = 0; i < 8; ++i)
            box.extend(Vec3(density_.object_from_index().point(Vec3d(samples.corner(i)))));
        index_from_medium_ = Transform(*density_.object_from_index().inverse());
        constexpr int cells = 64;
        majorants_ = MajorantGrid(box, {cells, cells, cells}, [this](const Bounds3& cell) {
            return density_.largest(index_from_medium_.bounds(cell));
        });
        if (!temperature_.empty())
            temperature_index_from_medium_ = Transform(*temperature_.object_from_index().inverse());
    }

    MediumColors colors(const Wavelengths& lambda) const override {
        return {sigma_a.eval(lambda) * scale, sigma_s.eval(lambda) * scale, 0};
    }
    MediumPoint at(Vec3 p, const MediumColors& c, const Wavelengths& lambda) const override {
        const float d = density_.lookup(index_from_medium_.point(p));
        MediumPoint point{c.sigma_a * d, c.sigma_s * d, 0};
        if (is_emissive()) {
            const float number = temperature_.lookup(temperature_index_from_medium_.point(p));
            point.Le = glow_.eval(kelvin(number), lambda) * Lescale;
        }
        return point;
    }
    bool is_emissive() const override { return !temperature_.empty() && Lescale > 0; }

  private:
    bool read(const Node& node, BuildContext& context) {
        const Place& place = node.place_of("filename");
        const std::string prefix = fmt::format("grid file \"{}\": ", filename);
        auto fail = [&](std::string_view text) {
            context.messages.add_error(place, prefix + std::string(text));
            return false;
        };
        if (!context.grid_reader || !*context.grid_reader) return fail("grid files cannot be read here");
        try {
            GridData data = (*context.grid_reader)(context.resolve(filename), "density");
            for (const GridBrick& b : data.bricks)
                for (float v : b.values)
                    if (v < 0) return fail("it holds densities below 0");
            density_ = SparseField(std::move(data));
            if (Lescale > 0)
                temperature_ = SparseField((*context.grid_reader)(context.resolve(filename), "temperature"));
        } catch (const NoSuchGrid& e) {
            // Without temperatures nothing glows.
            if (density_.empty()) return fail(e.what());
        } catch (const std::runtime_error& e) {
            return fail(e.what());
        }
        return true;
    }

    SparseField density_, temperature_;
    Transform index_from_medium_, temperature_index_from_medium_;
    Glow glow_{ColorMode::spectral};
};

} // namespace

Kind<Medium> nanovdb_medium() {
    return make_kind<Medium, NanoVdb>("nanovdb");
}

} // namespace alhazen
