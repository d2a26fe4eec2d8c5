/// Metropolis light transport (Veach and Guibas 1997) over the random numbers of bidirectional paths (Kelemen
/// et al. 2002), each chain keeping to paths of one length and choosing the strategy as one more number
/// (Hachisuka, Kaplanyan and Dachsbacher 2014, "Multiplexed Metropolis light transport"). A path that brings
/// light is changed a little again and again, and kept as often as it is bright; so where light comes through
/// a keyhole, having found one path means having found its neighbours. How bright the picture is on the whole
/// is known from the paths that the chains start from.
///
/// The number of chains is fixed, each is a pure function of its number, and what they bring adds up in
/// integers: so the picture does not depend on threads.
#include <algorithm>
#include <atomic>
#include <mutex>

#include "base/threads.h"
#include "integrators/bidirectional.h"
#include "integrators/chain_numbers.h"
#include "integrators/company.h"
#include "integrators/integrator.h"

namespace alhazen {

namespace {

struct MltOptions {
    int maxdepth = 5;
    int bootstrapsamples = 100000;
    int chains = 1000;
    int mutationsperpixel = 100;
    float largestepprobability = 0.3f;
    float sigma = 0.01f;
    bool regularize = false;
};

/// A path of a chain's: what it brings, where, and how much it counts.
struct State final : PathTaker {
    Wavelengths lambda;
    Vec2 camera_film; ///< where the camera ray went
    Vec2 film;
    Spectrum L = 0;
    float weight = 0; ///< in a chain: how often it has been seen

    void take(const FoundPath& found) override {
        L += found.value();
        film = found.film.value_or(camera_film);
    }
    /// What paths are kept in proportion to: the mean over wavelengths, which were drawn where eyes see most.
    float brightness() const { return safe_divide(L, lambda.pdf).average(); }
};

/// Paths of one number of bounces, made of numbers.
class PathMaker {
  public:
    PathMaker(const PictureOrder& picture, const MltOptions& options)
        : picture_(picture), paths_(picture, {options.maxdepth, options.regularize, false}) {
        // Also around the pixels, as far as the filter reaches.
        const Rect2i pixels = picture.film.pixels();
        const Vec2 reach = picture.filter.radius() - Vec2(0.5f, 0.5f);
        const Vec2i whole = picture.film.resolution();
        lo_ = Vec2(pixels.lo) - reach;
        size_ = Vec2(pixels.hi) + reach - lo_;
        film_fraction_ = size_.x * size_.y / (static_cast<float>(whole.x) * static_cast<float>(whole.y));
    }

    /// Starts the path in the company; its state is there when the task is done.
    void start(Company<bool>& company, Company<bool>::Place& place, const Sampler& numbers, int bounces,
               State& state) const {
        SampleStream samples(numbers, {}, 0);
        const float chosen = samples.next1(), u_lambda = samples.next1();
        const Vec2 u_film = samples.next2();
        CameraSample at;
        at.time = samples.next1();
        at.lens = samples.next2();
        at.film = lo_ + Vec2(u_film.x * size_.x, u_film.y * size_.y);
        state = {};
        state.camera_film = at.film;
        if (picture_.mode == ColorMode::spectral) state.lambda = Wavelengths::sample_visible(u_lambda);
        // Paths without a bounce are seen directly; a light's point is not joined with the lens.
        const int strategies = bounces == 0 ? 1 : bounces + 2;
        Strategy strategy;
        strategy.light = std::min(static_cast<int>(chosen * static_cast<float>(strategies)), strategies - 1);
        strategy.camera = bounces + 2 - strategy.light;
        company.follow(place, samples, state.lambda, [&](PathContext& path) {
            return find(at, path, strategy, static_cast<float>(strategies), state);
        });
    }

  private:
    // Any one of the strategies stands for all; a camera ray, for as much of the film as they are drawn from.
    Task<bool> find(CameraSample at, PathContext& path, Strategy strategy, float strategies,
                    State& state) const {
        const auto ray = picture_.camera.ray(at);
        if (!ray) co_return true;
        co_await paths_.find_paths(ray->ray, path, state, strategy);
        state.L *= strategies * (strategy.camera > 1 ? film_fraction_ : 1);
        co_return true;
    }

    PictureOrder picture_;
    Bidirectional paths_;
    Vec2 lo_, size_;
    float film_fraction_ = 1;
};

/// A path that many are made of.
struct Chain {
    Chain(std::uint64_t first, std::uint64_t steps, int bounces_, float sigma)
        : numbers(first, steps, sigma), bounces(bounces_) {}

    ChainNumbers numbers;
    int bounces;
    bool has_begun = false;
    State current, proposed;
};

class MltWork final : public PictureWork {
  public:
    MltWork(const PictureOrder& picture, const MltOptions& options)
        : picture_(picture), options_(options), maker_(picture, options),
          mutations_(static_cast<std::int64_t>(picture.samples) * picture.film.pixels().width() *
                     picture.film.pixels().height()) {}

