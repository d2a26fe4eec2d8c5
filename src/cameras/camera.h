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

struct Camera {
    static constexpr std::string_view family_name = "camera";
    virtual ~Camera() = default;
    /// Whether rays depend on CameraSample::lens.
    virtual bool has_lens() const { return false; }
    /// nullopt where the film receives no light.
    virtual std::optional<CameraRay> ray(const CameraSample& sample) const = 0;
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
