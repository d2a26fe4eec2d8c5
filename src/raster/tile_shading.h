/// From what is seen in a tile to its colours: each surface in a pixel is shaded once, after all is drawn.
#pragma once

#include <functional>
#include <span>

#include "color/even_samples.h"
#include "raster/film_rays.h"
#include "raster/rasterizer.h"
#include "raster/shading.h"

namespace alhazen {

class TileShading {
  public:
    /// camera has a projection; cone is what textures blur over, if anything. What is given must outlive
    /// this.
    TileShading(const Camera& camera, const LocalLights& lights, const LocalShading& shading,
                const PixelCone* cone)
        : camera_(camera), rays_(*camera.projection()), lights_(lights), shading_(shading), cone_(cone) {}

    /// Takes the light of some pixels, or of so many of their samples.
    using Take = std::function<void(std::span<const EvenSamples>)>;
    void shade(const DrawnTile& tile, const Take& take) const;

  private:
    class Shader;

    const Camera& camera_;
    FilmRays rays_;
    const LocalLights& lights_;
    const LocalShading& shading_;
    const PixelCone* cone_;
};

} // namespace alhazen
