/// Phong's empirical surface (Phong 1975) with Whitted's mirror and refraction (Whitted 1980): the project's
/// first material. To the Whitted integrator it gives the textbook's terms as they are. Path tracers need
/// energy to be kept, and get the modified Phong model in its normalised form (Lafortune and Willems 1994),
///
///     (1 - kr) [ kd / pi + ks (n + 2) / (2 pi) cos^n(alpha) ]  +  kr mirror  +  kt refraction,
///
/// alpha the angle between wi and the mirrored wo. Its albedo is largest at normal incidence, (1 - kr)(kd +
/// ks) + kr + kt; where that exceeds 1, kd and ks are scaled down together (and kr and kt, where they alone
/// exceed 1). On total internal reflection the refracted light is mirrored. Reflection is two-sided: the
/// normal is turned to the side of wo.
#include "materials/fresnel.h"
#include "materials/material.h"
#include "materials/microfacet.h"
#include "math/power.h"
#include "math/warp.h"

namespace alhazen {

namespace {

/// What the textures say at a point.
struct PhongValues {
    Spectrum ambient, diffuse, specular;
    float shininess = 50;
    float reflectivity = 0, transparency = 0;
    float eta = 1.5f;
};

// cos^n, 0 for angles beyond a right angle even where n is 0.
float power_lobe(float cosine, float n) {
    return cosine > 0 ? power(cosine, n) : 0;
}

class PhongBsdf final : public Bsdf {
  public:
    explicit PhongBsdf(const PhongValues& v) : values_(v), exponent_(v.shininess), eta_(v.eta) {
        float straight = v.reflectivity + v.transparency;
        float fit = 1 / std::max(1.0f, straight);
        mirror_ = v.reflectivity * fit;
        refract_ = v.transparency * fit;
        Spectrum rest = (v.diffuse + v.specular) * (1 - mirror_);
        float room = std::max(0.0f, 1 - mirror_ - refract_);
        Spectrum scale = map(rest, [&](float r) { return r > room ? room / r : 1.0f; }) * (1 - mirror_);
        diffuse_ = v.diffuse * scale;
        glossy_ = v.specular * scale;
        float total = diffuse_.average() + glossy_.average() + mirror_ + refract_;
        if (total <= 0) return;
        choose_diffuse_ = diffuse_.average() / total;
        choose_glossy_ = glossy_.average() / total;
        choose_mirror_ = mirror_ / total;
        choose_refract_ = refract_ / total;
    }

    Scatter eval(Vec3 wo, Vec3 wi, TransportMode) const override {
        if (!same_hemisphere(wo, wi)) return {};
        float lobe = power_lobe(dot(mirrored(wo), wi), exponent_) * (inv_pi / 2);
        float cos_o = abs_cos_theta(wo), cos_i = abs_cos_theta(wi);
        float glossy_pdf = choose_glossy_ * (exponent_ + 1) * lobe;
        return {(diffuse_ * inv_pi + glossy_ * ((exponent_ + 2) * lobe)) * cos_i,
                choose_diffuse_ * cosine_hemisphere_pdf(cos_i) + glossy_pdf,
                choose_diffuse_ * cosine_hemisphere_pdf(cos_o) + glossy_pdf};
    }

    std::optional<BsdfSample> sample(Vec3 wo, float u, Vec2 u2, TransportMode mode) const override {
        if (wo.z == 0) return std::nullopt;
        if (u < choose_diffuse_) return sample_diffuse(wo, u2, mode);
        u -= choose_diffuse_;
        if (u < choose_glossy_) return sample_glossy(wo, u2, mode);
        u -= choose_glossy_;
        return sample_straight(wo, u, mode);
    }

    Lobes lobes() const override {
        Lobes all = Lobes::none;
        if (choose_diffuse_ > 0) all = all | Lobes::reflection | Lobes::diffuse;
        if (choose_glossy_ > 0) all = all | Lobes::reflection | Lobes::glossy;
        if (mirror_ > 0) all = all | Lobes::reflection | Lobes::specular;
        // Refraction mirrors where nothing gets through.
        if (refract_ > 0) all = all | Lobes::reflection | Lobes::transmission | Lobes::specular;
        return all;
    }

