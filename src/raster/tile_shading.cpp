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
    Vec2 place;           ///< the mean of its samples', in the pixel
    float nearness = 0;   ///< the mean of its samples'
    std::uint32_t sample; ///< one of them
};

/// A BSDF, and what is asked of it again and again.
struct KnownBsdf {
    const Material* material = nullptr;
    const Bsdf* bsdf = nullptr;
    std::optional<Spectrum> matte;
};

/// A flat triangle that shows the same all over.
struct Flat {
    std::uint32_t number = DrawnTile::nothing;
    Vec3 normal;
    Spectrum matte = 0;
};

/// A place on the film, and how near what is seen there is.
struct Spot {
    Vec2 film;
    float nearness;
};

} // namespace

/// Shades one tile.
class TileShading::Shader {
  public:
    Shader(const TileShading& owner, const DrawnTile& tile, const Take& take)
        : camera_(owner.camera_), rays_(owner.rays_), lights_(owner.lights_), shading_(owner.shading_),
          cone_(owner.cone_), tile_(tile), take_(take) {
        for (std::uint32_t s = 0; s < samples_; ++s) mean_place_ += tile_.sample_place(s);
        mean_place_ *= share_;
    }

    void shade() {
        // Block by block, since the triangles of neighbouring pixels are often the same.
        const Rect2i& all = tile_.pixels();
        for (int y = all.lo.y; y < all.hi.y; y = next_block(y))
            for (int x = all.lo.x; x < all.hi.x; x = next_block(x))
                shade({{x, y}, {std::min(next_block(x), all.hi.x), std::min(next_block(y), all.hi.y)}});
        light_batch();
        hand_over();
    }

  private:
    static int next_block(int x) { return (x / raster_block + 1) * raster_block; }

    void shade(const Rect2i& pixels) {
        for (int y = pixels.lo.y; y < pixels.hi.y; ++y) {
            const DrawnTile::Row row = tile_.row({pixels.lo.x, y});
            for (int x = pixels.lo.x; x < pixels.hi.x; ++x) shade_pixel({x, y}, row, x - pixels.lo.x);
        }
    }

    void shade_pixel(Vec2i pixel, const DrawnTile::Row& row, int i) {
        const std::uint32_t number = row.numbers[i];
        float nearness = row.nearness[i];
        std::uint32_t same = 1;
        for (; same < samples_ && row.numbers[row.at(i, same)] == number; ++same)
            nearness += row.nearness[row.at(i, same)];
        if (same == samples_)
            shade({number, static_cast<int>(samples_), mean_place_, nearness * share_, 0}, pixel);
        else
            shade_several(pixel);
    }

    void shade_several(Vec2i pixel) {
        std::array<Seen, raster_max_samples> seen;
        std::size_t count = 0;
        for (std::uint32_t s = 0; s < tile_.samples(); ++s) {
            const std::uint32_t number = tile_.number(pixel, s);
            std::size_t i = 0;
            while (i < count && seen[i].number != number) ++i;
            if (i == count) seen[count++] = {number, 0, {}, 0, s};
            ++seen[i].samples;
            seen[i].place += tile_.sample_place(s);
            seen[i].nearness += tile_.nearness(pixel, s);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const float share = 1 / static_cast<float>(seen[i].samples);
            seen[i].place = seen[i].place * share;
            seen[i].nearness *= share;
            shade(seen[i], pixel);
        }
    }

