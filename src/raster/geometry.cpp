#include "raster/geometry.h"

#include "base/threads.h"
#include "raster/clip.h"

namespace alhazen {

namespace {

constexpr std::uint32_t chunk_size = 1024;

enum Side : std::uint8_t { left = 1, right = 2, above = 4, below = 8, behind = 16, beyond_guard = 32 };

/// A mesh's vertex on the film.
struct Vertex {
    ClipCorner clip;
    FilmCorner film;
    std::uint8_t sides;
};

class ChunkMaker {
  public:
    ChunkMaker(const std::vector<Draw>& draws, const RasterView& view, RasterChunk& chunk)
        : draws_(draws), view_(view), chunk_(chunk), grid_(view.part.hi) {}

    void make() {
        for (const RasterChunk::Run& run : chunk_.runs) {
            run_ = run;
            film_from_object_ = draws_[run.draw].film_from_object;
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
        chunk_.solid_bins.sort(solid_entries_, counters);
        chunk_.cutout_bins.sort(cutout_entries_, counters);
        chunk_.cast_bins.sort(cast_entries_, counters);
    }

  private:
    ClipCorner project(Vec3 p) const {
        const auto& m = film_from_object_.m;
        const Vec3d v(p);
        auto row = [&](std::size_t i) { return m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z + m[i][3]; };
        return {row(0), row(1), row(2), row(3)};
    }
    FilmCorner divide(const ClipCorner& c) const {
        if (!view_.is_perspective) return {c.x, c.y, -c.depth};
        const double inverse = 1 / c.w;
        return {c.x * inverse, c.y * inverse, inverse};
    }
    // False for NaN.
    static bool is_within_guard(const FilmCorner& c) {
        return c.x >= guard_low && c.x <= guard_high && c.y >= guard_low && c.y <= guard_high;
    }
    Vertex vertex(Vec3 p) const {
        Vertex v;
        v.clip = project(p);
        const ClipCorner& c = v.clip;
        const Rect2i& part = view_.part;
        auto bit = [](bool is_set, Side side) { return static_cast<std::uint8_t>(is_set ? side : 0); };
        v.sides =
            static_cast<std::uint8_t>(bit(c.x < part.lo.x * c.w, left) | bit(c.x > part.hi.x * c.w, right) |
                                      bit(c.y < part.lo.y * c.w, above) | bit(c.y > part.hi.y * c.w, below) |
                                      bit(!(c.depth >= view_.near_depth), behind));
        if (v.sides & behind) return v;
        v.film = divide(c);
        v.sides = static_cast<std::uint8_t>(v.sides | bit(!is_within_guard(v.film), beyond_guard));
        return v;
    }

    void add_triangles(const TriangleMesh& mesh) {
        const int* indices = mesh.indices.data() + std::size_t{3} * run_.first;
        const std::size_t count = std::size_t{3} * run_.count;
        const auto [lo, hi] = std::minmax_element(indices, indices + count);
        const int first = *lo, range = *hi - *lo + 1;
        // Vertices are shared by six triangles or so, mostly within the chunk.
        if (range <= static_cast<int>(count)) {
            std::vector<Vertex> vertices(static_cast<std::size_t>(range));
            for (std::size_t i = 0; i < vertices.size(); ++i)
                vertices[i] = vertex(mesh.P[static_cast<std::size_t>(first) + i]);
            auto at = [&](int i) -> const Vertex& { return vertices[static_cast<std::size_t>(i - first)]; };
            for (std::uint32_t i = 0; i < run_.count; ++i)
                add_triangle(at(indices[3 * i]), at(indices[3 * i + 1]), at(indices[3 * i + 2]),
                             run_.first + i);
        } else {
            for (std::uint32_t i = 0; i < run_.count; ++i) {
                auto [a, b, c] = mesh.vertices(run_.first + i);
                add_triangle(vertex(a), vertex(b), vertex(c), run_.first + i);
            }
        }
    }

    void add_triangle(const Vertex& a, const Vertex& b, const Vertex& c, std::uint32_t primitive) {
        if (a.sides & b.sides & c.sides & ~beyond_guard) return;
        if ((a.sides | b.sides | c.sides) & (behind | beyond_guard)) {
            add_clipped({a.clip, b.clip, c.clip}, primitive);
            return;
        }
        const std::array<FilmCorner, 3> corners{a.film, b.film, c.film};
        add(corners, nullptr, primitive);
    }

    void add_clipped(const std::array<ClipCorner, 3>& triangle, std::uint32_t primitive) {
        const ClipPolygon polygon = clip_triangle(triangle, view_.near_depth);
        if (polygon.count < 3) return;
        const NearnessPlane plane = exact_plane(triangle);
        std::array<FilmCorner, ClipPolygon::max_corners> corners;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            corners[i] = divide(polygon.corners[i]);
            if (!is_within_guard(corners[i])) return;
        }
        for (std::size_t i = 1; i + 1 < polygon.count; ++i)
            add({corners[0], corners[i], corners[i + 1]}, &plane, primitive);
    }

