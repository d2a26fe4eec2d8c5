/// Cameras: rays from places on the film.
#pragma once

#include <optional>

#include "base/ray.h"
#include "cameras/projection.h"
#include "color/spectrum.h"
#include "describe/kind.h"

namespace alhazen {

/// Random numbers and places for one camera ray.
struct CameraSample {
    Vec2 film;      ///< pixels from the top left corner of the full film; pixel centres at .5
    Vec2 lens;      ///< in [0, 1)^2
    float time = 0; ///< in [0, 1), from shutter open to close
};

struct CameraRay {
    Ray ray; ///< world space, unit direction
    Spectrum weight = 1;
};

/// The way from a point of the scene to the camera.
struct CameraConnection {
    Vec3 p;            ///< where on the lens the camera ray to the point starts
    Vec3 d;            ///< its direction, unit
    Vec2 film;         ///< its place on the film, which may be outside of the picture
    float density = 0; ///< of camera rays, as Camera::ray_density() has it
};

struct Camera {
    static constexpr std::string_view family_name = "camera";
    virtual ~Camera() = default;
    /// Whether rays depend on CameraSample::time in more than their own time.
    virtual bool moves() const { return false; }
    /// Whether rays depend on CameraSample::lens.
    virtual bool has_lens() const { return false; }
    /// nullopt where the film receives no light.
    virtual std::optional<CameraRay> ray(const CameraSample& sample) const = 0;
    /// Whether light can be brought to it: sample_towards() and ray_density() are there. Rays of such cameras
    /// weigh 1.
    virtual bool receives_light() const { return false; }
    /// The camera ray to a point at a time (s), from a place on the lens chosen with u; nullopt where the
    /// camera does not look.
    virtual std::optional<CameraConnection> sample_towards(Vec3 /*p*/, Vec2 /*u*/, float /*time*/) const {
        return std::nullopt;
    }
    /// How dense camera rays are when their places are spread evenly over the whole film: of those that start
    /// where this one does (or, when all are parallel, along it), per area across the ray at the distance t.
    /// Since rays weigh 1, that is also the importance there (Veach 1997, section 8.3.2): what of light that
    /// is measured by the whole film a unit of flux adds, over the density of choosing the place on the lens.
    virtual float ray_density(const Ray& /*ray*/, float /*t*/) const { return 0; }
    /// The map whose rays these are; nullopt for cameras with a lens, or that bend straight lines.
    virtual std::optional<Projection> projection() const { return std::nullopt; }

    float shutteropen = 0;  ///< seconds
    float shutterclose = 1; ///< seconds

  protected:
    template <class T>
    static void describe_common(Fields<T>& f) {
        f.field("shutteropen", &T::shutteropen, "when the shutter opens").unit("seconds");
        f.field("shutterclose", &T::shutterclose, "when the shutter closes").unit("seconds");
        f.field("name", &T::name, "what --camera calls it");
    }

  public:
    std::string name;
};

/// finish() takes context.world_from_node, film_resolution, film_diagonal.
const KindList<Camera>& camera_kinds();

} // namespace alhazen