    // As the microfacets' rule, for the exponent that gives about the same highlight (Walter et al. 2007: n =
    // 2 / alpha^2 - 2). Mirror and refraction stay sharp.
    void regularize() override {
        float alpha = std::sqrt(2 / (exponent_ + 2));
        if (alpha < 0.3f) exponent_ = 2 / sqr(std::clamp(2 * alpha, 0.1f, 0.3f)) - 2;
    }

    WhittedTerms whitted(Vec3) const override {
        return {values_.ambient, values_.reflectivity, values_.transparency, values_.eta};
    }

    std::optional<PhongTerms> phong() const override {
        return PhongTerms{values_.diffuse, values_.specular, values_.shininess};
    }

    /// kd max(0, L.N) + ks max(0, R.V)^n, L = wi, V = wo, R = L mirrored about N; no highlight where L.N <=
    /// 0.
    Spectrum local(Vec3 wo, Vec3 wi, Highlight highlight) const override {
        float l_dot_n = wo.z < 0 ? -wi.z : wi.z;
        if (l_dot_n <= 0) return 0;
        Spectrum matte = values_.diffuse * l_dot_n;
        if (values_.specular.is_black()) return matte;
        if (highlight == Highlight::blinn) {
            float n_dot_h = std::abs(normalize(wo + wi).z);
            return matte + values_.specular * power_lobe(n_dot_h, 4 * values_.shininess);
        }
        float r_dot_v = dot(mirrored(wi), wo);
        if (r_dot_v <= 0) return matte;
        return matte + values_.specular * power_lobe(r_dot_v, values_.shininess);
    }

  private:
    static Vec3 mirrored(Vec3 w) { return {-w.x, -w.y, w.z}; }

    std::optional<BsdfSample> sample_diffuse(Vec3 wo, Vec2 u2, TransportMode mode) const {
        Vec3 wi = sample_cosine_hemisphere(u2);
        if (wo.z < 0) wi.z = -wi.z;
        return smooth_sample(wo, wi, Lobes::diffuse, mode);
    }
    std::optional<BsdfSample> sample_glossy(Vec3 wo, Vec2 u2, TransportMode mode) const {
        float cos_alpha = std::pow(1 - u2.x, 1 / (exponent_ + 1));
        float sin_alpha = safe_sqrt(1 - sqr(cos_alpha));
        float phi = 2 * pi * u2.y;
        Vec3 around{sin_alpha * std::cos(phi), sin_alpha * std::sin(phi), cos_alpha};
        return smooth_sample(wo, normalize(Frame::from_z(mirrored(wo)).to_world(around)), Lobes::glossy,
                             mode);
    }
    std::optional<BsdfSample> smooth_sample(Vec3 wo, Vec3 wi, Lobes lobe, TransportMode mode) const {
        Scatter s = eval(wo, wi, mode);
        if (!(s.pdf > 0)) return std::nullopt;
        return BsdfSample{wi, s.f, s.pdf, s.pdf_reverse, Lobes::reflection | lobe, 1};
    }
    // Mirror or refraction; both go one way where the border reflects everything.
    std::optional<BsdfSample> sample_straight(Vec3 wo, float u, TransportMode mode) const {
        if (choose_mirror_ + choose_refract_ <= 0) return std::nullopt;
        auto refraction = refract(wo, {0, 0, 1}, eta_);
        bool is_total = !refraction || refraction->wt.z == 0;
        if (is_total || u < choose_mirror_) {
            float weight = mirror_ + (is_total ? refract_ : 0);
            float chance = choose_mirror_ + (is_total ? choose_refract_ : 0);
            return BsdfSample{mirrored(wo), weight, chance, chance, Lobes::reflection | Lobes::specular, 1};
        }
        if (choose_refract_ <= 0) return std::nullopt;
        float f = mode == TransportMode::radiance ? refract_ / sqr(refraction->eta) : refract_;
        return BsdfSample{
            refraction->wt, f, choose_refract_, choose_refract_, Lobes::transmission | Lobes::specular,
            refraction->eta};
    }

