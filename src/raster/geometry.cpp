#include "raster/geometry.h"

#include "base/threads.h"
#include "raster/clip.h"
#include "raster/setup.h"

namespace alhazen {

template <class Nearest>
void TileBins::sort(const std::vector<Entry>& entries, std::vector<std::uint32_t>& counters,
                    const Nearest& nearest) {
    for (const Entry& e : entries)
        if (counters[e.tile]++ == 0) runs_.push_back({e.tile, 0, 0, -infinity});
    std::uint32_t place = 0;
    for (Run& run : runs_) {
        run.begin = place;
        place += counters[run.tile];
        run.end = place;
        counters[run.tile] = run.begin;
    }
    things_.resize(entries.size());
    for (const Entry& e : entries) things_[counters[e.tile]++] = e.thing;
    for (Run& run : runs_) {
        counters[run.tile] = 0;
        for (std::uint32_t i = run.begin; i < run.end; ++i)
            run.q_max = std::max(run.q_max, nearest(things_[i]));
    }
}

namespace {

constexpr std::uint32_t chunk_size = 1024;

RasterProjection projection_of(const RasterView& view, const Matrix4& film_from_object) {
    RasterProjection p;
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c) p.rows[r][c] = film_from_object.m[r][c];
    p.left = view.part.lo.x;
    p.right = view.part.hi.x;
    p.above = view.part.lo.y;
    p.below = view.part.hi.y;
    p.near_depth = view.near_depth;
    p.is_perspective = view.is_perspective;
    return p;
}

class ChunkMaker {
  public:
    ChunkMaker(const std::vector<Draw>& draws, const RasterView& view, const RasterKernel& kernel,
               RasterChunk& chunk)
        : draws_(draws), view_(view), kernel_(kernel), chunk_(chunk), grid_(view.part.hi) {}

    void make() {
        for (const RasterChunk::Run& run : chunk_.runs) {
            run_ = run;
            projection_ = projection_of(view_, draws_[run.draw].film_from_object);
            if (draws_[run.draw].is_whole_object()) {
                add_cast(draws_[run.draw].object->bounds(), 0);
                continue;
            }
            is_solid_ = draws_[run.draw].object->is_solid(draws_[run.draw].shape);
            const Shape& shape = *draws_[run.draw].placed().shape;
            if (const TriangleMesh* mesh = shape.triangles())
                add_triangles(*mesh);
            else
                for (std::uint32_t i = 0; i < run.count; ++i)
                    add_cast(shape.bounds(run.first + i), run.first + i);
        }
        std::vector<std::uint32_t> counters(grid_.count());
        auto nearest = [this](std::uint32_t thing) { return chunk_.triangles[thing].q_max; };
        chunk_.solid_bins.sort(solid_entries_, counters, nearest);
        chunk_.cutout_bins.sort(cutout_entries_, counters, nearest);
        chunk_.cast_bins.sort(cast_entries_, counters,
                              [this](std::uint32_t thing) { return chunk_.casts[thing].q_max; });
    }

  private:
    void project(std::span<const Vec3> points, RasterCorner* corners, std::uint8_t* sides) const {
        static_assert(sizeof(Vec3) == 3 * sizeof(float));
        kernel_.project(projection_, &points.data()->x, points.size(), corners, sides);
    }
    // With the same bits as the kernel's.
    ClipCorner clip_corner(Vec3 p) const {
        const Vec3d v(p);
        auto row = [&](std::size_t r) {
            const auto& m = projection_.rows[r];
            return m[0] * v.x + m[1] * v.y + m[2] * v.z + m[3];
        };
        return {row(0), row(1), row(2), row(3)};
    }

    void add_triangles(const TriangleMesh& mesh) {
        const int* indices = mesh.indices.data() + std::size_t{3} * run_.first;
        const std::size_t count = std::size_t{3} * run_.count;
        const auto [lo, hi] = std::minmax_element(indices, indices + count);
        const std::size_t range = static_cast<std::size_t>(*hi - *lo) + 1;
        // Vertices are shared by six triangles or so, mostly within the chunk.
        const bool is_shared = range <= count;
        std::vector<Vec3> gathered(is_shared ? 0 : count);
        for (std::size_t i = 0; i < gathered.size(); ++i)
            gathered[i] = mesh.P[static_cast<std::size_t>(indices[i])];
        const std::span<const Vec3> points =
            is_shared ? std::span(mesh.P).subspan(static_cast<std::size_t>(*lo), range) : std::span(gathered);
        const std::size_t first = chunk_.corners.size();
        chunk_.corners.resize(first + points.size());
        sides_.resize(first + points.size());
        project(points, chunk_.corners.data() + first, sides_.data() + first);
        numbers_.resize(count);
        const int shift = static_cast<int>(first) - *lo;
        for (std::size_t i = 0; i < count; ++i)
            numbers_[i] =
                static_cast<std::uint16_t>(is_shared ? indices[i] + shift : static_cast<int>(first + i));
        for (RasterTriangle& t : culled()) {
            if (t.plane == RasterTriangle::to_clip) {
                auto corner = [&](std::size_t c) { return clip_corner(points[t.corner[c] - first]); };
                add_clipped({corner(0), corner(1), corner(2)}, run_.first + t.primitive);
            } else {
                t.primitive += run_.first;
                add(t);
            }
        }
    }

