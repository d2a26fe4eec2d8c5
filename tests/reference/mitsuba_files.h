/// Mitsuba's files as Alhazen reads them: meshes, an environment map, grids.
#pragma once

#include <filesystem>

#include "color/wavelengths.h"

namespace alhazen::testing {

/// Copies a scene of tests/reference/mitsuba and what it includes into a folder, with everything that they
/// name, made from Mitsuba's files:
/// - NAME.ply from meshes/NAME.obj, with the file's own texture coordinates (Mitsuba turns v over);
/// - NAME.exr, an environment map, 16 pixels for each of its own. Mitsuba blends pixels, of which the first
///   row stands for one pole alone and the last for the other, while Alhazen takes the nearest;
/// - NAME_panel.exr, NAME_projector.exr, NAME_spot.exr, what lights show with NAME.bmp in that mode, as
///   mitsuba_slides.h says; white_spot.exr, that of a spot without a picture;
/// - NAME_grid.pbrt from NAME.vol, as attributes of media: the density if it has one channel, else what it
///   is as sigma_t of rgb, .99 of which scatters. A layer of cells around it repeats the outer ones;
/// - other images are copied without alpha, which Mitsuba does not look at.
/// shared: the folder with common/ and tests/. The copied scene's path. Throws std::runtime_error.
std::filesystem::path copy_mitsuba_scene(const std::filesystem::path& scene,
                                         const std::filesystem::path& shared,
                                         const std::filesystem::path& folder, ColorMode mode);

} // namespace alhazen::testing
