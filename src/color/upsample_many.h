/// Spectra of many colours, as pictures have them.
#pragma once

#include <memory>
#include <span>

#include "color/upsample.h"

namespace alhazen {

/// Upsamples as upsample(space, rgb, out) does, to the same bits, and remembers for the next picture what it
/// has fitted. May be used from several threads.
class PictureUpsampler {
  public:
    explicit PictureUpsampler(const RgbColorSpace& space);
    ~PictureUpsampler();
    PictureUpsampler(PictureUpsampler&&) noexcept;
    PictureUpsampler& operator=(PictureUpsampler&&) noexcept;

    void operator()(std::span<const Vec3> rgb, std::span<SigmoidCoefficients> out) const;

  private:
    class Cells;
    std::unique_ptr<Cells> cells_;
};

} // namespace alhazen
