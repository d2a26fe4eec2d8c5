#include "render/renderer.h"

#include <exception>

#include "api/convert.h"
#include "api/picture.h"
#include "api/scene_model.h"
#include "base/threads.h"

namespace alhazen {

namespace {

RenderSettings to_settings(const RenderRequest& request) {
    if (request.width.has_value() != request.height.has_value())
        throw make_input_error("RenderRequest", "width and height must be given together");
    if (request.width && (*request.width < 1 || *request.height < 1 || *request.width > Image::max_side ||
                          *request.height > Image::max_side))
        throw make_input_error("RenderRequest", "width and height must be 1 to 65536");
    if (request.spp && *request.spp < 1) throw make_input_error("RenderRequest", "spp must be at least 1");
    if (request.threads < 0) throw make_input_error("RenderRequest", "threads must be at least 0");
    if (request.texture_memory == 0u)
        throw make_input_error("RenderRequest", "texture_memory must be at least 1");
    RenderSettings settings;
    settings.spp = request.spp;
    if (request.width) settings.size = Vec2i{*request.width, *request.height};
    settings.integrator = request.integrator;
    settings.camera = request.camera;
    settings.seed = request.seed;
    settings.threads = request.threads;
    settings.texture_memory = request.texture_memory;
    if (request.color == ColorComputation::spectral) settings.color = ColorMode::spectral;
    if (request.color == ColorComputation::rgb) settings.color = ColorMode::rgb;
    settings.overrides = request.overrides;
    return settings;
}

/// Asks the caller's callback whether to go on, and keeps what it throws until rendering has come to its end.
class Watcher {
  public:
    explicit Watcher(const RenderRequest& request) : request_(request) {
        watch_.cancel = &stop_;
        if (request.progress) watch_.progress = [this](const Progress& p) { tell(p); };
    }
    const RenderWatch& watch() const { return watch_; }
    bool was_stopped() const { return stop_; }
    void rethrow() const {
        if (thrown_) std::rethrow_exception(thrown_);
    }

  private:
    void tell(const Progress& p) {
        // Once told to stop, the callback is left alone; and the renderer speaks after every tile, too often
        // to listen.
        bool pass_is_finished = p.samples_done != last_samples_;
        if (stop_ || (!pass_is_finished && p.seconds - last_seconds_ < 0.1)) return;
        last_samples_ = p.samples_done;
        last_seconds_ = p.seconds;
        try {
            stop_ =
                !request_.progress({p.fraction, p.samples_done, p.samples_total, p.seconds, p.seconds_left});
        } catch (...) {
            thrown_ = std::current_exception();
            stop_ = true;
        }
    }

    const RenderRequest& request_;
    RenderWatch watch_;
    std::atomic<bool> stop_{false};
    std::exception_ptr thrown_;
    int last_samples_ = 0;
    double last_seconds_ = 0;
};

Picture render_description(SceneDescription description, bool lenient, const std::vector<Message>& warnings,
                           const RenderRequest& request) {
    RenderSettings settings = to_settings(request);
    Messages messages;
    messages.lenient = lenient;
    std::unique_ptr<World> world;
    try {
        with_threads(settings.threads,
                     [&] { world = build_world(std::move(description), settings, messages); });
    } catch (const SceneError& error) {
        throw to_input_error(error);
    }

    Watcher watcher(request);
    RenderStats stats;
    try {
        stats = alhazen::render(*world, settings, watcher.watch());
    } catch (const std::runtime_error& error) {
        throw make_input_error("RenderRequest", error.what());
    }
    watcher.rethrow();

    auto content = std::make_shared<Picture::Content>();
    content->image = world->film->image().to_rgb();
    content->write_options.depth = world->film->half_float() ? FloatDepth::half : FloatDepth::single;
    content->write_options.transfer = world->film->linear_transfer() ? Transfer::linear : Transfer::srgb;
    content->samples = stats.samples;
    content->seconds = stats.seconds;
    content->rays = stats.rays.total();
    content->was_stopped = stats.cancelled;
    std::vector<Message> all = warnings;
    for (Message& message : messages.warnings()) all.push_back(std::move(message));
    content->warnings = to_notices(all);
    return Picture(std::move(content));
}

} // namespace

Picture SceneModel::render(const RenderRequest& request) const& {
    return render_description(content_->description, content_->lenient, content_->warnings, request);
}

Picture SceneModel::render(const RenderRequest& request) && {
    return render_description(std::move(content_->description), content_->lenient, content_->warnings,
                              request);
}

} // namespace alhazen
