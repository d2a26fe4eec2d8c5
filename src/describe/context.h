/// What nodes are built with: messages, folders, and what other nodes have been built already.
#pragma once

#include <filesystem>
#include <memory>

#include "base/messages.h"
#include "base/moving_transform.h"
#include "base/transform.h"
#include "color/wavelengths.h"
#include "describe/grid_file.h"
#include "describe/mesh_file.h"

namespace alhazen {

class TextureSet;  // textures/texture_set.h
struct TextureUse; // textures/texture_set.h
class MaterialSet; // materials/material_set.h
class SdfSet;      // sdf/sdf_set.h

/// Passed by reference through the building of a scene. Which of the later members are set is said by the
/// family.
struct BuildContext {
    Messages& messages;
    ColorMode color_mode = ColorMode::spectral;
    std::filesystem::path base_folder = {};
    const TextureSet* textures = nullptr;
    const MaterialSet* materials = nullptr;
    /// Of the texture being built: what its colours mean, and the images read so far. Set by TextureSet.
    const TextureUse* texture_use = nullptr;
    const MeshReader* mesh_reader = nullptr; ///< reads mesh files: shapes
    const GridReader* grid_reader = nullptr; ///< reads grid files: shapes
    const SdfSet* sdfs = nullptr;            ///< sdfs and shapes

    /// Of the node being built: shapes, lights, textures, cameras.
    Transform world_from_node = {};
    bool reverse_orientation = false;
    /// Full film resolution (pixels) and diagonal (metres): cameras.
    Vec2i film_resolution{1, 1};
    float film_diagonal = 0.035f;
    float displacement_edge_scale = 1; ///< displaced meshes: factor of their edges' lengths
    /// Shutter open to close: film sensors (seconds).
    float exposure_time = 1;
    float shutter_open = 0; ///< when (seconds): what moves and is asked for its place once
    /// Films; where the camera moves, camera_movement says how.
    Transform world_from_camera = {};
    std::shared_ptr<const MovingTransform> camera_movement = {};

    /// An existing path for a file a scene names: absolute, or relative to base_folder.
    std::filesystem::path resolve(const std::string& name) const {
        std::filesystem::path path(name);
        return path.is_absolute() ? path : base_folder / path;
    }
};

} // namespace alhazen
