#include "render/build_scene.h"

#include <algorithm>
#include <span>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/threads.h"
#include "lights/area_light.h"
#include "shapes/triangle_pair.h"

namespace alhazen {

namespace {

class SceneBuilder {
  public:
    SceneBuilder(SceneDescription& description, const MaterialSet& materials, const MediumSet& media,
                 const AccelChoice& accel, BuildContext& context, ShapeSources* sources)
        : description_(description), materials_(materials), media_(media), accel_(accel), context_(context),
          sources_(sources) {}

    std::unique_ptr<Scene> build() {
        build_lights();
        for (std::size_t i = 0; i < description_.objects.size(); ++i)
            index_.emplace(description_.objects[i].name, i);
        objects_.resize(description_.objects.size());
        is_open_.resize(objects_.size());
        for (std::size_t i = 0; i < objects_.size(); ++i) object(i);
        std::unique_ptr<Object> root = make_object(description_.world);
        if (context_.messages.error_count() > 0) return nullptr;
        for (auto& object : moving_) objects_.push_back(std::move(object));
        objects_.push_back(std::move(root));
        return std::make_unique<Scene>(std::move(objects_), std::move(lights_));
    }

  private:
    void build_lights() {
        for (const LightNode& node : description_.lights) {
            if (node.world_from_light.is_animated())
                context_.messages.add_warning(node.node.place,
                                              "lights do not move (nor do they in pbrt-v4): this one "
                                              "stays where it is at the start of the motion");
            context_.world_from_node = placement(node.world_from_light, node.node.place);
            if (auto light = light_kinds().make(node.node, context_, "")) lights_.push_back(std::move(light));
        }
    }

    Transform placement(const Motion& motion, const Place& place) {
        const Transform made(motion.start); // the identity, where that cannot be inverted
        if (!(made.matrix() == motion.start))
            context_.messages.add_error(place, "the transformation here is not invertible");
        return made;
    }

    // The finished object; nullptr with an error added when it cannot be had.
    const Object* object(std::size_t i) {
        if (objects_[i]) return objects_[i].get();
        const Place& place = description_.objects[i].place;
        if (is_open_[i]) {
            context_.messages.add_error(
                place, fmt::format("object \"{}\" contains itself", description_.objects[i].name));
            return nullptr;
        }
        is_open_[i] = true;
        auto made = make_object(description_.objects[i]);
        is_open_[i] = false;
        if (made->height() > Found::max_depth) {
            context_.messages.add_error(
                place, fmt::format("object \"{}\" nests instances {} deep; at most {} are possible",
                                   description_.objects[i].name, made->height(), Found::max_depth));
            made = std::make_unique<Object>(std::vector<PlacedShape>{}, std::vector<PlacedObject>{});
        }
        objects_[i] = std::move(made);
        return objects_[i].get();
    }

    std::unique_ptr<Object> make_object(ObjectNode& node) {
        std::vector<PlacedObject> instances;
        for (const InstanceNode& instance : node.instances) {
            auto found = index_.find(instance.object);
            if (found == index_.end()) {
                std::vector<std::string> names;
                for (const ObjectNode& o : description_.objects) names.push_back(o.name);
                context_.messages.add_error(instance.place,
                                            fmt::format("unknown object \"{}\"{}", instance.object,
                                                        did_you_mean(instance.object, names)));
                continue;
            }
            PlacedObject placed;
            placed.object = object(found->second);
            place_instance(placed, instance.world_from_instance, instance.place);
            if (placed.object && !placed.object->bounds().empty()) instances.push_back(placed);
        }
        move_shapes(node, instances);
        return std::make_unique<Object>(make_shapes(node), std::move(instances), accel_);
    }

    void place_instance(PlacedObject& placed, const Motion& motion, const Place& place) {
        placed.number = instance_count_++;
        if (!motion.is_animated()) {
            placed.world_from_object = placement(motion, place);
        } else if (auto movement = MovingTransform::make(motion.start, motion.end, description_.time_start,
                                                         description_.time_end)) {
            placed.world_from_object = movement->at(context_.shutter_open);
            placed.movement = std::make_shared<const MovingTransform>(*movement);
        } else {
            context_.messages.add_error(place, std::string(no_movement));
        }
        placed.object_from_world = placed.world_from_object.inverse();
    }

    // Takes the node's shapes that move out of it, into objects that are placed by their motion: those that
    // follow each other and move in the same way into one.
    void move_shapes(ObjectNode& node, std::vector<PlacedObject>& instances) {
        const auto moves = [](const ShapeNode& shape) { return shape.world_from_object.is_animated(); };
        if (std::any_of(node.shapes.begin(), node.shapes.end(), moves)) take_moving(node, instances);
        std::erase_if(instances, [](const PlacedObject& placed) { return placed.object->bounds().empty(); });
    }
    void take_moving(ObjectNode& node, std::vector<PlacedObject>& instances) {
        std::deque<ShapeNode> still;
        std::vector<std::pair<Motion, ObjectNode>> moving;
        bool follows = false; // the shape before moves, too
        for (ShapeNode& shape : node.shapes) {
            Motion motion = std::exchange(shape.world_from_object, {});
            if (motion.is_animated() && shape.area_light >= 0) {
                context_.messages.add_unsupported(
                    shape.node.place, "area lights that move are not supported (nor are they in pbrt-v4)",
                    "the place at the start of the motion");
                motion.end = motion.start;
            }
            if (!motion.is_animated()) {
                shape.world_from_object = motion;
                still.push_back(std::move(shape));
                follows = false;
                continue;
            }
            if (!follows || !(moving.back().first == motion)) moving.push_back({motion, {}});
            moving.back().second.shapes.push_back(std::move(shape));
            follows = true;
        }
        node.shapes = std::move(still);
        for (auto& [motion, inner] : moving) instances.push_back(moving_instance(motion, inner));
    }

