#include "render/surface_triangles.h"

#include <unordered_map>

#include <fmt/format.h>

#include "formats/ply.h"
#include "render/world.h"
#include "sdf/placed_sdf.h"

namespace alhazen {

namespace {

// Of the objects of a scene, each once; what is counted are the places of all of them.
class SurfaceCollector {
  public:
    SurfaceCollector(const SurfaceOptions& options, const ShapeSources& sources, const Place& scene,
                     Messages& messages)
        : options_(options), sources_(sources), scene_(scene), messages_(messages) {}

    // Empty when an error was added.
    std::vector<Corners> collect(const Object& root) {
        list(root);
        const Bounds3& box = parts_.back().box;
        const double longest = box.empty() ? 0 : static_cast<double>(max_component(box.diagonal()));
        if (!(longest > 0)) return fail("the scene has no surfaces");
        measure_stretch();
        cut(longest / options_.cells / 16);
        const double total = parts_.back().count;
        if (total == 0) return fail("the scene has no surfaces that can be cut into triangles");
        if (total > static_cast<double>(options_.most_triangles))
            return fail(fmt::format("the scene's surfaces would be {:.0f} triangles, instances repeated; at "
                                    "most {} are made (--max-triangles)",
                                    total, options_.most_triangles));
        triangles_.reserve(static_cast<std::size_t>(total));
        expand(parts_.back(), Matrix4{});
        return std::move(triangles_);
    }

  private:
    struct Part {
        const Object* object = nullptr;
        Bounds3 box;                    ///< around its surfaces and those of its instances
        double stretch = 0;             ///< no length grows by more on any way to the world
        std::vector<Corners> triangles; ///< its own
        double count = 0;               ///< with those of its instances; in whole numbers it might overflow
    };

    std::vector<Corners> fail(std::string text) {
        messages_.add_error(scene_, std::move(text));
        return {};
    }
    static bool is_surface(const PlacedShape& shape) {
        return !shape.material || !shape.material->is_interface();
    }
    Part& part_of(const PlacedObject& instance) { return parts_[index_.at(instance.object)]; }

    // Those that are placed in an object stand before it.
    void list(const Object& object) {
        if (index_.contains(&object)) return;
        Part part{&object, {}, 0, {}, 0};
        for (const PlacedObject& instance : object.instances()) {
            list(*instance.object);
            const Bounds3& box = part_of(instance).box;
            if (!box.empty()) part.box.extend(instance.world_from_object.bounds(box));
        }
        for (const PlacedShape& shape : object.shapes())
            for (std::uint32_t i = 0; is_surface(shape) && i < shape.shape->primitive_count(); ++i)
                part.box.extend(shape.shape->bounds(i));
        index_.emplace(&object, parts_.size());
        parts_.push_back(std::move(part));
    }

    void measure_stretch() {
        parts_.back().stretch = 1;
        for (std::size_t i = parts_.size(); i-- > 0;)
            for (const PlacedObject& instance : parts_[i].object->instances()) {
                double& inner = part_of(instance).stretch;
                inner =
                    std::max(inner, parts_[i].stretch * largest_stretch(instance.world_from_object.matrix()));
            }
    }

    // Also counts. What is too much in any case is not kept.
    void cut(double tolerance) {
        std::size_t kept = 0;
        for (Part& part : parts_) {
            auto add = [&](const Corners& t) {
                ++part.count;
                if (++kept <= options_.most_triangles) part.triangles.push_back(t);
            };
            for (const PlacedShape& shape : part.object->shapes())
                if (is_surface(shape) && !shape.shape->tessellate(tolerance / part.stretch, add))
                    warn_of_left_out(*shape.shape);
            for (const PlacedObject& instance : part.object->instances())
                part.count += part_of(instance).count;
        }
    }

    void warn_of_left_out(const Shape& shape) {
        const ShapeSource& source = sources_.at(&shape);
        messages_.add_warning(
            source.place,
            fmt::format("shape \"{}\" cannot be cut into triangles; it is left out", source.type));
    }

    void expand(const Part& part, const Matrix4& world_from_part) {
        const bool mirrors = world_from_part.determinant3() < 0;
        auto moved = [&](Vec3 p) { return Vec3(world_from_part.point(Vec3d(p))); };
        for (const Corners& t : part.triangles) {
            const Vec3 a = moved(t.a), b = moved(t.b), c = moved(t.c);
            triangles_.push_back(mirrors ? Corners{a, c, b} : Corners{a, b, c});
        }
        for (const PlacedObject& instance : part.object->instances())
            expand(part_of(instance), world_from_part * instance.world_from_object.matrix());
    }

    const SurfaceOptions& options_;
    const ShapeSources& sources_;
    const Place& scene_;
    Messages& messages_;
    std::vector<Part> parts_;
    std::unordered_map<const Object*, std::size_t> index_;
    std::vector<Corners> triangles_;
};

// Leaves what surfaces are made of, and says what of it moves.
void keep_surfaces(SceneDescription& description, Messages& messages) {
    const std::string moves = "what moves is taken where it is when the shutter opens";
    auto keep = [&](ObjectNode& object) {
        for (ShapeNode& shape : object.shapes) {
            shape.area_light = -1;
            shape.inside_medium.clear();
            shape.outside_medium.clear();
            if (shape.world_from_object.is_animated()) messages.add_warning(shape.node.place, moves);
        }
        for (const InstanceNode& instance : object.instances)
            if (instance.world_from_instance.is_animated()) messages.add_warning(instance.place, moves);
    };
    keep(description.world);
    for (ObjectNode& object : description.objects) keep(object);
    for (CameraNode& camera : description.cameras) camera.medium.clear();
    for (Node* node : {&description.film, &description.filter, &description.sampler, &description.integrator,
                       &description.accelerator})
        *node = {};
    // The one that sees everything, so that nothing is said to be unseen.
    description.integrator.type = "volpath";
    description.area_lights.clear();
    description.lights.clear();
    description.media.clear();
}

} // namespace

std::vector<Corners> surface_triangles(SceneDescription description, const SurfaceOptions& options,
                                       Messages& messages) {
    const Place scene = description.file.empty() ? Place{} : Place::of_file(description.file.string());
    keep_surfaces(description, messages);
    RenderSettings settings;
    settings.accel = AccelChoice{"lbvh", "stack", {}}; // built soonest; no ray will be traced
    ShapeSources sources;
    const auto world = build_world(std::move(description), settings, messages, &sources);
    auto triangles = SurfaceCollector(options, sources, scene, messages).collect(world->scene->root());
    messages.throw_if_errors();
    return triangles;
}

std::vector<Corners> mesh_triangles(const std::filesystem::path& file) {
    MeshData mesh = read_ply(file);
    split_quads(mesh);
    if (mesh.indices.empty()) throw std::runtime_error("it holds no triangles");
    std::vector<Corners> triangles;
    auto corner = [&](std::size_t i) { return mesh.P[static_cast<std::size_t>(mesh.indices[i])]; };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
    return triangles;
}

} // namespace alhazen