    // Those of the triangles with numbers_ for corners that may be seen.
    std::vector<RasterTriangle> culled() const {
        std::vector<RasterTriangle> kept(numbers_.size() / 3 + 1);
        const Rect2i& part = view_.part;
        kept.resize(kernel_.cull({part.lo.x, part.lo.y, part.hi.x, part.hi.y, view_.single_sample},
                                 chunk_.corners.data(), sides_.data(), numbers_.data(), numbers_.size() / 3,
                                 kept.data()));
        return kept;
    }

    void add_clipped(const std::array<ClipCorner, 3>& triangle, std::uint32_t primitive) {
        const ClipPolygon polygon = clip_triangle(triangle, view_.near_depth);
        if (polygon.count < 3) return;
        std::array<RasterCorner, ClipPolygon::max_corners> corners;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const ClipCorner& c = polygon.corners[i];
            const double inverse = view_.is_perspective ? 1 / c.w : 1;
            const double x = c.x * inverse, y = c.y * inverse;
            // False for NaN.
            const bool is_within = x >= raster_guard_low && x <= raster_guard_high && y >= raster_guard_low &&
                                   y <= raster_guard_high;
            if (!is_within) return;
            corners[i] = make_corner(x, y, view_.is_perspective ? inverse : -c.depth);
        }
        const std::size_t first = chunk_.corners.size();
        const auto plane = static_cast<std::uint16_t>(chunk_.planes.size());
        chunk_.corners.insert(chunk_.corners.end(), corners.begin(), corners.begin() + polygon.count);
        chunk_.planes.push_back(exact_plane(triangle));
        sides_.resize(chunk_.corners.size());
        numbers_.clear();
        for (std::size_t i = 1; i + 1 < polygon.count; ++i)
            for (std::size_t c : {first, first + i, first + i + 1})
                numbers_.push_back(static_cast<std::uint16_t>(c));
        for (RasterTriangle& t : culled()) {
            t.plane = plane;
            t.primitive = primitive;
            add(t);
        }
    }

    // Of the whole triangle: a x + b y + c w = nearness w at the corners.
    RasterPlane exact_plane(const std::array<ClipCorner, 3>& t) const {
        std::array<Vec3d, 3> v;
        Vec3d sum;
        for (std::size_t i = 0; i < 3; ++i) v[i] = {t[i].x, t[i].y, t[i].w};
        for (std::size_t i = 0; i < 3; ++i)
            sum += cross(v[(i + 1) % 3], v[(i + 2) % 3]) * (view_.is_perspective ? 1 : -t[i].depth);
        const double determinant = dot(v[0], cross(v[1], v[2]));
        if (!(std::abs(determinant) > 0)) return {};
        sum = sum * (1 / determinant);
        return {sum.z, sum.x, sum.y};
    }

    void add(RasterTriangle& triangle) {
        triangle.draw = run_.draw;
        const auto number = static_cast<std::uint32_t>(chunk_.triangles.size());
        std::vector<TileBins::Entry>& entries = is_solid_ ? solid_entries_ : cutout_entries_;
        auto corner = [&](std::size_t c) -> const RasterCorner& {
            return chunk_.corners[triangle.corner[c]];
        };
        for_tiles(triangle, [&](int tx, int ty) {
            if (!misses_tile(triangle, corner(0), corner(1), corner(2), tx, ty))
                entries.push_back({tile_number(tx, ty), number});
        });
        chunk_.triangles.push_back(triangle);
    }

    template <class Thing, class Visit>
    static void for_tiles(const Thing& thing, const Visit& visit) {
        for (int ty = thing.y0 / raster_tile; ty * raster_tile < thing.y1; ++ty)
            for (int tx = thing.x0 / raster_tile; tx * raster_tile < thing.x1; ++tx) visit(tx, ty);
    }
    std::uint32_t tile_number(int tx, int ty) const {
        return static_cast<std::uint32_t>(ty * grid_.across + tx);
    }

