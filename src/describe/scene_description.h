/// The neutral scene: what every format produces and what the renderer is built from. Plain data with places
/// in the source; no format's words, no renderer's objects.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/transform.h"
#include "describe/value.h"

namespace alhazen {

struct RgbColorSpace; // color/color_space.h

/// One thing in a scene: its type ("diffuse"), its name if it has one, and its parameters.
struct Node {
    std::string type;
    std::string name;
    std::vector<Parameter> parameters;
    Place place;
    const RgbColorSpace* color_space = nullptr; ///< what is in effect where it stands; nullptr: sRGB

    const Parameter* find(std::string_view parameter) const;
    /// Where the parameter stands, or the node if it was not given: for messages.
    const Place& place_of(std::string_view parameter) const;
    /// Replaces the parameter of that name, or adds it.
    void set(Parameter parameter);
};

/// A transformation at the start and at the end of the motion.
struct Motion {
    Matrix4 start, end;
    bool is_animated() const { return !(start == end); }
    bool operator==(const Motion&) const = default;
};

struct CameraNode {
    Node node;
    Motion world_from_camera;
    std::string medium; ///< name of the medium the camera stands in, "" for none
};

struct TextureNode {
    Node node; ///< node.name is what parameters refer to
    bool is_spectrum = true;
    Motion world_from_texture;
};

struct LightNode {
    Node node;
    Motion world_from_light;
    std::string medium;
};

struct ShapeNode {
    Node node;
    Motion world_from_object;
    bool reverse_orientation = false;
    int material = -1; ///< index into SceneDescription::materials; -1: see material_name
    std::string
        material_name;   ///< a named material; "" with material -1 means the format's default, diffuse 0.5
    int area_light = -1; ///< index into SceneDescription::area_lights; -1 for none
    std::string inside_medium, outside_medium;
};

struct InstanceNode {
    std::string object;
    Motion world_from_instance;
    Place place;
};

/// Shapes (and instances of other objects) that are placed together.
struct ObjectNode {
    std::string name;
    Place place;
    std::deque<ShapeNode> shapes; ///< not moved again when there are more: there may be millions
    std::vector<InstanceNode> instances;
};

/// A whole scene. Families with one member hold a node whose type is "" where the format named none; the
/// renderer then takes the default (zsobol, gaussian, path ...).
struct SceneDescription {
    std::filesystem::path file;        ///< the scene file; empty when built in code
    std::filesystem::path base_folder; ///< relative file names are looked up from here

    std::vector<CameraNode> cameras; ///< the last is the default
    Node film, filter, sampler, integrator, accelerator;
    std::vector<Node> options;          ///< format options: type is the option's name, one parameter "value"
    float time_start = 0, time_end = 1; ///< when the two ends of Motion hold

    std::vector<TextureNode> textures; ///< a texture refers only to textures before it
    std::vector<TextureNode> sdfs;     ///< signed distance fields, as TextureNode: node and placement
    std::vector<Node> materials;       ///< anonymous and named ones together
    std::vector<Node> area_lights;
    std::vector<TextureNode> media; ///< as TextureNode: node and placement
    std::vector<LightNode> lights;
    std::vector<ObjectNode> objects; ///< definitions for instances
    ObjectNode world;                ///< what is in the scene itself
};

} // namespace alhazen
