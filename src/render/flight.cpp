#include "render/flight.h"

namespace alhazen {

namespace {

// How far the samples that have ended may be ahead of the slowest: a power of two.
constexpr std::size_t ring_size = 1024;
// A path's frames and BSDFs fit in one such block, mostly.
constexpr std::size_t arena_block = 4096;
constexpr int many_paths = 128;
// Below this, one ray at a time was measured to be a tenth to a quarter faster (Whitted's spheres, the
// Cornell box).
constexpr std::size_t cached_bytes = std::size_t{256} << 10;

} // namespace

int default_paths_in_flight(const Scene& scene) {
    return scene.counts().accel_bytes < cached_bytes ? 1 : many_paths;
}

/// A sample on its way, and the memory it lives in.
struct Flight::Path {
    explicit Path(std::uint32_t number_) : number(number_) {}

    std::uint32_t number; ///< among the flight's paths
    Arena arena{arena_block};
    std::optional<PathContext> context;
    std::optional<Task<Spectrum>> task;
    std::uint64_t order = 0; ///< of the sample among the work's
    Vec2i pixel;
    int sample = 0;
    float filter_weight = 1;
    CameraSample camera_sample;
    Spectrum camera_weight = 1;
    VisibleSurface surface; ///< for films that want it
};

/// A sample that has ended.
struct Flight::Result {
    Vec2i pixel;
    int sample = 0;
    Spectrum radiance = 0;
    Wavelengths lambda;
    float weight = 1;
    bool is_done = false;
};

namespace {

/// How the point that a ray sees moves over its tangent plane when the ray's place on the film does.
Vec3 movement(const Camera& camera, CameraSample at, Vec2 step, const VisibleSurface& surface) {
    at.film += step;
    auto beside = camera.ray(at);
    if (!beside) return {};
    const float t = dot(surface.p - beside->ray.o, surface.n) / dot(beside->ray.d, surface.n);
    const Vec3 moved = beside->ray.at(t) - surface.p;
    return t > 0 && is_finite(moved) ? moved : Vec3();
}

} // namespace

Flight::Flight(World& world, int paths, bool centred)
    : world_(world), centred_(centred), results_(ring_size),
      surfaces_(world.film->wants_surfaces() ? ring_size : 0) {
    if (paths <= 0) paths = default_paths_in_flight(*world.scene);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(paths); ++i)
        paths_.push_back(std::make_unique<Path>(i));
}

Flight::~Flight() = default;

void Flight::run(const Work& work) {
    work_ = work;
    next_ = added_ = 0;
    count_ = static_cast<std::uint64_t>(work.pixels.width()) *
             static_cast<std::uint64_t>(work.pixels.height()) *
             static_cast<std::uint64_t>(work.end_sample - work.first_sample);
    for (const auto& path : paths_)
        if (start_next(*path)) settle(*path);
    while (added_ < count_) {
        queue_.trace(*world_.scene, [this](std::uint32_t number) { settle(*paths_[number]); });
        add_finished();
        // Paths that found the ring full when they ended.
        for (const auto& path : paths_)
            if (!path->task && start_next(*path)) settle(*path);
    }
}

// Gives the path the next sample, which runs until its first ray; false when there is none to begin now.
bool Flight::start_next(Path& path) {
    while (next_ < count_ && next_ - added_ < ring_size) {
        place(path, next_++);
        path.arena.reset();
        SampleStream stream(*world_.sampler, path.pixel, static_cast<std::uint32_t>(path.sample));
        FilterSample filter;
        const SceneOptionValues& options = world_.options;
        if (!centred_ && !options.disablepixeljitter) filter = world_.filter->sample(stream.pixel2());
        path.filter_weight = filter.weight;
        Wavelengths lambda = Wavelengths::rgb();
        if (world_.mode == ColorMode::spectral) {
            const float u = stream.next1();
            lambda = world_.film->sample_wavelengths(options.disablewavelengthjitter ? 0.5f : u);
        }
        CameraSample& at = path.camera_sample;
        at = {};
        at.film = {static_cast<float>(path.pixel.x) + 0.5f + filter.offset.x,
                   static_cast<float>(path.pixel.y) + 0.5f + filter.offset.y};
        if (world_.scene->moves() || world_.camera->moves())
            at.time = stream.next1();
        else
            stream.skip(1);
        if (world_.camera->has_lens())
            at.lens = stream.next2();
        else
            stream.skip(2);
        if (options.disablepixeljitter) {
            at.lens = {0.5f, 0.5f};
            at.time = 0.5f;
        }
        auto camera_ray = world_.camera->ray(at);
        path.context.emplace(*world_.scene, stream, lambda, path.arena, counts.rays,
                             paths_.size() > 1 ? &queue_ : nullptr, path.number);
        if (!surfaces_.empty()) {
            path.surface = {};
            path.context->surface = &path.surface;
        }
        if (camera_ray) {
            path.camera_weight = camera_ray->weight;
            path.task.emplace(world_.integrator->radiance(camera_ray->ray, *path.context));
            return true;
        }
        finish(path, 0);
    }
    return false;
}

// Which sample of which pixel has this place in the work's order.
void Flight::place(Path& path, std::uint64_t order) const {
    const auto samples = static_cast<std::uint64_t>(work_.end_sample - work_.first_sample);
    const auto width = static_cast<std::uint64_t>(work_.pixels.width());
    const std::uint64_t pixel = order / samples;
    path.order = order;
    path.sample = work_.first_sample + static_cast<int>(order % samples);
    path.pixel = {work_.pixels.lo.x + static_cast<int>(pixel % width),
                  work_.pixels.lo.y + static_cast<int>(pixel / width)};
}

// A path that has ended hands its place on.
void Flight::settle(Path& path) {
    while (path.task && path.task->done()) {
        finish(path, path.task->result() * path.camera_weight);
        if (!start_next(path)) return;
    }
}

void Flight::finish(Path& path, Spectrum radiance) {
    Result& result = results_[path.order % ring_size];
    result = {path.pixel, path.sample, radiance, path.context->lambda, path.filter_weight, true};
    if (!surfaces_.empty()) {
        VisibleSurface& surface = surfaces_[path.order % ring_size] = path.surface;
        if (surface.is_there) {
            surface.dpdx = movement(*world_.camera, path.camera_sample, {1, 0}, surface);
            surface.dpdy = movement(*world_.camera, path.camera_sample, {0, 1}, surface);
        }
    }
    path.task.reset();
    if (path.order == added_) add_finished();
}

void Flight::add_finished() {
    for (; added_ < next_ && results_[added_ % ring_size].is_done; ++added_) {
        Result& r = results_[added_ % ring_size];
        r.is_done = false;
        if (r.radiance.is_finite()) {
            if (const auto i = added_ % ring_size; i < surfaces_.size() && surfaces_[i].is_there)
                world_.film->add_surface(r.pixel, surfaces_[i]);
            world_.film->add(r.pixel, r.radiance, r.lambda, r.weight);
            continue;
        }
        counts.add_bad(r.pixel, r.sample);
    }
}

} // namespace alhazen
