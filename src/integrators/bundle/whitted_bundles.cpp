#include <algorithm>
#include <string_view>
#include <vector>

#include "integrators/bundle/bundles.h"
#include "integrators/bundle/kernel.h"

namespace alhazen {

namespace {

// With more balls an acceleration structure is sooner done.
constexpr std::size_t most_balls = 64;

std::vector<const BundleKernel*> supported_kernels() {
    std::vector<const BundleKernel*> supported;
    for (const BundleKernel* k : {bundle_kernel_avx512(), bundle_kernel_avx2(), bundle_kernel_plain()})
        if (k && k->is_supported()) supported.push_back(k);
    return supported;
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
    made.size = static_cast<float>(ball->radius) * (1 + 0x1p-20f) +
                0x1p-20f * (std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z));
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

class WhittedBundles final : public RayBundles {
  public:
    WhittedBundles(std::vector<BundleBall> balls, std::vector<BundleLight> lights,
                   const WhittedSettings& settings, const BundleKernel& kernel)
        : balls_(std::move(balls)), lights_(std::move(lights)),
          scene_{balls_.data(),     static_cast<std::uint32_t>(balls_.size()),
                 lights_.data(),    static_cast<std::uint32_t>(lights_.size()),
                 settings.maxdepth, settings.shadows},
          kernel_(kernel) {}
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
        root.shapes().size() > most_balls)
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
        made = {point->p.x, point->p.y, point->p.z, {}, point->fades};
        store(made.intensity, point->intensity);
    }
    for (const BundleKernel* k : supported_kernels())
        if (k->name == kernel)
            return std::make_unique<WhittedBundles>(std::move(balls), std::move(lights), settings, *k);
    return nullptr;
}

} // namespace alhazen
