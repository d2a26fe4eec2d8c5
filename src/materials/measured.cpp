/// Measured surfaces (Dupuy and Jakob 2018; Pharr et al. 2023, section 9.8): metals, paints, papers, cloths,
/// as a goniophotometer saw them. The tables say how light goes on that comes along one direction; here that
/// is wo for radiance. Measurements are not quite symmetric: importance has the value of the way back, so
/// that light followed from either end gives one picture. Both sides of a surface look alike.
#include <array>
#include <memory>

#include <fmt/format.h>

#include "materials/fresnel.h"
#include "materials/material_set.h"
#include "materials/material_tables.h"

namespace alhazen {

namespace {

/// The wavelengths of a path among those of the data.
using WavePlaces = std::array<AxisPlace, 4>;

struct MeasuredBsdf final : Bsdf {
    const MeasuredData* data;
    WavePlaces waves;

    MeasuredBsdf(const MeasuredData& data_, const WavePlaces& waves_) : data(&data_), waves(waves_) {}

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode mode) const override {
        if (!same_hemisphere(wo, wi) || wo.z == 0 || wi.z == 0) return {};
        if (wo.z < 0) {
            wo = -wo;
            wi = -wi;
        }
        const Vec3 sum = wo + wi;
        if (length_squared(sum) == 0) return {};
        const Vec3 wm = normalize(sum);
        const Reflection there(*data, wo, wm), back(*data, wi, wm);
        // Lights may be left to sampling, which must find all that is there.
        Spectrum f = 0;
        if (there.pdf > 0) f = mode == TransportMode::radiance ? value(there) : value(back) * (wi.z / wo.z);
        return {f, there.pdf, back.pdf};
    }

    std::optional<BsdfSample> sample(Vec3 wo, float, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        const Vec3 up = wo.z < 0 ? -wo : wo;
        const View view(*data, up);
        const Vec2 point = data->luminance.sample(u2, view.blend).p;
        const Vec3 wm = MeasuredData::from_square(data->vndf.sample(point, view.blend).p, view.turned);
        Vec3 wi = normalize(reflect(up, wm));
        if (!(wi.z > 0)) return std::nullopt;
        if (wo.z < 0) wi = -wi;
        const Scatter s = eval(wo, wi, mode);
        if (!(s.pdf > 0)) return std::nullopt;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, lobes(), 1};
    }

    Lobes lobes() const override { return Lobes::reflection | Lobes::glossy; }

  private:
    /// A direction that the surface is seen from: its tables among the data.
    struct View {
        View(const MeasuredData& data, Vec3 w)
            : blend(blend_around(locate(data.phi, data.azimuth_of(w)),
                                 locate(data.theta, std::atan2(std::hypot(w.x, w.y), w.z)),
                                 data.theta.size())),
              turned(data.is_isotropic ? std::atan2(w.y, w.x) : 0) {}
        TableBlend blend;
        float turned; ///< azimuth from which those of normals count
    };

    /// Reflection, seen from w, by facets of normal wm.
    struct Reflection {
        Reflection(const MeasuredData& data, Vec3 w_, Vec3 wm) : w(w_), view(data, w_) {
            normal = MeasuredData::to_square(wm, view.turned);
            const BilinearDensities::Sample inverse = data.vndf.invert(normal, view.blend);
            point = inverse.p;
            // Mirroring turns a solid angle of normals into 4 times its cosine of directions.
            pdf = inverse.pdf * data.luminance.pdf(point, view.blend) /
                  (4 * std::max(dot(w, wm), 1e-6f) * MeasuredData::solid_angle(normal));
        }
        Vec3 w;
        View view;
        Vec2 normal, point;
        float pdf = 0;
    };

    /// The BSDF times the cosine of the direction that is not seen from.
    Spectrum value(const Reflection& r) const {
        float factor = 1;
        if (data->has_facet_factor) {
            const float area = 4 * data->sigma.eval(MeasuredData::to_square(r.w));
            factor = area > 0 ? data->ndf.eval(r.normal) / area : 0;
        }
        const BilinearTables::Cell cell = data->spectra.cell_at(r.point);
        return (data->wavelengths.empty() ? colors(r.view.blend, cell) : lanes(r.view.blend, cell)) * factor;
    }

    Spectrum colors(const TableBlend& blend, BilinearTables::Cell cell) const {
        Spectrum sum = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(blend.count); ++i) {
            auto channel = [&](std::size_t c) { return data->spectra.eval(blend.table[i] * 3 + c, cell); };
            const float r = channel(0), g = channel(1), b = channel(2);
            sum += Spectrum(r, g, b, (r + g + b) / 3) * blend.weight[i];
        }
        return sum;
    }
    Spectrum lanes(const TableBlend& blend, BilinearTables::Cell cell) const {
        Spectrum sum = 0;
        const std::size_t count = data->wavelengths.size();
        for (std::size_t i = 0; i < static_cast<std::size_t>(blend.count); ++i)
            for (int lane = 0; lane < 4; ++lane) {
                const AxisPlace wave = waves[static_cast<std::size_t>(lane)];
                const std::size_t table = blend.table[i] * count + wave.index;
                float v = data->spectra.eval(table, cell);
                if (wave.fraction > 0) v = lerp(wave.fraction, v, data->spectra.eval(table + 1, cell));
                sum.set(lane, sum[lane] + v * blend.weight[i]);
            }
        return sum;
    }
};

struct Measured final : Material {
    std::string filename;
    std::shared_ptr<const MeasuredData> data;

    static void describe(Fields<Measured>& f) {
        f.about("A surface that was measured: any opaque matter, as its file of Dupuy and Jakob's format "
                "(.bsdf, such as those of the RGL material database) has it. Beyond the wavelengths of "
                "the file, its first and last hold.");
        f.field("filename", &Measured::filename, "the file, relative to the scene's folder").required();
        Relief::describe(f);
        f.example("satin", {make_string("filename", "measured/satin.bsdf")});
        f.example("brushed", {make_string("filename", "measured/brushed.bsdf")});
    }
    void finish(const Node& node, BuildContext& context) {
        try {
            data = shared_tables(context)->measured(context.resolve(filename), context.color_mode);
        } catch (const std::runtime_error& e) {
            context.messages.add_error(node.place_of("filename"),
                                       fmt::format("measured BSDF file \"{}\": {}", filename, e.what()));
        }
    }

    bool needs_parameters() const override { return !data->is_isotropic; }
    Bsdf* at(const Hit&, Wavelengths& lambda, Arena& arena) const override {
        WavePlaces waves;
        if (!data->wavelengths.empty())
            for (int lane = 0; lane < 4; ++lane)
                waves[static_cast<std::size_t>(lane)] = locate(data->wavelengths, lambda.lambda[lane]);
        return arena.make<MeasuredBsdf>(*data, waves);
    }
};

} // namespace

Kind<Material> measured_material() {
    return make_kind<Material, Measured>("measured");
}

} // namespace alhazen