    PhongValues values_; ///< the textbook's
    // The physical model's:
    Spectrum diffuse_, glossy_;
    float mirror_ = 0, refract_ = 0;
    float exponent_, eta_;
    float choose_diffuse_ = 0, choose_glossy_ = 0, choose_mirror_ = 0, choose_refract_ = 0;
};

struct Phong final : Material {
    std::optional<AlbedoTexture> ambient;
    AlbedoTexture diffuse{0.5f}, specular{1};
    FloatTexture shininess{50}, reflectivity{0}, transparency{0}, eta{1.5f};

    static void describe(Fields<Phong>& f) {
        f.about("Whitted's surface: Phong's highlight, a mirror and a refraction. The Whitted integrator "
                "takes the "
                "terms as they are; others take the modified Phong model, scaled down where it would reflect "
                "more "
                "light than it gets.");
        f.field("ambient", &Phong::ambient, "ka: fraction of the integrator's ambient light reflected")
            .in(0, 1)
            .otherwise("diffuse");
        f.field("diffuse", &Phong::diffuse, "kd: strength of matte reflection").in(0, 1);
        f.field("specular", &Phong::specular, "ks: strength of the highlight").in(0, 1);
        f.field("shininess", &Phong::shininess, "n: exponent of the highlight; larger is smaller")
            .at_least(0);
        f.field("reflectivity", &Phong::reflectivity, "kr: strength of the mirrored picture").in(0, 1);
        f.field("transparency", &Phong::transparency, "kt: strength of the refracted picture").in(0, 1);
        f.field("eta", &Phong::eta, "index of refraction inside over outside").above(0);
        Relief::describe(f);
        f.example("plastic", {});
        f.example("blue", {make_rgb("ambient", 0.1f, 0.1f, 0.2f), make_rgb("diffuse", 0.1f, 0.2f, 0.8f),
                           make_float("shininess", 20), make_float("reflectivity", 0.4f)});
        f.example("glass", {make_float("diffuse", 0.1f), make_float("specular", 0.2f),
                            make_float("reflectivity", 0.1f), make_float("transparency", 0.7f)});
        f.example("highlight",
                  {make_float("diffuse", 0), make_float("specular", 0.8f), make_float("shininess", 5)});
        f.example("too much", {make_float("diffuse", 1), make_float("reflectivity", 0.8f),
                               make_float("transparency", 0.8f), make_float("shininess", 0)});
    }

    // Without textures, RGB mode has one BSDF for all points.
    void finish(const Node&, BuildContext&) {
        if (!is_constant()) return;
        Wavelengths rgb = Wavelengths::rgb();
        everywhere_.emplace(values(TexturePoint({}, {}, {}), rgb));
    }

    bool needs_parameters() const override { return !is_constant(); }
    Bsdf* at(const Hit& hit, Wavelengths& lambda, Arena& arena) const override {
        if (everywhere_ && lambda.mode == ColorMode::rgb) return arena.make<PhongBsdf>(*everywhere_);
        return arena.make<PhongBsdf>(values(TexturePoint(hit), lambda));
    }

    bool is_uniform() const override { return everywhere_.has_value(); }

  private:
    bool is_constant() const {
        bool colors = diffuse.is_constant() && specular.is_constant() && (!ambient || ambient->is_constant());
        return colors && shininess.is_constant() && reflectivity.is_constant() &&
               transparency.is_constant() && eta.is_constant();
    }

    PhongValues values(const TexturePoint& at, const Wavelengths& lambda) const {
        auto color = [&](const SpectrumTexture& t) { return clamp(t.eval(at, lambda), 0, 1); };
        auto fraction = [&](const FloatTexture& t) { return std::clamp(t.eval(at), 0.0f, 1.0f); };
        PhongValues v;
        v.diffuse = color(diffuse);
        v.ambient = ambient ? color(*ambient) : v.diffuse;
        v.specular = color(specular);
        v.shininess = std::max(0.0f, shininess.eval(at));
        v.reflectivity = fraction(reflectivity);
        v.transparency = fraction(transparency);
        float index = eta.eval(at);
        v.eta = index > 0 ? index : 1;
        return v;
    }

    std::optional<PhongBsdf> everywhere_;
};

} // namespace

Kind<Material> phong_material() {
    return make_kind<Material, Phong>("phong");
}

} // namespace alhazen
