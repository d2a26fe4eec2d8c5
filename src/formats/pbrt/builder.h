/// pbrt's directives, one function each, turned into a neutral scene. Behaviour after Pharr, Jakob and
/// Humphreys 2023, appendix C; each function's place is its directive's.
#pragma once

#include <filesystem>
#include <set>

#include "formats/pbrt/graphics_state.h"

namespace alhazen {

class PbrtBuilder {
  public:
    PbrtBuilder(std::filesystem::path file, std::filesystem::path base_folder, Messages& messages);

    const RgbColorSpace& color_space() const { return *scope_.state.color_space; }
    Messages& messages() { return messages_; }

    // Transformations of what follows.
    void identity(Place place);
    void translate(Vec3d v, Place place);
    void scale(Vec3d v, Place place);
    void rotate(double degrees, Vec3d axis, Place place);
    void look_at(Vec3d eye, Vec3d target, Vec3d up, Place place);
    /// m in the file's order, column after column.
    void transform(const std::array<double, 16>& m, Place place);
    void concat_transform(const std::array<double, 16>& m, Place place);
    void coordinate_system(const std::string& name, Place place);
    void coord_sys_transform(const std::string& name, Place place);
    void active_transform(std::string_view which, Place place);
    void transform_times(double start, double end, Place place);

    // Attributes.
    void attribute_begin(std::string directive, Place place);
    void attribute_end(std::string_view directive, Place place);
    /// node.type is the target.
    void attribute(Node node, Place place);
    void color_space(const std::string& name, Place place);
    void reverse_orientation(Place place);
    void medium_interface(std::string inside, std::string outside, Place place);
    void named_material(std::string name, Place place);
    void warn_transform_blocks(Place place);

    // The whole picture: before WorldBegin.
    void option(const std::string& name, Parameter value, Place place);
    void camera(Node node, Place place);
    void film(Node node, Place place) { set_one(scene_.film, "film", "Film", std::move(node), place); }
    void filter(Node node, Place place) {
        set_one(scene_.filter, "filter", "PixelFilter", std::move(node), place);
    }
    void sampler(Node node, Place place) {
        set_one(scene_.sampler, "sampler", "Sampler", std::move(node), place);
    }
    void integrator(Node node, Place place) {
        set_one(scene_.integrator, "integrator", "Integrator", std::move(node), place);
    }
    void accelerator(Node node, Place place) {
        set_one(scene_.accelerator, "accelerator", "Accelerator", std::move(node), place);
    }
    void world_begin(Place place);

    // The world.
    void shape(Node node, Place place);
    void light_source(Node node, Place place);
    void area_light_source(Node node, Place place);
    void material(Node node, Place place);
    /// In these two node.type is the new thing's name; its type is its parameter "type".
    void make_named_material(Node node, Place place);
    void make_named_medium(Node node, Place place);
    void texture(Node node, const std::string& value_type, Place place);
    void sdf(Node node, Place place);
    void object_begin(std::string name, Place place);
    void object_end(Place place);
    void object_instance(std::string name, Place place);

    /// Around an Import's file: what the file sets ends with it, what it makes stays.
    ImportScope begin_import();
    void end_import(ImportScope importer);
    bool in_world() const { return in_world_; }

    /// The scene, once all the text is read; end is the end of the file. Adds the errors only the whole can
    /// show.
    SceneDescription finish(Place end);

  private:
    bool check_options(std::string_view directive, const Place& place);
    bool check_world(std::string_view directive, const Place& place);
    void set_one(Node& target, std::string_view family, std::string_view directive, Node node,
                 const Place& place);
    /// Puts m behind the transformation in force, or in its place. text: of the directive, for messages, as
    /// a string or a function that makes one.
    template <class Text>
    void apply(const Matrix4& m, bool replace, const Text& text, const Place& place);
    void close_block(OpenBlock::Kind kind, std::string_view directive, const Place& place);
    void report_open_blocks();
    /// The parameters of Attribute directives that the node does not give itself.
    void add_defaults(Node& node, DefaultsOf of);
    /// Adds an error for each of an older pbrt's names; when lenient, puts today's in its place.
    void modernise(Node& node, std::string_view family);
    /// Makes node.type, which is the name, node.name, and the parameter "type" node.type.
    bool take_type(Node& node, std::string_view family, const Place& place);
    const NameInForce& use_medium(const NameInForce& medium);
    ObjectNode& target() { return object_ ? *object_ : scene_.world; }
    void check_names();

    Messages& messages_;
    SceneDescription scene_;
    ImportScope scope_;
    bool in_world_ = false;
    bool warned_transform_blocks_ = false;
    std::optional<ObjectNode> object_; ///< the one being defined
    std::set<std::string, std::less<>> object_names_, material_names_, medium_names_, float_textures_,
        spectrum_textures_, sdf_names_;
    /// What shapes, lights and cameras refer to, and where it was first named.
    std::map<std::string, Place, std::less<>> used_materials_, used_media_;
};

/// Adds an error for each object that contains itself, that is nested too deep, or that is not there.
void check_objects(const SceneDescription& scene, Messages& messages);

} // namespace alhazen
