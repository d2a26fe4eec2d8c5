#include <algorithm>
#include <string_view>
#include <vector>

#include "base/supported_kernels.h"
#include "integrators/bundle/bundles.h"
#include "integrators/bundle/kernel.h"

namespace alhazen {

namespace {

std::vector<const BundleKernel*> supported_kernels() {
    return supported_among({bundle_kernel_avx512(), bundle_kernel_avx2(), bundle_kernel_plain()});
}

void store(float (&to)[bundle_colors], Spectrum s) {
    for (int i = 0; i < static_cast<int>(bundle_colors); ++i) to[i] = s[i];
}

// nullopt where the shape is something else than a ball with Phong's surface of one colour.
std::optional<BundleBall> find_ball(const Object& object, std::uint32_t shape, Spectrum ambient) {
    const PlacedShape& placed = object.shapes()[shape];
    const auto ball = placed.shape->ball();
    if (!ball || !placed.material || !placed.lights.empty() || !object.is_solid(shape)) return std::nullopt;
    const Material& material = *placed.material;
    if (!material.is_uniform() || material.needs_parameters() || material.has_relief()) return std::nullopt;
    const std::uint32_t primitive = object.number_of(shape, 0);
    // What has no finite box is never hit.
    if (!is_finite(object.box(primitive).diagonal())) return std::nullopt;

    Arena arena;
    Wavelengths rgb = Wavelengths::rgb();
    const Bsdf* bsdf = material.at({}, rgb, arena);
    const auto phong = bsdf ? bsdf->phong() : std::nullopt;
    if (!phong) return std::nullopt;
    const WhittedTerms k = bsdf->whitted({0, 0, 1});
    BundleBall made{};
    made.x = ball->centre.x;
    made.y = ball->centre.y;
    made.z = ball->centre.z;
    made.radius = ball->radius;
    made.radius_squared = ball->radius * ball->radius;
    const Vec3 centre(ball->centre);
    made.near_x = centre.x;
    made.near_y = centre.y;
    made.near_z = centre.z;
    // Squares of what is smaller are not known so well.
    made.reach =
        std::max(0x1p-50f, static_cast<float>(ball->radius) * (1 + bundle_rough) +
                               bundle_rough * (std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z)));
    made.primitive = primitive;
    made.side = ball->is_turned ? -1.0f : 1.0f;
    // Phong's are grey.
    made.mirror = k.mirror[0];
    made.refract = k.refract[0];
    made.eta = k.eta;
    made.shininess = phong->shininess;
    store(made.ambient, k.ambient * ambient);
    store(made.diffuse, phong->diffuse);
    store(made.specular, phong->specular);
    return made;
}

Vec3d centre_of(const BundleBall& ball) {
    return {ball.x, ball.y, ball.z};
}

// How near p comes to what lies between a ball and a point: to one of the balls that shrink on the way s from
// the one to the other. Where the derivative of that convex function of s,
//     |from + s way| - (1 - s) radius,
// is 0, or at an end.
double distance_to_cone(Vec3d p, const BundleBall& ball, Vec3d tip) {
    const Vec3d way = tip - centre_of(ball), from = centre_of(ball) - p;
    auto distance = [&](double s) { return length(from + way * s) - (1 - s) * ball.radius; };
    const double a = dot(way, way), b = dot(way, from), c = dot(from, from), r2 = ball.radius_squared;
    const double ends = std::min(distance(0), distance(1));
    if (!(a > r2)) return ends; // the tip is in the ball
    const double s = -(b + ball.radius * std::sqrt(std::max(a * c - b * b, 0.0) / (a - r2))) / a;
    return std::min(ends, distance(std::clamp(s, 0.0, 1.0)));
}

// Not where the other keeps out of the way from the ball's surface to the light, and not where it has both
// inside.
bool may_hide(const BundleBall& other, const BundleBall& ball, Vec3d light) {
    const Vec3d between = centre_of(other) - centre_of(ball), beyond = centre_of(other) - light;
    const double room = 1e-5 * (length(centre_of(other)) + length(centre_of(ball)) + length(light) +
                                other.radius + ball.radius);
    if (std::max(length(between) + ball.radius, length(beyond)) < other.radius - room) return false;
    return distance_to_cone(centre_of(other), ball, light) < other.radius + room;
}

class WhittedBundles final : public RayBundles {
  public:
    WhittedBundles(std::vector<BundleBall> balls, std::vector<BundleLight> lights,
                   const WhittedSettings& settings, const BundleKernel& kernel)
        : balls_(std::move(balls)), lights_(std::move(lights)),
          scene_{balls_.data(),     all_of(balls_.size()),
                 lights_.data(),    static_cast<std::uint32_t>(lights_.size()),
                 settings.maxdepth, settings.shadows},
          kernel_(kernel) {
        find_blockers();
    }
    WhittedBundles(const WhittedBundles&) = delete;
    WhittedBundles& operator=(const WhittedBundles&) = delete;

