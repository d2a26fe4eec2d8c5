#include "raster/rasterizer.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "base/threads.h"
#include "raster/dispatch.h"
#include "raster/tile_drawer.h"

namespace alhazen {

namespace {

/// The nearest that anything is seen, over the size of the scene: only numbers that cannot be divided by are
/// cut off.
constexpr double near_fraction = 1e-9;

} // namespace

Fragment DrawnTile::fragment(std::uint32_t number) const {
    if (FragmentNumber::is_met(number)) {
        const Met& met = met_[FragmentNumber::index(number)];
        return {&met.surface, met.primitive};
    }
    const RasterChunk& chunk = (*chunks_)[FragmentNumber::chunk(number)];
    const std::uint32_t local = FragmentNumber::local(number);
    if (FragmentNumber::is_cast(number))
        return {&(*draws_)[chunk.casts[local].draw], chunk.casts[local].primitive};
    return {&(*draws_)[chunk.triangles[local].draw], chunk.triangles[local].primitive};
}

Vec2 DrawnTile::sample_place(std::uint32_t sample) const {
    constexpr float pixel = 1.0f / raster_subpixels;
    return {static_cast<float>(target_.sample_x[sample]) * pixel,
            static_cast<float>(target_.sample_y[sample]) * pixel};
}

// Viewports start at fixed pixels, whatever part of the film is wanted, so that a crop shows the same bits.
void Rasterizer::run(const Rect2i& pixels, const Show& show) const {
    for (int y = pixels.lo.y / viewport_size * viewport_size; y < pixels.hi.y; y += viewport_size)
        for (int x = pixels.lo.x / viewport_size * viewport_size; x < pixels.hi.x; x += viewport_size)
            run_viewport(
                {x, y},
                {{std::max(pixels.lo.x - x, 0), std::max(pixels.lo.y - y, 0)},
                 {std::min(pixels.hi.x - x, viewport_size), std::min(pixels.hi.y - y, viewport_size)}},
                show);
}

void Rasterizer::run_viewport(Vec2i origin, const Rect2i& part, const Show& show) const {
    std::vector<Draw> draws = collect_draws(scene_, projection_, origin, part, samples_);
    if (left_out_)
        std::erase_if(draws, [&](const Draw& d) { return !d.is_whole_object() && &d.placed() == left_out_; });
    RasterView view;
    view.part = part;
    view.single_sample = samples_ == 1;
    view.is_perspective = projection_.is_perspective;
    view.near_depth = near_fraction * static_cast<double>(length(scene_.bounds().diagonal()));
    const RasterKernel& kernel = kernel_ ? *kernel_ : *supported_raster_kernels().front();
    const SortedGeometry geometry(std::move(draws), view, kernel);
    tbb::enumerable_thread_specific<TileDrawer> drawers(
        [&] { return TileDrawer(camera_, projection_, geometry, kernel, samples_); });
    const int x0 = part.lo.x / raster_tile, y0 = part.lo.y / raster_tile;
    const int across = (part.hi.x - 1) / raster_tile - x0 + 1, down = (part.hi.y - 1) / raster_tile - y0 + 1;
    parallel_for(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 1, [&](std::size_t i) {
        const int tile = static_cast<int>(i);
        show(drawers.local().draw(origin, part, x0 + tile % across, y0 + tile / across));
    });
}

} // namespace alhazen
