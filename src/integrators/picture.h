/// Pictures that are made as a whole, rather than ray by ray: what the one who makes them gets, and what is
/// asked of them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cameras/camera.h"
#include "color/wavelengths.h"
#include "film/film.h"
#include "integrators/path_context.h"
#include "integrators/quadrature.h"
#include "scene/scene.h"

namespace alhazen {

/// A sample that was dropped because it was not a finite number.
struct BadSample {
    Vec2i pixel;
    int sample = 0;
};

/// What is counted while a picture is made.
struct PictureCounts {
    RayCounts rays;
    std::uint64_t bad_samples = 0; ///< dropped
    std::vector<BadSample> bad;    ///< of these, up to 1000

    void add_bad(Vec2i pixel, int sample) {
        ++bad_samples;
        if (bad.size() < 1000) bad.push_back({pixel, sample});
    }
    PictureCounts& operator+=(const PictureCounts& o) {
        rays += o.rays;
        bad_samples += o.bad_samples;
        for (const BadSample& b : o.bad)
            if (bad.size() < 1000) bad.push_back(b);
        return *this;
    }
};

/// What is wanted. All must outlive the work.
struct PictureOrder {
    const Scene& scene;
    const Camera& camera;
    Film& film; ///< started; its pixels are to be filled
    const Filter& filter;
    const Sampler& sampler; ///< prepared for the film and the samples
    ColorMode mode = ColorMode::rgb;
    int samples = 1; ///< a pixel
    std::uint64_t seed = 0;
    int paths_in_flight = 1; ///< that a thread should follow at a time; does not change the picture
};

/// The part of the whole film that is rendered, whose pixels alone have samples and paths of their own.
inline double rendered_fraction(const Film& film) {
    const Rect2i part = film.pixels();
    const Vec2i whole = film.resolution();
    return static_cast<double>(part.width()) * part.height() / (static_cast<double>(whole.x) * whole.y);
}

/// The work on one picture. It keeps what it needs from one pass to the next.
struct PictureWork {
    virtual ~PictureWork() = default;
    /// Rendering may be stopped after any of them.
    virtual int passes() const { return 1; }
    /// One pass, on the threads of the enclosing with_threads, in order from 0. The film must get the same
    /// bits whatever the threads. progress may be called from any thread with the fraction of the pass that
    /// is done.
    virtual PictureCounts run(int pass, const std::function<void(double fraction)>& progress) = 0;
    /// For those that integrate something known: how near they have come so far.
    virtual std::optional<Quadrature> quadrature() const { return std::nullopt; }
};

} // namespace alhazen
