#include "render/flight.h"

namespace alhazen {

namespace {

// How far the samples that have ended may be ahead of the slowest: a power of two.
constexpr std::size_t ring_size = 1024;
// A path's frames and BSDFs fit in one such block, mostly.
constexpr std::size_t arena_block = 4096;
constexpr int many_paths = 128;
// Rays that march through a distance field do so 32 at a time, and need as many in waiting again and again.
constexpr int marching_paths = 256;
// Below this, one ray at a time was measured to be a tenth to a quarter faster (Whitted's spheres, the
// Cornell box).
constexpr std::size_t cached_bytes = std::size_t{256} << 10;
// Samples whose rays are bundled: several bundles, and few enough to stay in the cache.
constexpr std::size_t bundled = 64;

} // namespace

int default_paths_in_flight(const Scene& scene) {
    if (scene.approximation()) return marching_paths;
    return scene.counts().accel_bytes < cached_bytes ? 1 : many_paths;
}

/// A sample of a pixel, and what is drawn for it before its first ray.
struct Flight::Sample {
    Vec2i pixel;
    int number = 0; ///< among the pixel's
    float filter_weight = 1;
    Wavelengths lambda;
    CameraSample at;
    std::optional<CameraRay> ray; ///< at that place, once it was asked for
};

/// A sample on its way, and the memory it lives in.
struct Flight::Path {
    explicit Path(std::uint32_t number_) : number(number_) {}

    std::uint32_t number; ///< among the flight's paths
    Arena arena{arena_block};
    std::optional<PathContext> context;
    std::optional<Task<Spectrum>> task;
    std::uint64_t order = 0; ///< of the sample among the work's
    Sample sample;
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
    if (paths <= 0 && world.mode == ColorMode::rgb && surfaces_.empty())
        bundles_ = world.integrator->bundles(*world.scene);
    if (bundles_) return;
    if (paths <= 0) paths = default_paths_in_flight(*world.scene);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(paths); ++i)
        paths_.push_back(std::make_unique<Path>(i));
}

Flight::~Flight() = default;

void Flight::run(const Work& work) {
    work_ = work;
    next_ = added_ = 0;
    next_pixel_ = work.pixels.lo;
    next_sample_ = work.first_sample;
    count_ = static_cast<std::uint64_t>(work.pixels.width()) *
             static_cast<std::uint64_t>(work.pixels.height()) *
             static_cast<std::uint64_t>(work.end_sample - work.first_sample);
    if (bundles_) return run_bundles();
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

void Flight::run_bundles() {
    std::array<Sample, bundled> samples;
    std::array<Ray, bundled> rays;
    std::array<Spectrum, bundled> radiance;
    while (next_ < count_) {
        std::size_t taken = 0, sent = 0;
        for (; taken < bundled && next_ < count_; ++taken) draw_next(samples[taken]);
        for (std::size_t i = 0; i < taken; ++i) {
            samples[i].ray = world_.camera->ray(samples[i].at);
            if (samples[i].ray) rays[sent++] = samples[i].ray->ray;
        }
        bundles_->radiance({rays.data(), sent}, {radiance.data(), sent}, counts.rays);
        sent = 0;
        for (std::size_t i = 0; i < taken; ++i) {
            const Sample& s = samples[i];
            const Spectrum L = s.ray ? radiance[sent++] * s.ray->weight : 0;
            add({s.pixel, s.number, L, s.lambda, s.filter_weight, true}, nullptr);
        }
    }
}

// Gives the path the next sample, which runs until its first ray; false when there is none to begin now.
bool Flight::start_next(Path& path) {
    while (next_ < count_ && next_ - added_ < ring_size) {
        path.order = next_;
        path.arena.reset();
        const SampleStream stream = draw_next(path.sample);
        path.sample.ray = world_.camera->ray(path.sample.at);
        path.context.emplace(*world_.scene, stream, path.sample.lambda, path.arena, counts.rays,
                             paths_.size() > 1 ? &queue_ : nullptr, path.number);
        if (!surfaces_.empty()) {
            path.surface = {};
            path.context->surface = &path.surface;
        }
        if (path.sample.ray) {
            path.task.emplace(world_.integrator->radiance(path.sample.ray->ray, *path.context));
            return true;
        }
        finish(path, 0);
    }
    return false;
}

// The next sample in the work's order, which must have one; what it may draw from then on comes back.
SampleStream Flight::draw_next(Sample& sample) {
    place_next(sample);
    SampleStream stream(*world_.sampler, sample.pixel, static_cast<std::uint32_t>(sample.number));
    FilterSample filter;
    const SceneOptionValues& options = world_.options;
    if (!centred_ && !options.disablepixeljitter) filter = world_.filter->sample(stream.pixel2());
    sample.filter_weight = filter.weight;
    sample.lambda = Wavelengths::rgb();
    if (world_.mode == ColorMode::spectral) {
        const float u = stream.next1();
        sample.lambda = world_.film->sample_wavelengths(options.disablewavelengthjitter ? 0.5f : u);
    }
    CameraSample& at = sample.at;
    at = {};
    at.film = {static_cast<float>(sample.pixel.x) + 0.5f + filter.offset.x,
               static_cast<float>(sample.pixel.y) + 0.5f + filter.offset.y};
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
    return stream;
}

void Flight::place_next(Sample& sample) {
    ++next_;
    sample.pixel = next_pixel_;
    sample.number = next_sample_;
    if (++next_sample_ < work_.end_sample) return;
    next_sample_ = work_.first_sample;
    if (++next_pixel_.x < work_.pixels.hi.x) return;
    next_pixel_ = {work_.pixels.lo.x, next_pixel_.y + 1};
}

// A path that has ended hands its place on.
void Flight::settle(Path& path) {
    while (path.task && path.task->done()) {
        finish(path, path.task->result() * path.sample.ray->weight);
        if (!start_next(path)) return;
    }
}

void Flight::finish(Path& path, Spectrum radiance) {
    const Sample& sample = path.sample;
    Result& result = results_[path.order % ring_size];
    result = {sample.pixel, sample.number, radiance, path.context->lambda, sample.filter_weight, true};
    if (!surfaces_.empty()) {
        VisibleSurface& surface = surfaces_[path.order % ring_size] = path.surface;
        if (surface.is_there) {
            surface.dpdx = movement(*world_.camera, sample.at, {1, 0}, surface);
            surface.dpdy = movement(*world_.camera, sample.at, {0, 1}, surface);
        }
    }
    path.task.reset();
    if (path.order == added_) add_finished();
}

void Flight::add_finished() {
    for (; added_ < next_ && results_[added_ % ring_size].is_done; ++added_) {
        const std::size_t i = added_ % ring_size;
        results_[i].is_done = false;
        add(results_[i], i < surfaces_.size() && surfaces_[i].is_there ? &surfaces_[i] : nullptr);
    }
}

void Flight::add(const Result& result, const VisibleSurface* surface) {
    if (!result.radiance.is_finite()) return counts.add_bad(result.pixel, result.sample);
    if (surface) world_.film->add_surface(result.pixel, *surface);
    world_.film->add(result.pixel, result.radiance, result.lambda, result.weight);
}

} // namespace alhazen
