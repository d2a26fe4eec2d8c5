/// Pictures that Mitsuba's lights show, as our lights take them.
#pragma once

#include "image/image.h"

namespace alhazen::testing {

/// The colours of light of equal energy at all wavelengths, times a picture's as fractions. Such light is
/// what Mitsuba's spectral pictures show of textures that shine by themselves (panels, projectors); rgb
/// values that shine do so in D65, as all light does here.
Image in_even_light(Image picture);

/// A picture as a Mitsuba texture shows it, blended between pixels and, across its borders, with the other
/// side: 8 by 8 pixels for each.
Image panel_picture(const Image& picture);

/// The intensity, over its largest, of a spot with that texture, whose edge is 30 and whose full beam 15
/// degrees off the axis, in between falling evenly with the angle; as a slide of 60 degrees, its first row
/// the texture's. An empty picture is white.
Image spot_slide(const Image& picture);

/// The intensity of a projector (50 mm) over pi, whose irradiance a picture says where a plane of distance 1
/// faces it: 8 by 8 pixels for each.
Image projector_slide(const Image& picture);

} // namespace alhazen::testing
