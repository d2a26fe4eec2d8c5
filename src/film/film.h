/// Films: pixels from samples.
#pragma once

#include <span>
#include <string>

#include "base/bounds.h"
#include "color/even_samples.h"
#include "color/wavelengths.h"
#include "describe/kind.h"
#include "film/filter.h"
#include "film/visible_surface.h"
#include "image/image.h"

namespace alhazen {

/// A film's parameters and its pixels. A pixel's samples must be added in sample order by one thread at a
/// time; different pixels may be added to from different threads.
struct Film {
    static constexpr std::string_view family_name = "film";
    virtual ~Film() = default;

    virtual Vec2i resolution() const = 0;
    /// The part that is rendered: crop window or pixel bounds; inside the full resolution.
    virtual Rect2i pixels() const = 0;
    /// Replaces size or crop (from the command line); before start().
    virtual void set_resolution(Vec2i resolution) = 0;
    virtual void set_pixels(Rect2i pixels) = 0;
    virtual std::string filename() const = 0;
    virtual float diagonal() const = 0; ///< metres
    virtual bool half_float() const = 0;
    virtual bool linear_transfer() const = 0; ///< 8-bit files hold linear values

    /// Makes the pixels, all black.
    virtual void start(ColorMode mode) = 0;
    /// Adds one sample. L must be finite. weight is the filter's, of either sign and of mean 1 over all
    /// samples there could be (FilterSample); the pixel is the filtered L, and L itself where all samples
    /// agree.
    virtual void add(Vec2i pixel, Spectrum L, const Wavelengths& lambda, float weight) = 0;

    /// Adds such samples, whose weights are 1, in their order.
    virtual void add_even(std::span<const EvenSamples> all) {
        for (const EvenSamples& samples : all)
            for (int i = 0; i < samples.count; ++i) add(samples.pixel, samples.L, Wavelengths::rgb(), 1);
    }

    /// Whether add_surface() does something; the film is then for integrators that follow camera rays one by
    /// one only.
    virtual bool wants_surfaces() const { return false; }
    /// What a sample sees first, if there is a surface.
    virtual void add_surface(Vec2i /*pixel*/, const VisibleSurface&) {}
    /// The wavelengths of a sample; u in [0, 1). Spectral mode only.
    virtual Wavelengths sample_wavelengths(float u) const { return Wavelengths::sample_visible(u); }

    /// Whether light can be brought to any place, from any thread at any time, to be spread by the filter;
    /// the functions for such splats are for films that take them only.
    virtual bool takes_splats() const { return false; }
    /// Makes the film ready for splats; after start(). Those in layer 0 are part of the picture; layers 1 to
    /// more_layers are pictures of their own.
    virtual void start_splats(const Filter& /*filter*/, std::size_t /*more_layers*/ = 0) {}
    /// Adds a splat at a place in pixels (CameraSample::film), whose L must be finite. Only where there is
    /// light is anything added, so nobody knows of how many: it counts times set_splat_scale().
    virtual void add_splat(Vec2 /*position*/, Spectrum /*L*/, const Wavelengths&, std::size_t /*layer*/ = 0) {
    }
    virtual Image splat_image(std::size_t /*layer*/) const { return {}; }
    /// Whether a splat there touches a pixel.
    virtual bool splat_reaches(Vec2 /*position*/) const { return false; }
    virtual void set_splat_scale(double /*scale*/) {}

    /// What the sensor measures of a sample: values that add up, for those who make pixels in other ways than
    /// add().
    virtual Vec3 measure(Spectrum /*L*/, const Wavelengths&) const { return {}; }
    /// Makes a pixel show what was measured, instead of what was added before.
    virtual void set(Vec2i /*pixel*/, Vec3d /*measured*/) {}
    /// What is there so far, as linear RGB: pixels().width() x pixels().height().
    virtual Image image() const = 0;
};

/// finish() takes context.exposure_time, world_from_camera and camera_movement.
const KindList<Film>& film_kinds();

} // namespace alhazen