    // Short enough to stop after.
    int passes() const override {
        const auto short_ones = static_cast<int>(std::min(mutations_ >> 20, std::int64_t{1} << 20));
        return std::min(picture_.samples, std::max(32, short_ones));
    }

    PictureCounts run(int pass, const std::function<void(double)>& progress) override {
        PictureCounts counts;
        // Of this pass's work; a path is about as much as a mutation.
        const double tried = pass == 0 ? static_cast<double>(bootstrap_paths()) : 0,
                     bootstrapped = tried / (tried + static_cast<double>(mutations_) / passes());
        if (pass == 0) counts += bootstrap([&](double done) { progress(done * bootstrapped); });
        std::atomic<int> done{0};
        std::mutex mutex;
        const std::size_t group = group_size(chains_.size());
        parallel_ranges(chains_.size(), group, [&](std::size_t begin, std::size_t end) {
            const PictureCounts part = run_chains(begin, end, pass);
            const int chains = done += static_cast<int>(end - begin);
            progress(bootstrapped + (1 - bootstrapped) * chains / static_cast<double>(chains_.size()));
            std::scoped_lock lock(mutex);
            counts += part;
        });
        const std::int64_t whole = mutations_ * (pass + 1) / passes();
        const auto so_far = static_cast<double>(whole);
        const double pixels = static_cast<double>(mutations_) / picture_.samples;
        picture_.film.set_splat_scale(brightness_ * pixels / rendered_fraction(picture_.film) / so_far);
        return counts;
    }

  private:
    std::uint64_t key_of(std::uint64_t purpose, std::uint64_t number) const {
        return hash_of(picture_.seed, purpose, number);
    }
    // Enough at a time to keep each other company, and groups enough for all threads.
    std::size_t group_size(std::size_t all) const {
        const std::size_t groups = 4 * static_cast<std::size_t>(hardware_threads());
        return std::clamp(all / groups, std::size_t{1}, static_cast<std::size_t>(picture_.paths_in_flight));
    }

    std::size_t bootstrap_paths() const {
        return static_cast<std::size_t>(options_.bootstrapsamples) *
               static_cast<std::size_t>(options_.maxdepth + 1);
    }
    /// Independent paths of all lengths; chains begin where they are bright.
    PictureCounts bootstrap(const std::function<void(double)>& progress) {
        std::vector<float> weights(bootstrap_paths());
        PictureCounts counts;
        std::atomic<std::size_t> done{0};
        std::mutex mutex;
        parallel_ranges(weights.size(), 4096, [&](std::size_t begin, std::size_t end) {
            const RayCounts rays = weigh(weights, begin, end);
            const std::size_t paths = done += end - begin;
            progress(static_cast<double>(paths) / static_cast<double>(weights.size()));
            std::scoped_lock lock(mutex);
            counts.rays += rays;
        });
        double sum = 0;
        for (float w : weights) sum += static_cast<double>(w);
        brightness_ = sum / options_.bootstrapsamples;
        if (sum > 0) begin_chains(weights, sum);
        return counts;
    }

    RayCounts weigh(std::vector<float>& weights, std::size_t begin, std::size_t end) const {
        const std::size_t places = static_cast<std::size_t>(picture_.paths_in_flight);
        Company<bool> company(picture_.scene, places);
        std::vector<std::optional<Chain>> trials(places);
        std::vector<std::size_t> numbers(places);
        std::size_t next = begin;
        company.run(
            [&](Company<bool>::Place& place) {
                if (next == end) return false;
                numbers[place.number] = next;
                Chain& trial = trials[place.number].emplace(make_chain(next, 0));
                ++next;
                maker_.start(company, place, trial.numbers, trial.bounces, trial.proposed);
                return true;
            },
            [&](Company<bool>::Place& place) {
                const float w = trials[place.number]->proposed.brightness();
                weights[numbers[place.number]] = w > 0 && w < infinity ? w : 0;
            });
        return company.counts;
    }

    /// The chain that begins with one of the bootstrap's paths, which are numbered length by length.
    Chain make_chain(std::size_t path, std::uint64_t number) const {
        const auto bounces = static_cast<int>(path / static_cast<std::size_t>(options_.bootstrapsamples));
        return {key_of(1, path), key_of(2, number), bounces, options_.sigma};
    }

    // As many chains begin with a path, and with paths of one length, as it deserves, to within one
    // (systematic resampling).
    void begin_chains(const std::vector<float>& weights, double sum) {
        const double step = sum / options_.chains;
        double next = step * static_cast<double>(unit_float(key_of(3, 0))), below = 0;
        for (std::size_t path = 0; path < weights.size(); ++path) {
            below += static_cast<double>(weights[path]);
            for (; next < below && chains_.size() < static_cast<std::size_t>(options_.chains); next += step)
                chains_.push_back(make_chain(path, chains_.size()));
        }
    }

