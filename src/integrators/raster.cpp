/// Rasterisation with local illumination: the instant preview. Instead of asking for each pixel which surface
/// its ray meets, each surface is asked which pixels it covers (Pineda 1988); what is nearest in the end is
/// shaded once, by the light that comes straight from the lights (Phong 1975). The picture: everything in its
/// place, materials and textures as they are; no reflections, no light from one surface to another, and
/// shadows only from maps.
///
/// A camera with a lens, or one that sees all around, has no projection that keeps lines straight; then rays
/// find the surfaces, and the shading is the same, but that they see one part of a mixture each.
#include <algorithm>
#include <atomic>
#include <mutex>

#include "integrators/integrator.h"
#include "raster/rasterizer.h"
#include "raster/shadow_map.h"
#include "raster/tile_shading.h"

namespace alhazen {

template <>
struct EnumNames<Highlight> {
    static constexpr std::array names{"phong", "blinn"};
};

namespace {

/// One picture: rasterised, and each tile shaded as soon as it is there.
class RasterWork final : public PictureWork {
  public:
    RasterWork(const PictureOrder& picture, const LocalLights& lights, const LocalShading& shading)
        : picture_(picture), shading_(picture.camera, lights, shading, picture.scene.pixel_cone()) {}

    PictureCounts run(int, const std::function<void(double)>& progress) override {
        const Rect2i pixels = picture_.film.pixels();
        const auto all = static_cast<double>(pixels.width()) * pixels.height();
        std::atomic<int> done{0};
        std::mutex mutex;
        PictureCounts counts;
        Rasterizer(picture_.scene, picture_.camera, picture_.samples).run(pixels, [&](const DrawnTile& tile) {
            shading_.shade(tile, [&](std::span<const EvenSamples> shaded) {
                auto is_finite = [](const EvenSamples& s) { return s.L.is_finite(); };
                if (std::all_of(shaded.begin(), shaded.end(), is_finite))
                    return picture_.film.add_even(shaded);
                std::scoped_lock lock(mutex);
                for (const EvenSamples& s : shaded)
                    if (is_finite(s))
                        picture_.film.add_even({&s, 1});
                    else
                        counts.add_bad(s.pixel, 0);
            });
            const Rect2i part = tile.pixels();
            const int count = part.width() * part.height();
            progress((done.fetch_add(count) + count) / all);
        });
        return counts;
    }

  private:
    PictureOrder picture_;
    TileShading shading_;
};

struct Raster final : Integrator {
    int samples = 4;
    Highlight highlight = Highlight::phong;
    UnboundedSpectrum ambient{0.1f};
    bool shadows = false;
    int shadow_resolution = 1024;
    int shadow_radius = 1;

    static void describe(Fields<Raster>& f) {
        f.about("Rasterises, with light straight from the lights only: an instant preview. Mirrors and glass "
                "show no "
                "more than their highlights and, blurred, the surroundings. Lights with an extent shine from "
                "their "
                "middle. The pixel filter has no effect. Works in linear RGB.");
        f.field("samples", &Raster::samples,
                "places a pixel at which it is decided what is seen there: 1, 4, 8 or 16; each surface in "
                "the pixel "
                "is shaded once")
            .in(1, 16);
        f.field("highlight", &Raster::highlight, "formula for the highlights of phong materials");
        f.field("ambient", &Raster::ambient, "light that comes from everywhere").in(0, 1e30);
        f.field("shadows", &Raster::shadows,
                "whether objects block light, by shadow maps; never that of the surroundings");
        f.field("shadowresolution", &Raster::shadow_resolution, "texels on a side of a shadow map")
            .in(16, 16384);
        f.field(
             "shadowradius", &Raster::shadow_radius,
             "width of shadows' soft edges: the maps are asked at 2 shadowradius + 1 texels across and down")
            .in(0, 16);
    }

    void finish(const Node& node, BuildContext& context) {
        if (Rasterizer::is_sample_count(samples)) return;
        context.messages.add_error(node.place_of("samples"), "parameter \"samples\" is " +
                                                                 std::to_string(samples) +
                                                                 ", but must be 1, 4, 8 or 16");
    }

    bool works_in_rgb() const override { return true; }
    bool centres_single_samples() const override { return true; }
    /// The next pattern that has as many; the sampler has no say, since pictures for previews need few.
    int samples_per_pixel(int, std::optional<int> asked) const override {
        if (!asked) return samples;
        for (int count : {1, 4, 8})
            if (*asked <= count) return count;
        return 16;
    }
    void prepare(const PictureOrder& picture) override {
        lights_.emplace(picture.scene);
        if (shadows)
            shadow_maps_.emplace(picture.scene, *lights_, ShadowMapOptions{shadow_resolution, shadow_radius});
        shading_.emplace(*lights_, ShadingOptions{highlight, ambient.eval(Wavelengths::rgb())},
                         shadow_maps_ ? &*shadow_maps_ : nullptr);
    }

    bool follows_camera_rays() const override { return false; }
    bool sees_motion() const override { return false; }
    std::unique_ptr<PictureWork> whole_picture(const PictureOrder& picture) const override {
        if (!picture.camera.projection()) return nullptr;
        return std::make_unique<RasterWork>(picture, *lights_, *shading_);
    }

    Task<Spectrum> radiance(Ray ray, PathContext& path) const override {
        for (;;) {
            std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) co_return lights_->background(ray.o, ray.d);
            if (const Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena))
                co_return shading_->radiance(*hit, *bsdf);
            ray = hit->spawn(ray.d);
        }
    }

  private:
    std::optional<LocalLights> lights_;
    std::optional<ShadowMaps> shadow_maps_;
    std::optional<LocalShading> shading_;
};

} // namespace

Kind<Integrator> raster_integrator() {
    return make_kind<Integrator, Raster>("raster");
}

} // namespace alhazen