    void shade(const Seen& seen, Vec2i pixel) {
        const Vec2 corner{static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
        const Vec2 middle = corner + seen.place;
        if (seen.number == DrawnTile::nothing) {
            const Spectrum L =
                lights_.infinite.empty()
                    ? Spectrum(0)
                    : lights_.background(rays_.origin(middle), normalize(rays_.direction(middle)));
            return take({pixel, seen.samples, L});
        }
        const Flat& flat = flats_[seen.number % flats_.size()];
        if (flat.number == seen.number)
            return add_matte(pixel, seen.samples, {middle, seen.nearness}, {flat.normal, flat.normal},
                             flat.matte);
        if (seen.number != cached_) look_at(seen.number, middle);
        // The middle of the samples is within every triangle that has them all, and as near as they are on
        // average; of other shapes one sample is taken.
        const Spot spot = triangle_mesh_ ? Spot{middle, seen.nearness}
                                         : Spot{corner + tile_.sample_place(seen.sample),
                                                tile_.nearness(pixel, seen.sample)};
        if (is_uniform_matte_) return add_uniform_matte(pixel, seen.samples, spot);
        if (is_simple_)
            triangle_.fill(rays_.origin(spot.film), rays_.direction(spot.film), hit_);
        else if (!find_hit(spot.film))
            return take({pixel, seen.samples, 0});
        if (mixture_) return take({pixel, seen.samples, radiance_of_mixture()});
        const KnownBsdf* known = bsdf_at_hit();
        if (!known->bsdf)
            take({pixel, seen.samples, shading_.behind(hit_)});
        else if (known->matte && !hit_.area_light)
            add_matte(pixel, seen.samples, spot, {hit_.ng, hit_.ns}, *known->matte);
        else
            take({pixel, seen.samples, shading_.radiance(hit_, *known->bsdf)});
    }

    // film: some place where it is seen.
    void look_at(std::uint32_t number, Vec2 film) {
        cached_ = number;
        const Fragment fragment = tile_.fragment(number);
        primitive_ = fragment.primitive;
        if (surface_ != fragment.surface) look_at(*fragment.surface);
        is_uniform_matte_ = false;
        if (!is_simple_) return;
        triangle_.set(*surface_, primitive_);
        const PlacedShape& placed = surface_->placed();
        if (!is_uniform_ || (!placed.lights.empty() && placed.lights[primitive_])) return;
        if (last_ >= uniform_.size() || uniform_[last_].material != placed.material) {
            triangle_.fill(rays_.origin(film), rays_.direction(film), hit_);
            bsdf_at_hit();
        }
        is_uniform_matte_ = uniform_[last_].matte.has_value();
        if (!is_uniform_matte_) return;
        matte_ = *uniform_[last_].matte;
        if (!triangle_.has_normals()) flats_[number % flats_.size()] = {number, triangle_.normal(), matte_};
    }
    void look_at(const PlacedSurface& surface) {
        surface_ = &surface;
        const PlacedShape& placed = surface.placed();
        triangle_mesh_ = placed.shape->triangles();
        is_simple_ =
            triangle_mesh_ && surface_->depth == 0 && !(placed.material && placed.material->has_relief());
        is_uniform_ = placed.material && placed.material->is_uniform();
        mixture_ = placed.material && placed.material->is_mixture() ? placed.material : nullptr;
    }

    // All that are mixed: a look at one of them a pixel would be seen as specks.
    Spectrum radiance_of_mixture() {
        hit_.cone = cone_;
        shares_.clear();
        mixture_->add_shares(hit_, 1, shares_);
        Spectrum sum = 0;
        for (const MaterialShare& part : shares_) {
            if (mixture_->has_relief()) hit_ = surface_->surface(local_, primitive_, met_, part.material);
            hit_.material = part.material;
            const Bsdf* bsdf = bsdf_at_hit()->bsdf;
            sum += part.share * (bsdf ? shading_.radiance(hit_, *bsdf) : shading_.behind(hit_));
        }
        return sum;
    }

    void add_uniform_matte(Vec2i pixel, int samples, const Spot& spot) {
        const Vec3 p = rays_.origin(spot.film) + rays_.direction(spot.film) * rays_.steps(spot.nearness);
        add_matte(pixel, samples, spot, triangle_.normals_at(p), matte_);
    }

    bool find_hit(Vec2 film) {
        CameraSample at;
        at.film = film;
        auto ray = camera_.ray(at);
        if (!ray) return false;
        local_ = surface_->local_ray(ray->ray);
        met_ = {};
        if (triangle_mesh_)
            met_ = point_of_triangle(*triangle_mesh_, primitive_, local_);
        else if (!surface_->placed().shape->intersect(local_, primitive_, met_))
            return false;
        hit_ = surface_->surface(local_, primitive_, met_, mixture_);
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

    void add_matte(Vec2i pixel, int samples, const Spot& spot, const TriangleCache::Normals& normals,
                   Spectrum matte) {
        const std::size_t i = batch_.count++;
        batch_.film_x[i] = spot.film.x;
        batch_.film_y[i] = spot.film.y;
        batch_.nearness[i] = spot.nearness;
        batch_.nx[i] = normals.ns.x;
        batch_.ny[i] = normals.ns.y;
        batch_.nz[i] = normals.ns.z;
        batch_.gx[i] = normals.ng.x;
        batch_.gy[i] = normals.ng.y;
        batch_.gz[i] = normals.ng.z;
        batch_.red[i] = matte[0];
        batch_.green[i] = matte[1];
        batch_.blue[i] = matte[2];
        waiting_[i] = {pixel, samples};
        if (batch_.count == RasterPoints::capacity) light_batch();
    }

    void light_batch() {
        for (std::uint32_t i = batch_.count; i % RasterPoints::lanes; ++i) {
            batch_.film_x[i] = batch_.film_y[i] = batch_.nx[i] = batch_.ny[i] = batch_.nz[i] = 0;
            batch_.nearness[i] = 1;
        }
        kernel_.place(numbers_, batch_);
        shading_.light(batch_);
        for (std::size_t i = 0; i < batch_.count; ++i) {
            const float r = batch_.red[i], g = batch_.green[i], b = batch_.blue[i];
            take({waiting_[i].pixel, waiting_[i].samples, {r, g, b, (r + g + b) / 3}});
        }
        batch_.count = 0;
    }

    void take(const EvenSamples& shaded) {
        shaded_[shaded_count_++] = shaded;
        if (shaded_count_ == shaded_.size()) hand_over();
    }
    void hand_over() {
        take_({shaded_.data(), shaded_count_});
        shaded_count_ = 0;
    }

    const Camera& camera_;
    const FilmRays& rays_;
    const RasterRays numbers_ = rays_.numbers();
    const LocalLights& lights_;
    const LocalShading& shading_;
    const PixelCone* cone_;
    const DrawnTile& tile_;
    const Take& take_;
    const RasterKernel& kernel_ = *supported_raster_kernels().front();
    const std::uint32_t samples_ = tile_.samples(); ///< a pixel
    const float share_ = 1 / static_cast<float>(samples_);
    Vec2 mean_place_; ///< of a pixel's samples

    std::uint32_t cached_ = DrawnTile::nothing; ///< the fragment that these belong to
    const PlacedSurface* surface_ = nullptr;
    std::uint32_t primitive_ = 0;
    const TriangleMesh* triangle_mesh_ = nullptr;
    const Material* mixture_ = nullptr; ///< its material, where that is one
    bool is_simple_ = false;            ///< a triangle whose hits triangle_ knows
    bool is_uniform_ = false;           ///< its material is the same all over
    bool is_uniform_matte_ = false;     ///< such a one, which shows matte_ all over
    Spectrum matte_ = 0;
    TriangleCache triangle_;
    std::array<Flat, 128> flats_; ///< those seen last, by number: rows of pixels come back to them
    Hit hit_;
    Ray local_; ///< that made the hit, as
    Intersection met_;
    std::vector<MaterialShare> shares_;

    Arena arena_, uniform_arena_;
    KnownBsdf passing_;
    std::vector<KnownBsdf> uniform_;
    std::size_t last_ = 0;

    struct Waiting {
        Vec2i pixel;
        int samples;
    };
    std::array<Waiting, RasterPoints::capacity> waiting_;
    RasterPoints batch_;
    std::array<EvenSamples, 256> shaded_;
    std::size_t shaded_count_ = 0;
};

void TileShading::shade(const DrawnTile& tile, const Take& take) const {
    Shader(*this, tile, take).shade();
}

} // namespace alhazen
