/// Stochastic progressive photon mapping (Hachisuka and Jensen 2009; Pharr, Jakob and Humphreys 2016,
/// section 16.2): in each iteration every pixel's camera path is followed to a point on a diffuse surface,
/// photons are sent from the lights, and each point gathers those that arrive around it. A pixel's radius
/// shrinks with the photons it has gathered, so that the blur vanishes as the noise does. Light that arrives
/// directly is sampled, not gathered. The picture: caustics, also those seen in mirrors and through glass,
/// which no other integrator finds.
///
/// All iterations are passes, and what photons bring adds up in integers: the picture does not depend on
/// threads.
#include <atomic>
#include <mutex>

#include "base/exact_sums.h"
#include "base/threads.h"
#include "integrators/arrival.h"
#include "integrators/ball_grid.h"
#include "integrators/company.h"
#include "integrators/direct_light.h"
#include "integrators/integrator.h"
#include "integrators/light_start.h"
#include "integrators/shading_normal.h"
#include "materials/material.h"

namespace alhazen {

namespace {

struct SppmOptions {
    int maxdepth = 5;
    int photonsperiteration = -1;
    float radius = 1;
    int seed = 0;
};

/// Where a pixel gathers photons in this iteration.
struct VisiblePoint {
    Vec3 p, ng;
    Frame frame;
    Vec3 wo;                    ///< towards the camera, in the frame
    const Bsdf* bsdf = nullptr; ///< none: nothing is gathered
    Spectrum weight;            ///< of what leaves towards the camera
    bool one_wavelength = false;

    Spectrum gathered(Spectrum flux, Vec3 to_light) const {
        const float cosine = abs_dot(ng, to_light);
        return cosine > 0 ? weight * bsdf->eval(wo, frame.to_local(to_light)).f * flux / cosine : Spectrum(0);
    }
};

struct Pixel {
    VisiblePoint point;
    float radius = 0;
    double photons = 0; ///< gathered so far, of those that the radius has kept
    Vec3d gathered;     ///< what they brought, over all iterations
    Vec3d direct;       ///< all other light, over all iterations
};

class SppmWork final : public PictureWork {
  public:
    SppmWork(const PictureOrder& picture, const SppmOptions& options)
        : picture_(picture), options_(options), area_(picture.film.pixels()),
          pixels_(static_cast<std::size_t>(area_.width()) * static_cast<std::size_t>(area_.height())),
          arenas_((pixels_.size() + chunk - 1) / chunk), brought_(3 * pixels_.size()),
          arrived_(pixels_.size()),
          photons_(options.photonsperiteration > 0 ? static_cast<std::size_t>(options.photonsperiteration)
                                                   : pixels_.size()),
          lights_(lights_by_power(picture.scene.lights())), photon_numbers_(make_photon_numbers()) {
        for (Pixel& pixel : pixels_) pixel.radius = options.radius;
    }

    int passes() const override { return picture_.samples; }

