#include "raster/tile_drawer.h"

#include "raster/sample_places.h"
#include "raster/triangle_point.h"

namespace alhazen {

TileDrawer::TileDrawer(const Camera& camera, const Projection& projection, const SortedGeometry& geometry,
                       const RasterKernel& kernel, int samples)
    : camera_(camera), projection_(projection), geometry_(geometry), draws_(geometry.draws), kernel_(kernel) {
    const std::size_t size = std::size_t{raster_tile} * raster_tile * static_cast<std::size_t>(samples);
    nearness_.resize(size);
    fragment_.resize(size);
    RasterTarget& target = tile_.target_;
    target.samples = static_cast<std::uint32_t>(samples);
    target.nearness = nearness_.data();
    target.fragment = fragment_.data();
    std::size_t s = 0;
    for (SamplePlace place : sample_places(samples)) {
        target.sample_x[s] = place.x * (raster_subpixels / 16);
        target.sample_y[s++] = place.y * (raster_subpixels / 16);
    }
    tile_.draws_ = &geometry.draws;
    tile_.chunks_ = &geometry.chunks;
}

const DrawnTile& TileDrawer::draw(Vec2i origin, const Rect2i& part, int tile_x, int tile_y) {
    clear(origin, part, tile_x, tile_y);
    const TileGrid grid(part.hi);
    const auto tile = static_cast<std::size_t>(tile_y) * static_cast<std::size_t>(grid.across) +
                      static_cast<std::size_t>(tile_x);
    draw_triangles(tile);
    draw_casts(tile);
    return tile_;
}

void TileDrawer::clear(Vec2i origin, const Rect2i& part, int tile_x, int tile_y) {
    origin_ = origin;
    RasterTarget& target = tile_.target_;
    target.x = tile_x * raster_tile;
    target.y = tile_y * raster_tile;
    tile_.corner_ = {origin.x + target.x, origin.y + target.y};
    tile_.pixels_ = {{origin.x + std::max(target.x, part.lo.x), origin.y + std::max(target.y, part.lo.y)},
                     {origin.x + std::min(target.x + raster_tile, part.hi.x),
                      origin.y + std::min(target.y + raster_tile, part.hi.y)}};
    std::fill(nearness_.begin(), nearness_.end(), -infinity);
    std::fill(fragment_.begin(), fragment_.end(), raster_nothing);
    std::fill(std::begin(target.block_nearness), std::end(target.block_nearness), -infinity);
    std::fill(std::begin(target.block_changes), std::end(target.block_changes), 0u);
    tile_.met_.clear();
}

void TileDrawer::draw_triangles(std::size_t tile) {
    auto draw = [&](const TileIndex& index, TileBins RasterChunk::*bins, auto test) {
        // Those in front first: they hide what comes after before it has cost much.
        runs_.assign(index.of(tile).begin(), index.of(tile).end());
        std::sort(runs_.begin(), runs_.end(), [](const TileIndex::Entry& a, const TileIndex::Entry& b) {
            return a.q_max != b.q_max ? a.q_max > b.q_max : a.chunk < b.chunk;
        });
        for (const TileIndex::Entry& e : runs_) {
            const RasterChunk& chunk = geometry_.chunks[e.chunk];
            kernel_.draw(tile_.target_, {chunk.triangles.data(), chunk.corners.data(), chunk.planes.data(),
                                         (chunk.*bins).things().data() + e.begin, e.end - e.begin,
                                         FragmentNumber::of(e.chunk, 0, false), e.q_max, this, test});
        }
    };
    auto ask = [](void* owner, std::uint32_t number, std::int32_t x, std::int32_t y, std::uint32_t sample) {
        return static_cast<const TileDrawer*>(owner)->accept(number, x, y, sample);
    };
    draw(geometry_.solid, &RasterChunk::solid_bins, nullptr);
    // What may have holes comes after what has none: most of it is hidden by then, and needs no test.
    draw(geometry_.cutouts, &RasterChunk::cutout_bins, +ask);
}

std::optional<Ray> TileDrawer::ray_at(int x, int y, std::uint32_t sample) const {
    const Vec2 in_pixel = tile_.sample_place(sample);
    CameraSample at;
    at.film = {static_cast<float>(origin_.x + x) + in_pixel.x,
               static_cast<float>(origin_.y + y) + in_pixel.y};
    auto ray = camera_.ray(at);
    if (!ray) return std::nullopt;
    return ray->ray;
}

bool TileDrawer::accept(std::uint32_t number, int x, int y, std::uint32_t sample) const {
    const auto [surface, primitive] = tile_.fragment(number);
    auto ray = ray_at(x, y, sample);
    if (!ray) return false;
    const Ray local = surface->local_ray(*ray);
    const Intersection met = point_of_triangle(*surface->placed().shape->triangles(), primitive, local);
    return surface->object->is_there(local, surface->shape, primitive, met);
}

void TileDrawer::draw_casts(std::size_t tile) {
    casts_.clear();
    for (const TileIndex::Entry& e : geometry_.casts.of(tile))
        for (std::uint32_t i = e.begin; i < e.end; ++i) {
            const RasterChunk& chunk = geometry_.chunks[e.chunk];
            const std::uint32_t local = chunk.cast_bins.things()[i];
            casts_.push_back({&chunk.casts[local], FragmentNumber::of(e.chunk, local, true)});
        }
    // Those in front hide those behind before these have cost anything.
    std::stable_sort(casts_.begin(), casts_.end(), [](const NumberedCast& a, const NumberedCast& b) {
        return a.cast->q_max > b.cast->q_max;
    });
    for (const NumberedCast& cast : casts_) draw_cast(cast);
}

void TileDrawer::draw_cast(const NumberedCast& numbered) {
    const RasterCast& cast = *numbered.cast;
    const RasterTarget& target = tile_.target_;
    for (int by = 0; by < raster_blocks; ++by)
        for (int bx = 0; bx < raster_blocks; ++bx) {
            const int x = target.x + bx * raster_block, y = target.y + by * raster_block;
            const bool touches =
                cast.x0 < x + raster_block && cast.x1 > x && cast.y0 < y + raster_block && cast.y1 > y;
            if (touches && cast.q_max > target.block_nearness[by * raster_blocks + bx])
                cast_block(numbered, bx, by);
        }
}

void TileDrawer::cast_block(const NumberedCast& numbered, int bx, int by) {
    RasterTarget& target = tile_.target_;
    const RasterCast& cast = *numbered.cast;
    const int x0 = target.x + bx * raster_block, y0 = target.y + by * raster_block;
    const auto block = static_cast<std::size_t>(by * raster_blocks + bx);
    const std::size_t first = block * target.samples * raster_block_pixels;
    for (std::uint32_t s = 0; s < target.samples; ++s)
        for (int y = std::max<int>(y0, cast.y0); y < std::min<int>(y0 + raster_block, cast.y1); ++y)
            for (int x = std::max<int>(x0, cast.x0); x < std::min<int>(x0 + raster_block, cast.x1); ++x) {
                const std::size_t place = first + s * raster_block_pixels +
                                          static_cast<std::size_t>((y - y0) * raster_block + x - x0);
                if (cast.q_max > target.nearness[place]) cast_sample(numbered, x, y, s, place);
            }
    const float* nearness = target.nearness + first;
    target.block_nearness[block] =
        *std::min_element(nearness, nearness + target.samples * raster_block_pixels);
}

void TileDrawer::cast_sample(const NumberedCast& numbered, int x, int y, std::uint32_t sample,
                             std::size_t place) {
    RasterTarget& target = tile_.target_;
    auto ray = ray_at(x, y, sample);
    if (!ray) return;
    // What is farther need not be searched; a little more, since this is rounded.
    ray->tmax = distance_of(*ray, target.nearness[place]) * 1.0001f;
    float t = 0;
    std::uint32_t number = numbered.number;
    const bool hit = draws_[numbered.cast->draw].is_whole_object()
                         ? cast_object(*numbered.cast, *ray, t, number)
                         : cast_shape(*numbered.cast, *ray, t);
    if (!hit) return;
    const float q = nearness_of(*ray, t);
    if (!(q > target.nearness[place])) return;
    target.nearness[place] = q;
    target.fragment[place] = number;
}

bool TileDrawer::cast_shape(const RasterCast& cast, const Ray& ray, float& t) const {
    const Draw& draw = draws_[cast.draw];
    float shift = 0;
    const Ray local = draw.local_ray(ray, shift);
    Intersection met;
    if (!draw.placed().shape->intersect(local, cast.primitive, met)) return false;
    t = met.t + shift;
    return draw.object->is_there(local, draw.shape, cast.primitive, met);
}

bool TileDrawer::cast_object(const RasterCast& cast, const Ray& ray, float& t, std::uint32_t& number) {
    const Draw& draw = draws_[cast.draw];
    Found found;
    draw.object->closest(draw.local_ray(ray), found);
    if (!found.object) return false;
    const Object::Member member = found.object->member(found.hit.primitive);
    DrawnTile::Met met{draw, member.primitive};
    met.surface.object = found.object;
    met.surface.shape = member.shape;
    for (std::size_t i = 0; i < found.depth; ++i)
        met.surface.instances[met.surface.depth++] = found.instances[i];
    float shift = 0;
    met.surface.local_ray(ray, shift);
    t = found.hit.t + shift;
    number = FragmentNumber::of_met(tile_.met_.size());
    tile_.met_.push_back(met);
    return true;
}

// How near a point of a camera ray is.
float TileDrawer::nearness_of(const Ray& ray, float t) const {
    const auto& depth = projection_.film_from_world.m[2];
    const Vec3d p = Vec3d(ray.o) + Vec3d(ray.d) * static_cast<double>(t);
    const double z = depth[0] * p.x + depth[1] * p.y + depth[2] * p.z + depth[3];
    return static_cast<float>(projection_.is_perspective ? 1 / z : -z);
}

float TileDrawer::distance_of(const Ray& ray, float nearness) const {
    if (nearness == -infinity) return infinity;
    const auto& depth = projection_.film_from_world.m[2];
    const Vec3d o(ray.o), d(ray.d);
    const double from = depth[0] * o.x + depth[1] * o.y + depth[2] * o.z + depth[3];
    const double growth = depth[0] * d.x + depth[1] * d.y + depth[2] * d.z;
    const auto q = static_cast<double>(nearness);
    return static_cast<float>(((projection_.is_perspective ? 1 / q : -q) - from) / growth);
}

} // namespace alhazen