    /// How many mutations all the chains before have made when the passes before are done.
    std::int64_t mutations_of(std::size_t chain, int pass) const {
        const auto all = static_cast<std::int64_t>(chains_.size());
        auto until = [&](std::int64_t chains) { return mutations_ * chains / all; };
        const auto number = static_cast<std::int64_t>(chain);
        const std::int64_t own = until(number + 1) - until(number);
        return own * (pass + 1) / passes() - own * pass / passes();
    }

    PictureCounts run_chains(std::size_t begin, std::size_t end, int pass) {
        PictureCounts counts;
        Company<bool> company(picture_.scene, end - begin);
        std::vector<std::int64_t> left;
        for (std::size_t i = begin; i < end; ++i) left.push_back(mutations_of(i, pass));
        company.run(
            [&](Company<bool>::Place& place) {
                Chain& chain = chains_[begin + place.number];
                if (chain.has_begun && left[place.number]-- == 0) {
                    bring(chain.current);
                    return false;
                }
                if (chain.has_begun) chain.numbers.propose(options_.largestepprobability);
                maker_.start(company, place, chain.numbers, chain.bounces, chain.proposed);
                return true;
            },
            [&](Company<bool>::Place& place) {
                if (!settle(chains_[begin + place.number]))
                    counts.add_bad(Vec2i(chains_[begin + place.number].proposed.film), pass);
            });
        counts.rays = company.counts;
        return counts;
    }

    /// Takes the proposal or not; false when it is no number. Both count as often as they would be taken.
    bool settle(Chain& chain) {
        if (!chain.has_begun) {
            chain.has_begun = true;
            chain.current = chain.proposed;
            return true;
        }
        const float brightness = chain.proposed.brightness();
        const bool is_good = chain.proposed.L.is_finite() && brightness < infinity;
        const float accepted =
            is_good ? std::clamp(brightness / chain.current.brightness(), 0.0f, 1.0f) : 0.0f;
        chain.proposed.weight = accepted;
        chain.current.weight += 1 - accepted;
        if (chain.numbers.acceptance() < accepted) {
            bring(chain.current);
            chain.current = chain.proposed;
            chain.numbers.accept();
        } else {
            bring(chain.proposed);
            chain.numbers.reject();
        }
        return is_good;
    }

    /// To the film, and then counts no more.
    void bring(State& state) {
        if (state.weight > 0 && picture_.film.splat_reaches(state.film))
            picture_.film.add_splat(state.film, state.L * (state.weight / state.brightness()), state.lambda);
        state.weight = 0;
    }

    PictureOrder picture_;
    MltOptions options_;
    PathMaker maker_;
    std::int64_t mutations_;
    double brightness_ = 0; ///< of all light on the whole film
    std::vector<Chain> chains_;
};

struct Mlt final : Integrator, MltOptions {
    static void describe(Fields<Mlt>& f) {
        f.about("Metropolis light transport on bidirectional paths: paths that bring light are changed a "
                "little, again "
                "and again. For light that is found seldom. The number of samples of a pixel is that of "
                "mutations.");
        f.field("maxdepth", &Mlt::maxdepth, "bounces and scatterings of a path at most; 0 shows lights only")
            .in(0, 10000);
        f.field(
             "bootstrapsamples", &Mlt::bootstrapsamples,
             "independent paths of each length, which say how bright the picture is and where chains begin")
            .in(1, 100000000);
        f.field("chains", &Mlt::chains, "independent chains of mutations").in(1, 10000000);
        f.field("mutationsperpixel", &Mlt::mutationsperpixel, "mutations of all chains together, per pixel")
            .in(1, max_mutations);
        f.field("largestepprobability", &Mlt::largestepprobability,
                "how many mutations give another path altogether")
            .in(0, 1);
        f.field("sigma", &Mlt::sigma, "standard deviation of small changes").in(0, 1);
        f.field("regularize", &Mlt::regularize,
                "widen narrow lobes after the first rough bounce: less noise, a little blur");
    }

    bool sees_media() const override { return true; }
    bool makes_splats() const override { return true; }
    int samples_per_pixel(int, std::optional<int> asked) const override {
        return asked.value_or(mutationsperpixel);
    }
    bool follows_camera_rays() const override { return false; }
    std::unique_ptr<PictureWork> whole_picture(const PictureOrder& picture) const override {
        return std::make_unique<MltWork>(picture, *this);
    }
    Task<Spectrum> radiance(Ray, PathContext&) const override { co_return Spectrum(0); }

  private:
    static constexpr int max_mutations = 1 << 24;
};

} // namespace

Kind<Integrator> mlt_integrator() {
    return make_kind<Integrator, Mlt>("mlt");
}

} // namespace alhazen