    PlacedObject moving_instance(const Motion& motion, ObjectNode& inner) {
        inner.place = inner.shapes.front().node.place;
        PlacedObject placed;
        moving_.push_back(make_object(inner));
        placed.object = moving_.back().get();
        place_instance(placed, motion, inner.place);
        return placed;
    }

    // Shapes load in parallel; messages and lights keep the order of the file. Of many, what is said of them
    // is freed as they are made, so that both are never there at once.
    std::vector<PlacedShape> make_shapes(ObjectNode& node) {
        constexpr std::size_t many = 8192;
        std::vector<PlacedShape> shapes(node.shapes.size());
        for (std::size_t first = 0; first < shapes.size(); first += many) {
            const std::size_t count = std::min(many, shapes.size() - first);
            make_some_shapes(node, std::span(shapes).subspan(first, count));
            node.shapes.erase(node.shapes.begin(), node.shapes.begin() + static_cast<std::ptrdiff_t>(count));
        }
        std::erase_if(shapes, [](const PlacedShape& s) { return !s.shape; });
        return shapes;
    }

    // The node's first ones.
    void make_some_shapes(ObjectNode& node, std::span<PlacedShape> shapes) {
        parallel_for(shapes.size(), 1, [&](std::size_t i) {
            ShapeNode& source = node.shapes[i];
            BuildContext context = context_;
            context.world_from_node = placement(source.world_from_object, source.node.place);
            context.reverse_orientation = source.reverse_orientation;
            shapes[i].shape = shape_kinds().make(source.node, context, "");
            source.node.parameters = {}; // the arrays have been read; free them
        });
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            if (!shapes[i].shape) continue;
            const ShapeNode& source = node.shapes[i];
            if (sources_)
                sources_->emplace(shapes[i].shape.get(), ShapeSource{source.node.type, source.node.place});
            shapes[i].material = material_of(source);
            shapes[i].media = {medium(source.inside_medium, source), medium(source.outside_medium, source)};
            if (source.area_light >= 0) add_area_lights(node, source, shapes[i]);
        }
    }

    const Material* material_of(const ShapeNode& shape) {
        if (shape.material >= 0) return materials_.at(static_cast<std::size_t>(shape.material));
        if (shape.material_name.empty())
            return materials_.at(materials_.size() - 1); // the default, built last
        const Material* material = materials_.find(shape.material_name);
        // One that was given but had errors has told them already.
        if (!material && !materials_.has(shape.material_name))
            context_.messages.add_error(shape.node.place,
                                        fmt::format("unknown material \"{}\"{}", shape.material_name,
                                                    did_you_mean(shape.material_name, materials_.names())));
        return material;
    }

    const Medium* medium(const std::string& name, const ShapeNode& shape) {
        return media_.find(name, shape.node.place, context_.messages);
    }

    void add_area_lights(const ObjectNode& object, const ShapeNode& node, PlacedShape& placed) {
        const Node& light_node = description_.area_lights[static_cast<std::size_t>(node.area_light)];
        if (&object != &description_.world) {
            context_.messages.add_warning(
                node.node.place,
                "area lights do not shine in objects that are instanced; this shape is dark");
            return;
        }
        if (placed.material && placed.material->is_interface()) {
            context_.messages.add_warning(
                node.node.place,
                "a border between media, with material \"interface\", cannot be an area light; it is dark");
            return;
        }
        if (!placed.shape->can_be_light()) {
            context_.messages.add_error(
                node.node.place,
                fmt::format("shape \"{}\" cannot be an area light; take another shape, or no AreaLightSource",
                            node.node.type));
            return;
        }
        auto pattern = area_light_kinds().make(light_node, context_, "");
        if (!pattern) return;
        const std::uint32_t count = placed.shape->primitive_count();
        while (placed.lights.size() < count) {
            const auto i = static_cast<std::uint32_t>(placed.lights.size());
            const TriangleMesh* mesh = pattern->may_join() ? placed.shape->triangles() : nullptr;
            std::unique_ptr<TrianglePair> pair = mesh ? TrianglePair::make(*mesh, i) : nullptr;
            auto light = pair ? pattern->attach(*pair, 0) : pattern->attach(*placed.shape, i);
            placed.lights.insert(placed.lights.end(), pair ? 2 : 1, light.get());
            if (pair) placed.joined.push_back(std::move(pair));
            if (light) lights_.push_back(std::move(light));
        }
    }

    SceneDescription& description_;
    const MaterialSet& materials_;
    const MediumSet& media_;
    const AccelChoice& accel_;
    BuildContext& context_;
    ShapeSources* sources_;
    std::vector<std::unique_ptr<Light>> lights_;
    std::vector<std::unique_ptr<Object>> objects_;
    std::vector<std::unique_ptr<Object>> moving_; ///< of shapes that move
    std::vector<char> is_open_;                   ///< objects that are being made
    std::unordered_map<std::string, std::size_t> index_;
    std::uint32_t instance_count_ = 0;
};

} // namespace

std::unique_ptr<Scene> build_scene(SceneDescription& description, const MaterialSet& materials,
                                   const MediumSet& media, const AccelChoice& accel, BuildContext& context,
                                   ShapeSources* sources) {
    return SceneBuilder(description, materials, media, accel, context, sources).build();
}

} // namespace alhazen