    // Of the whole triangle: a x + b y + c w = nearness w at the corners.
    NearnessPlane exact_plane(const std::array<ClipCorner, 3>& t) const {
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

    // plane: nullptr for that through the corners.
    void add(const std::array<FilmCorner, 3>& corners, const NearnessPlane* plane, std::uint32_t primitive) {
        auto triangle = set_up_triangle(corners, plane, view_.part, view_.single_sample);
        if (!triangle) return;
        triangle->draw = run_.draw;
        triangle->primitive = primitive;
        const auto number = static_cast<std::uint32_t>(chunk_.triangles.size());
        std::vector<TileBins::Entry>& entries = is_solid_ ? solid_entries_ : cutout_entries_;
        for_tiles(*triangle, [&](int tx, int ty) {
            if (!misses_tile(*triangle, tx, ty)) entries.push_back({tile_number(tx, ty), number});
        });
        chunk_.triangles.push_back(*triangle);
    }

    template <class Thing, class Visit>
    static void for_tiles(const Thing& thing, const Visit& visit) {
        for (int ty = thing.y0 / raster_tile; ty * raster_tile < thing.y1; ++ty)
            for (int tx = thing.x0 / raster_tile; tx * raster_tile < thing.x1; ++tx) visit(tx, ty);
    }
    std::uint32_t tile_number(int tx, int ty) const {
        return static_cast<std::uint32_t>(ty * grid_.across + tx);
    }

    // By the tile's corner that is farthest inside of each edge.
    static bool misses_tile(const RasterTriangle& t, int tx, int ty) {
        if (t.x1 - t.x0 <= raster_tile && t.y1 - t.y0 <= raster_tile) return false;
        constexpr std::int64_t side = std::int64_t{raster_tile} * raster_subpixels;
        for (std::size_t e = 0; e < 3; ++e) {
            const std::int64_t x = tx * side + (t.a[e] > 0 ? side : 0),
                               y = ty * side + (t.b[e] > 0 ? side : 0);
            if (t.a[e] * x + t.b[e] * y + t.c[e] < 0) return true;
        }
        return false;
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
        Vec2d lo(guard_high, guard_high), hi(guard_low, guard_low);
        double q_max = -static_cast<double>(infinity);
        for (int i = 0; i < 8; ++i) {
            const Vertex v = vertex(box.corner(i));
            all &= v.sides & ~beyond_guard;
            any |= v.sides;
            if (v.sides & behind) continue;
            lo = {std::min(lo.x, v.film.x), std::min(lo.y, v.film.y)};
            hi = {std::max(hi.x, v.film.x), std::max(hi.y, v.film.y)};
            q_max = std::max(q_max, v.film.q);
        }
        const bool is_endless = !is_finite(box.lo) || !is_finite(box.hi);
        if (all && !is_endless) return false;
        const Rect2i& part = view_.part;
        const Vec2d from(part.lo), to(part.hi);
        if (is_endless || (any & behind)) {
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
    RasterChunk& chunk_;
    TileGrid grid_;
    RasterChunk::Run run_{};
    Matrix4 film_from_object_;
    bool is_solid_ = true;
    std::vector<TileBins::Entry> solid_entries_, cutout_entries_, cast_entries_;
};

} // namespace

void TileBins::sort(const std::vector<Entry>& entries, std::vector<std::uint32_t>& counters) {
    for (const Entry& e : entries)
        if (counters[e.tile]++ == 0) runs_.push_back({e.tile, 0, 0});
    std::uint32_t place = 0;
    for (Run& run : runs_) {
        run.begin = place;
        place += counters[run.tile];
        run.end = place;
        counters[run.tile] = run.begin;
    }
    things_.resize(entries.size());
    for (const Entry& e : entries) things_[counters[e.tile]++] = e.thing;
    for (const Run& run : runs_) counters[run.tile] = 0;
}

TileIndex::TileIndex(const std::vector<RasterChunk>& chunks, TileBins RasterChunk::*bins, std::size_t tiles)
    : starts_(tiles + 1) {
    for (const RasterChunk& chunk : chunks)
        for (const TileBins::Run& run : (chunk.*bins).runs()) ++starts_[run.tile + 1];
    for (std::size_t i = 1; i <= tiles; ++i) starts_[i] += starts_[i - 1];
    entries_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t c = 0; c < chunks.size(); ++c)
        for (const TileBins::Run& run : (chunks[c].*bins).runs())
            entries_[next[run.tile]++] = {c, run.begin, run.end};
}

std::vector<RasterChunk> make_chunks(const std::vector<Draw>& draws, const RasterView& view) {
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
    parallel_for(chunks.size(), 1, [&](std::size_t i) { ChunkMaker(draws, view, chunks[i]).make(); });
    return chunks;
}

} // namespace alhazen
