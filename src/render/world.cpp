#include "render/world.h"

#include <fmt/format.h>

#include "base/threads.h"
#include "cameras/moving_camera.h"
#include "cameras/pixel_cone.h"
#include "formats/grids.h"
#include "formats/ply.h"
#include "render/accelerator.h"
#include "render/flight.h"
#include "sdf/sdf_set.h"

namespace alhazen {

namespace {

/// The node, with the type the program falls back to when the scene names none.
Node with_default(Node node, std::string_view type) {
    if (node.type.empty()) node.type = type;
    return node;
}

template <class Family>
Node replaced_kind(const KindList<Family>& kinds, Node node, const std::string& type, Messages& messages) {
    const Kind<Family>* kind = kinds.find(type);
    if (!kind) {
        messages.add_error({}, fmt::format("unknown {} \"{}\"{}", Family::family_name, type,
                                           did_you_mean(type, kinds.names())));
        return node;
    }
    KindDoc doc = kind->doc();
    std::erase_if(node.parameters, [&](const Parameter& p) {
        return std::none_of(doc.fields.begin(), doc.fields.end(),
                            [&](const FieldDoc& f) { return f.name == p.name; });
    });
    node.type = type;
    return node;
}

std::unique_ptr<Film> make_film(const SceneDescription& description, const RenderSettings& settings,
                                BuildContext& context) {
    auto film = film_kinds().make(with_default(description.film, "rgb"), context, "rgb");
    if (!film) return nullptr;
    if (settings.size) film->set_resolution(*settings.size);
    if (settings.crop) {
        Vec2i full = film->resolution();
        Rect2i r = *settings.crop;
        if (r.lo.x < 0 || r.lo.y < 0 || r.hi.x > full.x || r.hi.y > full.y || r.empty())
            context.messages.add_error(
                {}, fmt::format("--crop {},{},{},{} is empty or outside the film of {} x {} "
                                "pixels",
                                r.lo.x, r.lo.y, r.hi.x, r.hi.y, full.x, full.y));
        else
            film->set_pixels(r);
    }
    return film;
}

const CameraNode* find_camera(const SceneDescription& description, const RenderSettings& settings,
                              Messages& messages) {
    if (settings.camera.empty()) return description.cameras.empty() ? nullptr : &description.cameras.back();
    std::vector<std::string> names;
    for (const CameraNode& camera : description.cameras) {
        if (camera.node.name == settings.camera) return &camera;
        if (!camera.node.name.empty()) names.push_back(camera.node.name);
    }
    messages.add_error({}, fmt::format("no camera is named \"{}\"{}", settings.camera,
                                       did_you_mean(settings.camera, names)));
    return nullptr;
}

std::unique_ptr<Camera> make_camera(const CameraNode& node, BuildContext& context) {
    const Motion& motion = node.world_from_camera;
    if (motion.is_animated() && !context.camera_movement) {
        context.messages.add_error(node.node.place, std::string(no_movement));
        return nullptr;
    }
    context.world_from_node = motion.is_animated() ? Transform() : Transform(motion.start);
    auto camera = camera_kinds().make(node.node, context, "perspective");
    return camera && motion.is_animated() ? make_moving_camera(std::move(camera), *context.camera_movement)
                                          : std::move(camera);
}

// The shutter's times, which others need before the camera is built.
void read_shutter(const CameraNode& camera, BuildContext& context) {
    auto number = [&](std::string_view name, float otherwise) {
        const Parameter* p = camera.node.find(name);
        auto* v = p ? std::get_if<std::vector<float>>(&p->values) : nullptr;
        return v && v->size() == 1 ? v->front() : otherwise;
    };
    // As cameras do, which tell of it.
    const auto [open, close] = std::minmax({number("shutteropen", 0), number("shutterclose", 1)});
    context.shutter_open = open;
    context.exposure_time = close - open;
}

// What the camera sees first is known of integrators that look from it.
void check_surfaces(const World& world, const Node& integrator, const Node& film, BuildContext& context) {
    if (world.integrator && world.film && world.film->wants_surfaces() &&
        !world.integrator->follows_camera_rays())
        context.messages.add_error(
            film.place, fmt::format("film \"{}\" needs camera rays that are followed one by one, which "
                                    "integrator \"{}\" does not do; use film \"rgb\", or integrator \"path\"",
                                    film.type, integrator.type));
}

// Light that is brought to the camera needs one that can say where on the film it arrives, and a film that
// takes it.
void check_light_tracing(const World& world, const Node& integrator, const CameraNode& camera,
                         const Node& film, BuildContext& context) {
    if (!world.integrator) return;
    const bool splats = world.integrator->makes_splats();
    if (splats && world.camera && !world.camera->receives_light())
        context.messages.add_error(
            camera.node.place,
            fmt::format(
                "integrator \"{}\" joins paths from the lights with the camera, which is not possible with "
                "camera \"{}\"{}; use a \"perspective\" or \"orthographic\" camera{}, or integrator \"path\"",
                integrator.type, camera.node.type, world.camera->moves() ? " that moves like this" : "",
                world.camera->moves() ? " that is only moved and turned" : ""));
    if ((splats || world.integrator->sets_pixels()) && world.film && !world.film->takes_splats())
        context.messages.add_error(
            film.place,
            fmt::format("integrator \"{}\" brings light to any pixel, which is not possible with film "
                        "\"{}\"; use film \"rgb\", or integrator \"path\"",
                        integrator.type, film.type));
}

std::uint64_t find_seed(const SceneDescription& description, const RenderSettings& settings) {
    if (settings.seed) return *settings.seed;
    auto integer = [](const Parameter* p) -> std::optional<std::uint64_t> {
        auto* v = p ? std::get_if<std::vector<int>>(&p->values) : nullptr;
        if (!v || v->empty()) return std::nullopt;
        return static_cast<std::uint64_t>(v->front());
    };
    if (auto seed = integer(description.sampler.find("seed"))) return *seed;
    for (const Node& option : description.options)
        if (option.type == "seed" && !option.parameters.empty())
            if (auto seed = integer(&option.parameters.front())) return *seed;
    return 0;
}

AccelChoice choose_accel(const SceneDescription& description, const RenderSettings& settings,
                         BuildContext& context) {
    auto accelerator = accelerator_kinds().make(with_default(description.accelerator, "bvh"), context, "bvh");
    AccelChoice choice = accelerator ? accelerator->choice : AccelChoice{};
    int entries = settings.stack_entries.value_or(choice.walk_options.stack_entries);
    if (settings.accel) choice = *settings.accel;
    choice.walk_options.stack_entries = entries;
    return choice;
}

void approximate(Scene& scene, int cells, const Place& place, Messages& messages) {
    try {
        scene.approximate(cells);
    } catch (const std::runtime_error& e) {
        messages.add_error(place, e.what());
    }
}

void choose_color_mode(World& world, const RenderSettings& settings, Messages& messages) {
    if (world.integrator && world.integrator->works_in_rgb()) {
        world.mode = ColorMode::rgb;
        if (settings.color == ColorMode::spectral)
            messages.add_warning({}, "this integrator is defined in linear RGB; --color spectral is ignored");
    } else {
        world.mode = settings.color.value_or(ColorMode::spectral);
    }
}

void add_sampler(World& world, const SceneDescription& description, const RenderSettings& settings,
                 BuildContext& context) {
    world.sampler = sampler_kinds().make(with_default(description.sampler, "zsobol"), context, "zsobol");
    if (!world.sampler) return;
    auto samples = [&] {
        const int own = world.sampler->samples_per_pixel();
        return world.integrator ? world.integrator->samples_per_pixel(own, settings.spp)
                                : settings.spp.value_or(own);
    };
    world.seed = find_seed(description, settings);
    world.sampler->prepare(context.film_resolution, samples(), world.seed);
    // Sequences may come in powers of two, but the picture gets the number of samples that was asked for.
    world.spp = samples();
}

// What the scene has and the integrator does not see.
void warn_of_unseen(const World& world, const Node& integrator, Messages& messages) {
    if (!world.integrator) return;
    if (world.scene->has_media() && !world.integrator->sees_media())
        messages.add_warning(
            integrator.place,
            fmt::format("integrator \"{}\" does not see participating media, of which the scene has "
                        "some: they are left out; volpath, simplevolpath, bdpt and mlt see them",
                        integrator.type));
    bool has_subsurface = false;
    for (std::size_t i = 0; i < world.materials.size(); ++i)
        if (const Material* material = world.materials.at(i)) has_subsurface |= material->has_subsurface();
    if (has_subsurface && !world.integrator->sees_subsurface())
        messages.add_warning(integrator.place,
                             "this integrator does not see light that spreads beneath surfaces, which "
                             "material \"subsurface\" has, and takes that for clear matter; path and "
                             "volpath do");
}

void add_scene(World& world, SceneDescription& description, const CameraNode& camera,
               const AccelChoice& accel, BuildContext& context, ShapeSources* sources) {
    Node fallback;
    fallback.type = "diffuse";
    description.materials.push_back(fallback);
    world.textures.build(description.textures, context);
    context.textures = &world.textures;
    SdfSet sdfs;
    sdfs.build(description.sdfs, context);
    if (world.options.forcediffuse) world.materials.force_diffuse();
    world.materials.build(description.materials, context);
    context.materials = &world.materials;
    world.media.build(description.media, context);
    world.scene = build_scene(description, world.materials, world.media, accel, context, sources);
    world.textures.forget_images();
    if (!world.scene) return;
    world.scene->set_medium_at_camera(world.media.find(camera.medium, camera.node.place, context.messages));
    if (accel.distance_field > 0)
        approximate(*world.scene, accel.distance_field, description.accelerator.place, context.messages);
    const bool is_still = world.integrator && !world.integrator->sees_motion();
    if (world.scene->moves() && (is_still || accel.distance_field > 0))
        context.messages.add_warning(is_still ? description.integrator.place : description.accelerator.place,
                                     "what moves is shown as it is when the shutter opens; with another "
                                     "integrator, and without the global "
                                     "distance field, the picture shows the motion");
    warn_of_unseen(world, description.integrator, context.messages);
}

} // namespace

// As pbrt-v4's.
constexpr const char* default_integrator = "volpath";

std::unique_ptr<World> build_world(SceneDescription description, const RenderSettings& settings,
                                   Messages& messages, ShapeSources* sources) {
    description.integrator = with_default(std::move(description.integrator), default_integrator);
    if (!settings.integrator.empty())
        description.integrator = replaced_kind(integrator_kinds(), std::move(description.integrator),
                                               settings.integrator, messages);
    for (const std::string& text : settings.overrides) apply_override(description, text, messages);
    messages.throw_if_errors();

    auto world = std::make_unique<World>();
    world->options = read_scene_options(description, messages);
    static const MeshReader mesh_reader = &read_ply;
    BuildContext context{messages};
    context.base_folder = description.base_folder;
    context.displacement_edge_scale = world->options.displacementedgescale;
    context.mesh_reader = &mesh_reader;
    static const GridReader grid_reader = &read_grid;
    context.grid_reader = &grid_reader;

    world->integrator = integrator_kinds().make(description.integrator, context, default_integrator);
    choose_color_mode(*world, settings, messages);
    context.color_mode = world->mode;

    CameraNode default_camera;
    default_camera.node.type = "perspective";
    const CameraNode* camera = find_camera(description, settings, messages);
    if (!camera) camera = &default_camera;
    read_shutter(*camera, context);
    context.world_from_camera = Transform(camera->world_from_camera.start);
    if (camera->world_from_camera.is_animated())
        if (auto movement =
                MovingTransform::make(camera->world_from_camera.start, camera->world_from_camera.end,
                                      description.time_start, description.time_end))
            context.camera_movement = std::make_shared<const MovingTransform>(*movement);
    world->film = make_film(description, settings, context);
    if (world->film) {
        context.film_resolution = world->film->resolution();
        context.film_diagonal = world->film->diagonal();
    }
    world->camera = make_camera(*camera, context);
    world->filter = filter_kinds().make(with_default(description.filter, "gaussian"), context, "gaussian");
    add_sampler(*world, description, settings, context);
    check_light_tracing(*world, description.integrator, *camera, description.film, context);
    check_surfaces(*world, description.integrator, description.film, context);

    if (settings.texture_memory) world->textures.limit_memory(*settings.texture_memory);
    add_scene(*world, description, *camera, choose_accel(description, settings, context), context, sources);
    messages.throw_if_errors();
    if (!world->options.disabletexturefiltering)
        world->scene->set_pixel_cone(pixel_cone(*world->camera, world->film->resolution(), world->spp));
    world->scene->set_light_chooser(world->integrator->light_sampler());
    world->paths_in_flight =
        settings.paths_in_flight > 0 ? settings.paths_in_flight : default_paths_in_flight(*world->scene);
    world->integrator->prepare(world->picture());
    return world;
}

} // namespace alhazen