    PictureCounts run(int iteration, const std::function<void(double)>& progress) override {
        iteration_ = iteration;
        lambda_ = wavelengths();
        time_ = spread(hash_of(picture_.seed, options_.seed, 1));
        counts_ = {};
        done_ = 0;
        work_ = pixels_.size() + photons_;
        parallel_ranges(pixels_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            see(begin, end);
            report(end - begin, progress);
        });
        build_grid();
        parallel_ranges(photons_, chunk, [&](std::size_t begin, std::size_t end) {
            shine(begin, end);
            report(end - begin, progress);
        });
        parallel_ranges(pixels_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) update(i);
        });
        return counts_;
    }

  private:
    static constexpr std::size_t chunk = 1024;
    static constexpr int photon_columns = 1024;

    /// One path from the camera.
    struct Sight {
        std::size_t pixel = 0;
        Vec2i place;
        float filter_weight = 1;
        Ray ray;
        Spectrum direct = 0;
    };

    // All paths of an iteration have the same wavelengths and the same time, or photons and points would not
    // fit together; from one iteration to the next they are spread evenly.
    Wavelengths wavelengths() const {
        if (picture_.mode == ColorMode::rgb) return Wavelengths::rgb();
        return Wavelengths::sample_visible(spread(hash_of(picture_.seed, options_.seed)));
    }

    // The iteration's number of a sequence that is spread evenly, begun anywhere (van der Corput).
    float spread(std::uint64_t beginning) const {
        std::uint32_t bits = 0, n = static_cast<std::uint32_t>(iteration_);
        for (int i = 0; i < 32; ++i, n >>= 1) bits = (bits << 1) | (n & 1);
        const float u = unit_float(bits) + unit_float(beginning);
        return u < 1 ? u : u - 1;
    }

    // The photons are spread as a picture's samples are, a sample of every "pixel" in each iteration.
    std::unique_ptr<Sampler> make_photon_numbers() const {
        Messages messages;
        BuildContext context{messages};
        Node node;
        node.type = "zsobol";
        auto sampler = sampler_kinds().make(node, context, "");
        const auto rows = static_cast<int>((photons_ + photon_columns - 1) / photon_columns);
        sampler->prepare({photon_columns, rows}, picture_.samples,
                         hash_of(picture_.seed, options_.seed, 0x70686f746f6eu));
        return sampler;
    }

    void add(const RayCounts& rays) {
        std::scoped_lock lock(mutex_);
        counts_.rays += rays;
    }
    void add_bad(Vec2i pixel) {
        std::scoped_lock lock(mutex_);
        counts_.add_bad(pixel, iteration_);
    }
    void report(std::size_t paths, const std::function<void(double)>& progress) {
        progress(static_cast<double>(done_ += paths) / static_cast<double>(work_));
    }
    std::size_t places() const { return static_cast<std::size_t>(picture_.paths_in_flight); }

    /// The camera paths of the pixels begin ... end - 1, a chunk.
    void see(std::size_t begin, std::size_t end) {
        Arena& points = arenas_[begin / chunk];
        points.reset();
        Company<bool> company(picture_.scene, places());
        std::vector<Sight> sights(places());
        std::size_t next = begin;
        company.run(
            [&](Company<bool>::Place& place) {
                if (next == end) return false;
                start_sight(next++, sights[place.number], company, place, points);
                return true;
            },
            [&](Company<bool>::Place& place) {
                const Sight& sight = sights[place.number];
                const Spectrum L = sight.direct * sight.filter_weight;
                if (L.is_finite())
                    pixels_[sight.pixel].direct += Vec3d(picture_.film.measure(L, place.context->lambda));
                else
                    add_bad(sight.place);
            });
        add(company.counts);
    }

    void start_sight(std::size_t number, Sight& sight, Company<bool>& company, Company<bool>::Place& place,
                     Arena& points) {
        const auto width = static_cast<std::size_t>(area_.width());
        const Vec2i at = area_.lo + Vec2i(static_cast<int>(number % width), static_cast<int>(number / width));
        SampleStream samples(picture_.sampler, at, static_cast<std::uint32_t>(iteration_));
        const FilterSample filter = picture_.filter.sample(samples.pixel2());
        CameraSample camera_sample;
        camera_sample.film = Vec2(at) + Vec2(0.5f, 0.5f) + filter.offset;
        camera_sample.time = time_;
        samples.skip(1);
        camera_sample.lens = samples.next2();
        pixels_[number].point = {};
        const auto ray = picture_.camera.ray(camera_sample);
        sight = {number, at, filter.weight, ray ? ray->ray : Ray(), 0};
        company.follow(place, samples, lambda_, [&](PathContext& path) {
            return follow_sight(ray ? ray->weight : Spectrum(0), sight, path, points);
        });
    }

    /// Specular and glossy surfaces are traced through, as by the path tracer; at the first diffuse one, or
    /// where the path must end, photons are gathered.
    Task<bool> follow_sight(Spectrum throughput, Sight& sight, PathContext& path, Arena& points) {
        Ray ray = sight.ray;
        Arrival arrival{0, true, {ray.o, {}}};
        bool gathers = false;
        for (int depth = 0; !throughput.is_black();) {
            const std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) {
                sight.direct += throughput * escaped_light(ray, arrival, path);
                break;
            }
            if (hit->area_light) sight.direct += throughput * emitted_light(*hit, ray, arrival, path);
            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            // Beyond the point there is one more ray, for the light that arrives at it directly.
            if (depth++ == options_.maxdepth || gathers) break;

            const Frame frame = hit->shading_frame();
            const Lobes lobes = bsdf->lobes();
            if (has(lobes, Lobes::diffuse | Lobes::glossy)) {
                if (auto direct = propose_light(*hit, *bsdf, frame, path, LightSampling::beside_bsdf)) {
                    const bool visible = co_await path.visible(direct->shadow_ray);
                    if (visible) sight.direct += throughput * direct->value * direct->mis_weight();
                }
            }
            const bool is_gatherer =
                has(lobes, Lobes::diffuse) || (has(lobes, Lobes::glossy) && depth == options_.maxdepth);
            // Where a surface has a mirror, too, chance decides which of the two is followed.
            const bool is_mirror = has(lobes, Lobes::specular);
            const bool follows_mirror = is_mirror && path.samples.next1() < 0.5f;
            gathers = is_gatherer && !(is_mirror && follows_mirror);
            if (gathers) {
                VisiblePoint& point = pixels_[sight.pixel].point;
                point.p = hit->p;
                point.ng = hit->ng;
                point.frame = frame;
                point.wo = frame.to_local(hit->wo);
                point.bsdf = hit->material->at(*hit, path.lambda, points);
                point.weight = throughput * (sight.filter_weight * (is_mirror ? 2.0f : 1.0f));
                point.one_wavelength = path.lambda.secondary_terminated();
            }
            const float u = path.samples.next1();
            const auto next = bsdf->sample(frame.to_local(hit->wo), u, path.samples.next2());
            if (!next || next->pdf == 0) break;
            const bool is_specular = has(next->lobes, Lobes::specular);
            if (is_gatherer) {
                if (is_specular && gathers) break;
                if (is_specular)
                    throughput *= 2;
                else
                    gathers = true;
            }
            throughput *= next->f / next->pdf;
            arrival = {next->pdf, is_specular, {hit->p, hit->ns}};
            ray = hit->spawn(frame.to_world(next->wi));
        }
        co_return true;
    }

    void build_grid() {
        std::vector<Ball3> balls(pixels_.size());
        parallel_ranges(pixels_.size(), chunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                balls[i] = {pixels_[i].point.p, pixels_[i].point.bsdf ? pixels_[i].radius : 0};
        });
        grid_.build(balls);
    }

    /// The photons begin ... end - 1.
    void shine(std::size_t begin, std::size_t end) {
        Company<bool> company(picture_.scene, places());
        std::size_t next = begin;
        company.run(
            [&](Company<bool>::Place& place) {
                if (next == end) return false;
                const auto column = static_cast<int>(next % photon_columns),
                           row = static_cast<int>(next / photon_columns);
                ++next;
                const SampleStream samples(*photon_numbers_, {column, row},
                                           static_cast<std::uint32_t>(iteration_));
                company.follow(place, samples, lambda_,
                               [&](PathContext& path) { return follow_photon(path); });
                return true;
            },
            [](Company<bool>::Place&) {});
        add(company.counts);
    }

    Task<bool> follow_photon(PathContext& path) {
        path.samples.skip(1);
        const float time = lerp(time_, picture_.camera.shutteropen, picture_.camera.shutterclose);
        const auto start = start_at_light(*lights_, path.samples, path.lambda, time);
        if (!start) co_return true;
        Spectrum flux = start->flux(), throughput = 1;
        Ray ray = start->leaving.ray;
        for (int depth = 0; depth < options_.maxdepth;) {
            const std::optional<Hit> hit = co_await path.closest(ray);
            if (!hit) break;
            Bsdf* bsdf = hit->material->at(*hit, path.lambda, path.arena);
            if (!bsdf) {
                ray = hit->spawn(ray.d);
                continue;
            }
            // What arrives directly is sampled by the camera's paths.
            if (depth > 0) bring(*hit, flux * throughput, path.lambda.secondary_terminated());
            if (depth++ == 0) flux *= start->growth(length_squared(hit->p - start->leaving.p));
            const Frame frame = hit->shading_frame();
            const float u = path.samples.next1();
            const auto next =
                bsdf->sample(frame.to_local(hit->wo), u, path.samples.next2(), TransportMode::importance);
            if (!next || next->pdf == 0) break;
            const Vec3 w = frame.to_world(next->wi);
            throughput *= next->f * (shading_correction(*hit, hit->wo, w) / next->pdf);
            const float survival = throughput.max();
            if (survival < 1 && path.samples.next1() >= survival) break;
            if (survival < 1) throughput /= survival;
            if (throughput.is_black()) break;
            ray = hit->spawn(w);
        }
        co_return true;
    }

    /// A photon to all the points around.
    void bring(const Hit& hit, Spectrum flux, bool one_wavelength) {
        grid_.for_each(hit.p, [&](std::uint32_t i) {
            const VisiblePoint& point = pixels_[i].point;
            Spectrum L = point.gathered(flux, hit.wo);
            if (point.one_wavelength || one_wavelength) L = Spectrum(4 * L[0], 0, 0, 0);
            const Vec3 measured = picture_.film.measure(L, lambda_);
            if (!is_finite(measured)) return;
            for (std::size_t c = 0; c < 3; ++c)
                brought_.add(3 * i + c, static_cast<double>(measured[static_cast<int>(c)]));
            std::atomic_ref(arrived_[i]).fetch_add(1, std::memory_order_relaxed);
        });
    }

    /// The radius keeps 2/3 of the photons that have arrived, as if they had been fewer on less area.
    void update(std::size_t i) {
        Pixel& pixel = pixels_[i];
        if (arrived_[i] > 0) {
            constexpr double kept = 2 / 3.0;
            const auto arrived = static_cast<double>(arrived_[i]);
            const double ratio = (pixel.photons + kept * arrived) / (pixel.photons + arrived);
            const Vec3d brought(brought_.sum(3 * i), brought_.sum(3 * i + 1), brought_.sum(3 * i + 2));
            pixel.gathered = (pixel.gathered + brought) * ratio;
            pixel.photons += kept * arrived;
            pixel.radius *= static_cast<float>(std::sqrt(ratio));
            for (std::size_t c = 0; c < 3; ++c) brought_.clear(3 * i + c);
            arrived_[i] = 0;
        }
        const double iterations = iteration_ + 1;
        const double r = static_cast<double>(pixel.radius);
        const double area_and_photons =
            3.14159265358979323846 * r * r * iterations * static_cast<double>(photons_);
        const auto width = static_cast<std::size_t>(area_.width());
        picture_.film.set(area_.lo + Vec2i(static_cast<int>(i % width), static_cast<int>(i / width)),
                          pixel.direct / iterations + pixel.gathered / area_and_photons);
    }

    PictureOrder picture_;
    SppmOptions options_;
    Rect2i area_;
    std::vector<Pixel> pixels_;
    std::vector<Arena> arenas_; ///< of the points' BSDFs, one a chunk
    BallGrid grid_;
    ExactSums brought_; ///< in this iteration, three a pixel
    std::vector<std::uint32_t> arrived_;
    std::size_t photons_;
    std::unique_ptr<LightChooser> lights_;
    std::unique_ptr<Sampler> photon_numbers_;
    Wavelengths lambda_;
    float time_ = 0; ///< of the iteration, as a part of the time that the shutter is open
    int iteration_ = 0;
    std::size_t work_ = 0;
    std::atomic<std::size_t> done_{0};
    std::mutex mutex_;
    PictureCounts counts_;
};