    void add_cast(const Bounds3& box, std::uint32_t primitive) {
        RasterCast cast;
        cast.draw = run_.draw;
        cast.primitive = primitive;
        if (!bound(box, cast)) return;
        const auto number = static_cast<std::uint32_t>(chunk_.casts.size());
        for_tiles(cast, [&](int tx, int ty) { cast_entries_.push_back({tile_number(tx, ty), number}); });
        chunk_.casts.push_back(cast);
    }

    // The pixels around the projected box, all where it is cut by the camera's plane; false: outside.
    bool bound(const Bounds3& box, RasterCast& cast) const {
        int all = 0xff, any = 0;
        Vec2d lo(raster_guard_high, raster_guard_high), hi(raster_guard_low, raster_guard_low);
        double q_max = -static_cast<double>(infinity);
        std::array<Vec3, 8> points;
        for (int i = 0; i < 8; ++i) points[static_cast<std::size_t>(i)] = box.corner(i);
        std::array<RasterCorner, 8> corners;
        std::array<std::uint8_t, 8> sides;
        project(points, corners.data(), sides.data());
        for (std::size_t i = 0; i < 8; ++i) {
            all &= sides[i] & ~raster_beyond_guard;
            any |= sides[i];
            if (sides[i] & raster_behind) continue;
            lo = {std::min(lo.x, corners[i].x), std::min(lo.y, corners[i].y)};
            hi = {std::max(hi.x, corners[i].x), std::max(hi.y, corners[i].y)};
            q_max = std::max(q_max, corners[i].q);
        }
        const bool is_endless = !is_finite(box.lo) || !is_finite(box.hi);
        if (all && !is_endless) return false;
        const Rect2i& part = view_.part;
        const Vec2d from(part.lo), to(part.hi);
        if (is_endless || (any & raster_behind)) {
            lo = from;
            hi = to;
        } else {
            cast.q_max = static_cast<float>(q_max + std::abs(q_max) * 1e-5);
        }
        auto pixel = [](double v, double least, double most) {
            return static_cast<std::int16_t>(std::clamp(v, least, most));
        };
        cast.x0 = pixel(std::floor(lo.x - 0.01), from.x, to.x);
        cast.y0 = pixel(std::floor(lo.y - 0.01), from.y, to.y);
        cast.x1 = pixel(std::ceil(hi.x + 0.01), from.x, to.x);
        cast.y1 = pixel(std::ceil(hi.y + 0.01), from.y, to.y);
        return cast.x0 < cast.x1 && cast.y0 < cast.y1;
    }

    const std::vector<Draw>& draws_;
    const RasterView& view_;
    const RasterKernel& kernel_;
    RasterChunk& chunk_;
    TileGrid grid_;
    RasterChunk::Run run_{};
    RasterProjection projection_{};
    std::vector<std::uint8_t> sides_;    ///< of the chunk's corners
    std::vector<std::uint16_t> numbers_; ///< of the corners of triangles, three each
    bool is_solid_ = true;
    std::vector<TileBins::Entry> solid_entries_, cutout_entries_, cast_entries_;
};

} // namespace

TileIndex::TileIndex(const std::vector<RasterChunk>& chunks, TileBins RasterChunk::*bins, std::size_t tiles)
    : starts_(tiles + 1) {
    for (const RasterChunk& chunk : chunks)
        for (const TileBins::Run& run : (chunk.*bins).runs()) ++starts_[run.tile + 1];
    for (std::size_t i = 1; i <= tiles; ++i) starts_[i] += starts_[i - 1];
    entries_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t c = 0; c < chunks.size(); ++c)
        for (const TileBins::Run& run : (chunks[c].*bins).runs())
            entries_[next[run.tile]++] = {c, run.begin, run.end, run.q_max};
}

std::vector<RasterChunk> make_chunks(const std::vector<Draw>& draws, const RasterView& view,
                                     const RasterKernel& kernel) {
    std::vector<RasterChunk> chunks;
    std::uint32_t room = 0; // in the last chunk
    for (std::uint32_t d = 0; d < draws.size(); ++d) {
        const std::uint32_t count =
            draws[d].is_whole_object() ? 1 : draws[d].placed().shape->primitive_count();
        for (std::uint32_t first = 0; first < count;) {
            if (room == 0) {
                chunks.emplace_back();
                room = chunk_size;
            }
            const std::uint32_t taken = std::min(room, count - first);
            chunks.back().runs.push_back({d, first, taken});
            first += taken;
            room -= taken;
        }
    }
    parallel_for(chunks.size(), 1, [&](std::size_t i) { ChunkMaker(draws, view, kernel, chunks[i]).make(); });
    return chunks;
}

} // namespace alhazen