    void radiance(std::span<const Ray> rays, std::span<Spectrum> radiance, RayCounts& counts) const override {
        BundleCounts counted;
        for (std::size_t first = 0; first < rays.size(); first += bundle_lanes) {
            const std::size_t n = std::min(rays.size() - first, std::size_t{bundle_lanes});
            trace(rays.subspan(first, n), radiance.subspan(first, n), counted);
        }
        if (scene_.maxdepth > 0) counts.camera += rays.size();
        counts.bounce += counted.bounce;
        counts.shadow += counted.shadow;
    }

  private:
    static std::uint64_t all_of(std::size_t count) {
        return count < most_bundle_balls ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
    }

    void find_blockers() {
        blockers_.resize(lights_.size() * balls_.size());
        std::uint64_t* next = blockers_.data();
        for (BundleLight& light : lights_) {
            light.blockers = next;
            for (const BundleBall& ball : balls_) {
                for (std::size_t i = 0; i < balls_.size(); ++i)
                    if (may_hide(balls_[i], ball, Vec3d(Vec3(light.x, light.y, light.z))))
                        *next |= std::uint64_t{1} << i;
                ++next;
            }
        }
    }

    void trace(std::span<const Ray> rays, std::span<Spectrum> radiance, BundleCounts& counts) const {
        BundleRays bundle{};
        bundle.count = static_cast<std::uint32_t>(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i)
            for (int axis = 0; axis < 3; ++axis) {
                bundle.o[axis][i] = rays[i].o[axis];
                bundle.d[axis][i] = rays[i].d[axis];
            }
        BundleRadiance seen;
        kernel_.trace(scene_, bundle, seen, counts);
        for (std::size_t i = 0; i < rays.size(); ++i)
            radiance[i] = {seen.color[0][i], seen.color[1][i], seen.color[2][i], seen.color[3][i]};
    }

    std::vector<BundleBall> balls_;
    std::vector<BundleLight> lights_;
    std::vector<std::uint64_t> blockers_; ///< for each light, for each ball
    BundleScene scene_;
    const BundleKernel& kernel_;
};

} // namespace

std::vector<std::string_view> bundle_kernel_names() {
    std::vector<std::string_view> names;
    for (const BundleKernel* k : supported_kernels()) names.emplace_back(k->name);
    return names;
}

std::unique_ptr<RayBundles> whitted_bundles(const Scene& scene, const WhittedSettings& settings) {
    return whitted_bundles(scene, settings, bundle_kernel_names().front());
}

std::unique_ptr<RayBundles> whitted_bundles(const Scene& scene, const WhittedSettings& settings,
                                            std::string_view kernel) {
    const Object& root = scene.root();
    if (scene.moves() || scene.approximation() || root.structure_is_chosen() || !root.instances().empty() ||
        root.shapes().size() > most_bundle_balls || settings.maxdepth > whitted_whole_depth)
        return nullptr;
    std::vector<BundleBall> balls;
    for (std::uint32_t i = 0; i < root.shapes().size(); ++i) {
        auto ball = find_ball(root, i, settings.ambient);
        if (!ball) return nullptr;
        balls.push_back(*ball);
    }
    std::stable_sort(balls.begin(), balls.end(),
                     [](const BundleBall& a, const BundleBall& b) { return a.radius < b.radius; });
    std::vector<BundleLight> lights;
    for (const Light* light : scene.lights()) {
        const auto point = light->even_point(Wavelengths::rgb());
        if (!point) return nullptr;
        if (point->intensity.is_black()) continue;
        BundleLight& made = lights.emplace_back();
        made = {point->p.x, point->p.y, point->p.z, {}, point->fades, nullptr};
        store(made.intensity, point->intensity);
    }
    for (const BundleKernel* k : supported_kernels())
        if (k->name == kernel)
            return std::make_unique<WhittedBundles>(std::move(balls), std::move(lights), settings, *k);
    return nullptr;
}

} // namespace alhazen
