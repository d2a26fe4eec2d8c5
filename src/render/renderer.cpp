#include "render/renderer.h"

#include <algorithm>
#include <mutex>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "base/stopwatch.h"
#include "base/threads.h"
#include "render/flight.h"

namespace alhazen {

namespace {

class Renderer {
  public:
    Renderer(World& world, const RenderSettings& settings, const RenderWatch& watch)
        : world_(world), watch_(watch), pixels_(world.film->pixels()),
          tile_size_(std::max(1, settings.tile_size)),
          tiles_x_((pixels_.width() + tile_size_ - 1) / tile_size_),
          tiles_y_((pixels_.height() + tile_size_ - 1) / tile_size_), flights_([&world, &settings] {
              bool centred = world.spp == 1 && world.integrator->centres_single_samples();
              return Flight(world, settings.paths_in_flight, centred);
          }) {}

    RenderStats run() {
        world_.film->start(world_.mode);
        if (world_.integrator->makes_splats())
            world_.film->start_splats(*world_.filter, world_.integrator->splat_layers().size());
        if (auto whole = world_.integrator->whole_picture(world_.picture()))
            run_whole(*whole);
        else
            run_samples();
        return stats();
    }

  private:
    bool is_cancelled() const { return watch_.cancel && watch_.cancel->load(); }

    void run_whole(PictureWork& work) {
        const int passes = work.passes();
        for (int pass = 0; pass < passes && (pass == 0 || !is_cancelled()); ++pass) {
            whole_ += work.run(pass, [&](double fraction) { report((pass + fraction) / passes, false); });
            done_ = static_cast<int>(std::int64_t{world_.spp} * (pass + 1) / passes);
            report((pass + 1.0) / passes, true);
        }
        quadrature_ = work.quadrature();
    }

    void run_samples() {
        while (done_ < world_.spp) {
            const Stopwatch pass;
            run_pass();
            done_ += pass_;
            // Each sample came with one path from the lights, whose light the whole film measures.
            world_.film->set_splat_scale(1 / (rendered_fraction(*world_.film) * done_));
            last_pass_ = pass.seconds();
            report(static_cast<double>(done_) / world_.spp, true);
            if (is_cancelled()) break;
        }
    }

    void run_pass() {
        pass_ = next_pass_size();
        tiles_done_ = 0;
        std::size_t count = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
        parallel_for(count, 1, [&](std::size_t i) {
            render_tile(static_cast<int>(i % static_cast<std::size_t>(tiles_x_)),
                        static_cast<int>(i / static_cast<std::size_t>(tiles_x_)));
            report((done_ + static_cast<double>(++tiles_done_) / static_cast<double>(count) * pass_) /
                       world_.spp,
                   false);
        });
    }

    // Passes of about a second: short enough to stop after, long enough not to wait at their ends. How the
    // samples are divided into passes does not change the image.
    int next_pass_size() const {
        int left = world_.spp - done_;
        if (done_ == 0) return std::min(left, 1);
        double per_sample = last_pass_ / pass_;
        int wanted = per_sample > 0 ? static_cast<int>(std::min(1 / per_sample, 1e6)) : 1;
        return std::clamp(wanted, 1, std::min(left, 4 * pass_));
    }

    void render_tile(int tx, int ty) {
        Vec2i lo{pixels_.lo.x + tx * tile_size_, pixels_.lo.y + ty * tile_size_};
        Vec2i hi{std::min(lo.x + tile_size_, pixels_.hi.x), std::min(lo.y + tile_size_, pixels_.hi.y)};
        flights_.local().run({{lo, hi}, done_, done_ + pass_});
    }

    // fraction: of all the work.
    void report(double fraction, bool pass_is_finished) {
        if (!watch_.progress) return;
        std::unique_lock lock(report_mutex_, std::try_to_lock);
        if (!lock && !pass_is_finished) return; // someone else is at it
        if (!lock) lock.lock();
        Progress p;
        p.samples_done = done_;
        p.samples_total = world_.spp;
        p.fraction = fraction;
        p.seconds = since_start_.seconds();
        p.seconds_left = p.fraction > 0 ? p.seconds * (1 - p.fraction) / p.fraction : 0;
        if (pass_is_finished) {
            std::uint64_t rays = whole_.rays.total();
            for (const Flight& w : flights_) rays += w.counts.rays.total();
            rays_per_second_ = p.seconds > 0 ? static_cast<double>(rays) / p.seconds : 0;
        }
        p.rays_per_second = rays_per_second_;
        watch_.progress(p);
    }

    RenderStats stats() {
        RenderStats s;
        s.seconds = since_start_.seconds();
        s.samples = done_;
        s.cancelled = done_ < world_.spp;
        s.quadrature = quadrature_;
        auto add = [&s](const PictureCounts& counts) {
            s.rays += counts.rays;
            s.bad_samples += counts.bad_samples;
            s.first_bad_samples.insert(s.first_bad_samples.end(), counts.bad.begin(), counts.bad.end());
        };
        add(whole_);
        for (const Flight& w : flights_) add(w.counts);
        std::sort(s.first_bad_samples.begin(), s.first_bad_samples.end(),
                  [](const BadSample& a, const BadSample& b) {
                      return std::tie(a.pixel.y, a.pixel.x, a.sample) <
                             std::tie(b.pixel.y, b.pixel.x, b.sample);
                  });
        if (s.first_bad_samples.size() > 10) s.first_bad_samples.resize(10);
        return s;
    }

    World& world_;
    const RenderWatch& watch_;
    Rect2i pixels_;
    int tile_size_, tiles_x_, tiles_y_;
    int done_ = 0, pass_ = 0;
    double last_pass_ = 0, rays_per_second_ = 0;
    std::atomic<std::size_t> tiles_done_{0};
    PictureCounts whole_; // of work that is not done by flights
    std::optional<Quadrature> quadrature_;
    std::mutex report_mutex_;
    tbb::enumerable_thread_specific<Flight> flights_; // one a thread
    Stopwatch since_start_;
};

} // namespace

RenderStats render(World& world, const RenderSettings& settings, const RenderWatch& watch) {
    RenderStats stats;
    with_threads(settings.threads, [&] { stats = Renderer(world, settings, watch).run(); });
    world.textures.throw_if_failed();
    return stats;
}

} // namespace alhazen
