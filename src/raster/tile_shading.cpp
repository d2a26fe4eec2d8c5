#include "raster/tile_shading.h"

#include "base/arena.h"
#include "raster/triangle_cache.h"
#include "raster/triangle_point.h"

namespace alhazen {

namespace {

/// One surface in a pixel.
struct Seen {
    std::uint32_t number = DrawnTile::nothing;
    int samples = 0;
    Vec2 sum;   ///< of its samples' places
    Vec2 first; ///< one of them
};

/// A BSDF, and what is asked of it again and again.
struct KnownBsdf {
    const Material* material = nullptr;
    const Bsdf* bsdf = nullptr;
    std::optional<Spectrum> matte;
};

} // namespace

/// Shades one tile.
class TileShading::Shader {
  public:
    Shader(const TileShading& owner, const DrawnTile& tile, const Take& take)
        : camera_(owner.camera_), rays_(owner.rays_), lights_(owner.lights_), shading_(owner.shading_),
          cone_(owner.cone_), tile_(tile), take_(take) {}

    void shade() {
        for (int y = tile_.pixels().lo.y; y < tile_.pixels().hi.y; ++y)
            for (int x = tile_.pixels().lo.x; x < tile_.pixels().hi.x; ++x)
                if (tile_.samples() == 1)
                    shade({tile_.number({x, y}, 0), 1, {0.5f, 0.5f}, {0.5f, 0.5f}}, {x, y});
                else
                    shade_samples({x, y});
        flush();
    }

  private:
    void shade_samples(Vec2i pixel) {
        std::array<Seen, raster_max_samples> seen;
        std::size_t count = 0;
        for (std::uint32_t s = 0; s < tile_.samples(); ++s) {
            const std::uint32_t number = tile_.number(pixel, s);
            const Vec2 place = tile_.sample_place(s);
            std::size_t i = 0;
            while (i < count && seen[i].number != number) ++i;
            if (i == count) seen[count++] = {number, 0, {}, place};
            ++seen[i].samples;
            seen[i].sum += place;
        }
        for (std::size_t i = 0; i < count; ++i) shade(seen[i], pixel);
    }

    void shade(const Seen& seen, Vec2i pixel) {
        // The middle of the samples is within every triangle that has them all; of other shapes one is taken.
        const Vec2 corner{static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
        const Vec2 middle = corner + seen.sum * (1 / static_cast<float>(seen.samples));
        if (seen.number == DrawnTile::nothing) {
            const Spectrum L =
                lights_.infinite.empty()
                    ? Spectrum(0)
                    : lights_.background(rays_.origin(middle), normalize(rays_.direction(middle)));
            return take_(pixel, L, seen.samples);
        }
        if (seen.number != cached_) look_at(seen.number);
        if (is_simple_)
            triangle_.fill(rays_.origin(middle), rays_.direction(middle), hit_);
        else if (!find_hit(triangle_mesh_ ? middle : corner + seen.first))
            return take_(pixel, 0, seen.samples);
        const KnownBsdf* known = bsdf_at_hit();
        if (!known->bsdf)
            take_(pixel, 0, seen.samples); // a mixture's part that is only a border of media
        else if (known->matte && !hit_.area_light)
            add_matte(pixel, *known->matte, seen.samples);
        else
            take_(pixel, shading_.radiance(hit_, *known->bsdf), seen.samples);
    }

    void look_at(std::uint32_t number) {
        cached_ = number;
        const Fragment fragment = tile_.fragment(number);
        surface_ = fragment.surface;
        primitive_ = fragment.primitive;
        triangle_mesh_ = surface_->placed().shape->triangles();
        const Material* material = surface_->placed().material;
        is_simple_ = triangle_mesh_ && surface_->depth == 0 && !(material && material->has_relief());
        if (is_simple_) triangle_.set(*surface_, primitive_);
    }

    bool find_hit(Vec2 film) {
        CameraSample at;
        at.film = film;
        auto ray = camera_.ray(at);
        if (!ray) return false;
        const Ray local = surface_->local_ray(ray->ray);
        Intersection met;
        if (triangle_mesh_)
            met = point_of_triangle(*triangle_mesh_, primitive_, local);
        else if (!surface_->placed().shape->intersect(local, primitive_, met))
            return false;
        hit_ = surface_->surface(local, primitive_, met);
        return true;
    }

    // Good until the next call.
    const KnownBsdf* bsdf_at_hit() {
        const Material* material = hit_.material;
        Wavelengths rgb = Wavelengths::rgb();
        if (!material->is_uniform()) {
            hit_.cone = cone_;
            arena_.reset();
            passing_.bsdf = material->at(hit_, rgb, arena_);
            passing_.matte = passing_.bsdf ? passing_.bsdf->matte() : std::nullopt;
            return &passing_;
        }
        if (last_ < uniform_.size() && uniform_[last_].material == material) return &uniform_[last_];
        for (last_ = 0; last_ < uniform_.size(); ++last_)
            if (uniform_[last_].material == material) return &uniform_[last_];
        const Bsdf* bsdf = material->at(hit_, rgb, uniform_arena_);
        uniform_.push_back({material, bsdf, bsdf ? bsdf->matte() : std::nullopt});
        return &uniform_.back();
    }

    void add_matte(Vec2i pixel, Spectrum matte, int samples) {
        const std::size_t i = batch_.count++;
        const Vec3 n = face_forward(hit_.ns, hit_.wo);
        batch_.px[i] = hit_.p.x;
        batch_.py[i] = hit_.p.y;
        batch_.pz[i] = hit_.p.z;
        batch_.nx[i] = n.x;
        batch_.ny[i] = n.y;
        batch_.nz[i] = n.z;
        batch_.gx[i] = hit_.ng.x;
        batch_.gy[i] = hit_.ng.y;
        batch_.gz[i] = hit_.ng.z;
        batch_.red[i] = matte[0];
        batch_.green[i] = matte[1];
        batch_.blue[i] = matte[2];
        waiting_[i] = {pixel, samples};
        if (batch_.count == MatteBatch::capacity) flush();
    }

    void flush() {
        shading_.light(batch_);
        for (std::size_t i = 0; i < batch_.count; ++i) {
            const float r = batch_.red[i], g = batch_.green[i], b = batch_.blue[i];
            take_(waiting_[i].pixel, {r, g, b, (r + g + b) / 3}, waiting_[i].samples);
        }
        batch_.count = 0;
    }

    const Camera& camera_;
    const FilmRays& rays_;
    const LocalLights& lights_;
    const LocalShading& shading_;
    const PixelCone* cone_;
    const DrawnTile& tile_;
    const Take& take_;

    std::uint32_t cached_ = DrawnTile::nothing; ///< the fragment that these belong to
    const PlacedSurface* surface_ = nullptr;
    std::uint32_t primitive_ = 0;
    const TriangleMesh* triangle_mesh_ = nullptr;
    bool is_simple_ = false;
    TriangleCache triangle_;
    Hit hit_;

    Arena arena_, uniform_arena_;
    KnownBsdf passing_;
    std::vector<KnownBsdf> uniform_;
    std::size_t last_ = 0;

    struct Waiting {
        Vec2i pixel;
        int samples;
    };
    std::array<Waiting, MatteBatch::capacity> waiting_;
    alignas(64) MatteBatch batch_;
};

void TileShading::shade(const DrawnTile& tile, const Take& take) const {
    Shader(*this, tile, take).shade();
}

} // namespace alhazen