struct Sppm final : Integrator, SppmOptions {
    static void describe(Fields<Sppm>& f) {
        f.about("Stochastic progressive photon mapping: each pixel gathers the photons that arrive around "
                "what it sees. "
                "For caustics, also those seen in mirrors and through glass. The number of samples of a "
                "pixel is that "
                "of iterations, each with as many photons.");
        f.field("maxdepth", &Sppm::maxdepth,
                "bounces of a camera's path at most, and surfaces that a photon meets")
            .in(0, 10000);
        f.field("photonsperiteration", &Sppm::photonsperiteration,
                "photons sent from the lights in each iteration")
            .in(-1, 1 << 30)
            .otherwise("-1: as many as pixels");
        f.field("radius", &Sppm::radius,
                "within which photons are gathered at first; it shrinks with each iteration")
            .in(1e-20, 1e20)
            .unit("scene units");
        f.field("seed", &Sppm::seed, "another number gives other, equally good, photons");
    }

    bool sets_pixels() const override { return true; }
    bool follows_camera_rays() const override { return false; }
    std::unique_ptr<PictureWork> whole_picture(const PictureOrder& picture) const override {
        return std::make_unique<SppmWork>(picture, *this);
    }
    Task<Spectrum> radiance(Ray, PathContext&) const override { co_return Spectrum(0); }
};

} // namespace

Kind<Integrator> sppm_integrator() {
    return make_kind<Integrator, Sppm>("sppm");
}

} // namespace alhazen
