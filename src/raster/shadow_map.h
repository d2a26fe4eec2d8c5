/// Shadow maps (Williams 1978): what each light sees, drawn with the rasteriser once; a point is lit where
/// nothing in the map is nearer to the light than it is. Several places of the map around the point are asked
/// and the answers averaged (percentage-closer filtering: Reeves, Salesin and Cook 1987).
#pragma once

#include "cameras/camera.h"
#include "raster/shading.h"

namespace alhazen {

struct ShadowMapOptions {
    int resolution = 1024; ///< texels on a side of a map; lights that shine to all sides have six
    int radius = 1;        ///< the filter asks 2 radius + 1 texels across and down
};

/// The eye of a light: a square picture without lens.
class ShadowCamera final : public Camera {
  public:
    /// Looks from the point along frame.z; half_size: tangent of the half angle, or half of the width.
    ShadowCamera(Vec3 from, const Frame& frame, float half_size, int resolution, bool is_perspective);
    std::optional<CameraRay> ray(const CameraSample& sample) const override;
    std::optional<Projection> projection() const override { return projection_; }

  private:
    Vec3d from_, x_, y_, z_;
    double half_size_, step_;
    Projection projection_;
};

class ShadowMaps final : public LightVisibility {
  public:
    ShadowMaps(const Scene& scene, const LocalLights& lights, const ShadowMapOptions& options);
    float lit(Vec3 p, Vec3 ng, std::size_t light, Vec3 wi) const override;

  private:
    struct Map {
        Projection projection;
        float texel = 0; ///< its width at depth 1, or at every depth
        std::vector<float> nearness;
    };
    struct LightMaps {
        std::vector<Map> maps;
    };
    Map draw(const Scene& scene, const LocalLight& light, Vec3 from, const Frame& frame, float half_size,
             bool is_perspective) const;
    LightMaps draw_light(const Scene& scene, const LocalLight& light) const;
    float lit(const Map& map, Vec3 point, Vec3 ng, Vec3 wi, bool& is_inside) const;

    int resolution_, radius_;
    std::vector<LightMaps> lights_;
};

} // namespace alhazen
