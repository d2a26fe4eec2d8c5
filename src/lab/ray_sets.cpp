#include "lab/ray_sets.h"

#include <algorithm>

#include "base/frame.h"
#include "base/hash.h"
#include "math/warp.h"

namespace alhazen {

namespace {

constexpr int tile = 8;
constexpr int bounces = 3;
/// Length of ambient occlusion rays over the median distance from the camera to what it sees.
constexpr float ao_length = 0.2f;
/// Rays start so many times farther off the surface than our own rounding needs: the peer rounds in another
/// way and would meet the surface again.
constexpr float clearance = 32;

class RaySetMaker {
  public:
    RaySetMaker(const World& world, const RaySetOptions& options)
        : world_(world), wanted_(std::max<std::size_t>(options.rays, tile * tile)), rng_(options.seed),
          lambda_(world.mode == ColorMode::rgb ? Wavelengths::rgb() : Wavelengths::sample_visible(0.5f)) {}

    std::vector<RaySet> make() {
        make_primary();
        std::vector<Ray> rays = primary_;
        for (int bounce = 0; bounce < bounces && !rays.empty(); ++bounce) rays = make_bounce(rays);
        for (std::vector<Ray>* set : {&diffuse_, &ao_, &shadow_}) shuffle_and_cut(*set);
        return {{RayKind::primary, std::move(primary_)},
                {RayKind::diffuse, std::move(diffuse_)},
                {RayKind::ao, std::move(ao_)},
                {RayKind::shadow, std::move(shadow_)}};
    }

  private:
    void make_primary() {
        Vec2i size = tiled_size(world_.film->resolution(), wanted_);
        for (int ty = 0; ty < size.y; ty += tile)
            for (int tx = 0; tx < size.x; tx += tile)
                for (int i = 0; i < tile * tile; ++i)
                    if (auto ray = camera_ray(world_, {tx + i % tile, ty + i / tile}, size))
                        primary_.push_back(*ray);
    }

    // Rays of every kind from what these rays meet; the diffuse ones are returned.
    std::vector<Ray> make_bounce(const std::vector<Ray>& rays) {
        std::vector<Hit> hits;
        for (const Ray& ray : rays)
            if (auto hit = world_.scene->closest(ray)) {
                hit->p_error *= clearance;
                hits.push_back(*hit);
            }
        if (hits.empty()) return {};
        if (ao_distance_ == 0) ao_distance_ = ao_length * median_distance(hits);
        std::vector<Ray> next;
        for (const Hit& hit : hits) {
            Frame frame = Frame::from_z(dot(hit.ng, hit.wo) < 0 ? -hit.ng : hit.ng);
            next.push_back(hit.spawn(frame.to_world(sample_cosine_hemisphere(random2()))));
            ao_.push_back(hit.spawn(frame.to_world(sample_cosine_hemisphere(random2()))));
            ao_.back().tmax = ao_distance_;
            add_shadow_ray(hit, frame.z);
        }
        diffuse_.insert(diffuse_.end(), next.begin(), next.end());
        return next;
    }

    void add_shadow_ray(const Hit& hit, Vec3 normal) {
        const Scene& scene = *world_.scene;
        if (scene.lights().empty()) {
            const Bounds3& box = scene.bounds();
            Vec3 u{rng_.uniform(), rng_.uniform(), rng_.uniform()};
            shadow_.push_back(hit.spawn_to(box.lo + box.diagonal() * u, {}, {}));
            return;
        }
        LightReceiver at{hit.p, normal};
        auto chosen = scene.choose_light(at, rng_.uniform());
        if (!chosen) return;
        auto sample = chosen->light->sample(at, random2(), lambda_);
        if (!sample || !(dot(sample->wi, normal) > 0)) return;
        shadow_.push_back(hit.spawn_to(sample->p, sample->p_error, sample->ng));
    }

    static float median_distance(const std::vector<Hit>& hits) {
        std::vector<float> t;
        for (const Hit& hit : hits) t.push_back(hit.t);
        auto middle = t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2);
        std::nth_element(t.begin(), middle, t.end());
        return *middle;
    }

    void shuffle_and_cut(std::vector<Ray>& rays) {
        for (std::size_t i = rays.size(); i > 1; --i)
            std::swap(rays[i - 1], rays[rng_.below(static_cast<std::uint32_t>(i))]);
        if (rays.size() > wanted_) rays.resize(wanted_);
    }

    Vec2 random2() {
        float x = rng_.uniform();
        return {x, rng_.uniform()};
    }

    const World& world_;
    std::size_t wanted_;
    Rng rng_;
    Wavelengths lambda_;
    float ao_distance_ = 0;
    std::vector<Ray> primary_, diffuse_, ao_, shadow_;
};

} // namespace

std::string_view name_of(RayKind kind) {
    switch (kind) {
    case RayKind::primary:
        return "primary";
    case RayKind::diffuse:
        return "diffuse";
    case RayKind::ao:
        return "ao";
    case RayKind::shadow:
        break;
    }
    return "shadow";
}

Vec2i tiled_size(Vec2i film, std::size_t pixels) {
    double scale =
        std::sqrt(static_cast<double>(pixels) / (static_cast<double>(film.x) * static_cast<double>(film.y)));
    auto side = [&](int full) {
        return std::max(tile, tile * static_cast<int>(std::lround(full * scale / tile)));
    };
    return {side(film.x), side(film.y)};
}

std::optional<Ray> camera_ray(const World& world, Vec2i pixel, Vec2i size) {
    Vec2i film = world.film->resolution();
    auto place = [](int p, int n, int full) {
        return (static_cast<float>(p) + 0.5f) / static_cast<float>(n) * static_cast<float>(full);
    };
    CameraSample sample;
    sample.film = {place(pixel.x, size.x, film.x), place(pixel.y, size.y, film.y)};
    sample.lens = {0.5f, 0.5f};
    auto ray = world.camera->ray(sample);
    if (!ray) return std::nullopt;
    return ray->ray;
}

std::vector<RaySet> make_ray_sets(const World& world, const RaySetOptions& options) {
    return RaySetMaker(world, options).make();
}

} // namespace alhazen
